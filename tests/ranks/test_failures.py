"""Failures and signals under mpirun end all ranks, with one message and without losing what was written.
Usage: SCREE=path/to/scree MPIEXEC=path/to/mpirun python3 test_failures.py
on GPUs: SCREE_TEST_BACKEND=cuda and the same"""

import math
import os
import signal
import struct
import subprocess
import unittest

from checkpoint_bytes import sealed, with_velocity
from mpi_case import (BACKEND, BAD_INPUT, DAM, DONE, ENVIRONMENT, EXPLICIT, FAILED, IMPLICIT, IO_FAILED, LIMIT, LONELY,
                      MPIEXEC, SCREE, STOPPED, VELOCITY, RanksTest, results)


class FailureTest(RanksTest):
    def test_bad_input_is_reported_once(self):
        deck = self.write("bad.toml", LONELY.replace("step = 1e-3", "stp = 1e-3"))
        self.assert_one_message(self.run_deck(BAD_INPUT, 2, deck, "out"), "time.stp", "did you mean")
        self.assert_one_message(self.run_deck(IO_FAILED, 2, self.folder / "none.toml", "out"), "none.toml")

    def test_bad_input_that_only_rank_0_sees_is_reported_once(self):
        self.write("out", "a file where the results should go")
        deck = self.write("deck.toml", LONELY)
        self.assert_one_message(self.run_deck(IO_FAILED, 3, deck, "out"), "output folder")
        result = self.run_deck(BAD_INPUT, 2, deck, "results", (), "--", "no_option")
        self.assert_one_message(result, "no_option")

    def test_subdomains_narrower_than_the_halo_are_refused(self):
        deck = self.write("deck.toml", LONELY.replace("periodic", "wall"))
        result = self.run_deck(BAD_INPUT, 4, deck, "out", ["contact.skin=0.6"])
        self.assert_one_message(result, "mpirun -n 4", "narrower", "only")

    def test_ranks_without_particles_are_fine(self):
        deck = self.write("deck.toml", LONELY)
        for ranks in (1, 8):
            self.run_deck(DONE, ranks, deck, f"out {ranks}")
        self.assertEqual(self.hash("out 8"), self.hash("out 1"))

    def test_a_value_that_is_not_finite_on_one_rank_ends_all(self):
        light = LONELY.replace("count = 2", "count = 1")
        table = LONELY[LONELY.index("[[particles]]"):]
        for old, new in (("two", "heavy"), ("count = 2", "count = 1"), ("origin = [0.25", "origin = [0.75"),
                         ("mass = 1.0", "mass = 1e308")):
            table = table.replace(old, new)
        deck = self.write("deck.toml", f"gravity = [0.0, 100.0]\n{light}\n{table}")  # 1e310 N
        for how in (IMPLICIT, EXPLICIT):
            with self.subTest(how=how):
                result = self.run_deck(FAILED, 2, deck, "out", how)
                # Without a list that covers its motion, an implicit step does not come to look at forces.
                words = ("particle 1", "not finite") if how == EXPLICIT else ("stage neighbors",)
                self.assert_one_message(result, *words)
                self.assertEqual(self.record("out")["run"]["exit_code"], FAILED)

    def test_a_damaged_checkpoint_is_refused(self):
        def ids(*both):  # and what stands behind them: images and materials, all zero; nothing else looks like it
            return struct.pack("<2q", *both) + bytes(8 * (6 + 2))
        speed = struct.pack("<d", VELOCITY)
        version = 5
        format_name = b"scree checkpoint %d" % version
        damages = {
            "ids must increase": (ids(0, 1), ids(0, 0)), "comes after particle 1": (ids(0, 1), ids(1, 0)),
            "particle id -1": (ids(0, 1), ids(-1, 1)), "particle id 2": (ids(0, 1), ids(0, 2)),
            "particle 0 is not finite": (speed, struct.pack("<d", math.nan)),
        }
        deck = self.write("deck.toml", LONELY)
        self.run_deck(DONE, 1, deck, "start", [*EXPLICIT, "time.end=0.1"])
        content = (self.folder / "start" / "checkpoint_end.h5").read_bytes()
        damaged = self.folder / "damaged.h5"
        for ranks in (1, 3):
            for words, (healthy, ill) in damages.items():
                with self.subTest(ranks=ranks, words=words):
                    self.assertIn(healthy, content)
                    damaged.write_bytes(sealed(content.replace(healthy, ill, 1)))
                    result = self.run_deck(IO_FAILED, ranks, deck, "out", EXPLICIT, "--restart", damaged)
                    self.assert_one_message(result, "damaged.h5: not a valid checkpoint: ", words)
        self.assertEqual(content.count(format_name), 1)
        self.assertEqual(sealed(content), content)
        other = content.replace(struct.pack("<d", VELOCITY), struct.pack("<d", 2 * VELOCITY), 1)
        for ranks in (1, 3):
            for words, ill in (("the checkpoint is damaged: its content", other),
                               ("the checkpoint is damaged: the hash of its state", sealed(other)),
                               ("the checkpoint is damaged: it is truncated", content[:-30])):
                with self.subTest(ranks=ranks, words=words):
                    damaged.write_bytes(ill)
                    result = self.run_deck(IO_FAILED, ranks, deck, "out", EXPLICIT, "--restart", damaged)
                    self.assert_one_message(result, "damaged.h5: ", words)
        for number, words in ((version - 1, "of an older version"), (version + 1, "of a newer version")):
            with self.subTest(words=words):
                damaged.write_bytes(sealed(content.replace(format_name, b"scree checkpoint %d" % number)))
                result = self.run_deck(IO_FAILED, 2, deck, "out", EXPLICIT, "--restart", damaged)
                self.assert_one_message(result, "damaged.h5", words)

    def test_a_restart_with_an_absurd_velocity_fails(self):
        leaving = 'dimension = 2\nleaving = "ballistic"'
        drifting = LONELY.replace('"periodic"', '"open"').replace("dimension = 2", leaving)
        cases = {"periodic.toml": (LONELY, EXPLICIT, ("stage sort_cells", "particle 1 ", "crossed the whole periodic")),
                 "open.toml": (drifting, EXPLICIT, ("stage output", "is not finite")),
                 "implicit.toml": (LONELY, IMPLICIT, ("stage neighbors",))}
        for name, (text, how, words) in cases.items():
            deck = self.write(name, text)
            self.run_deck(DONE, 1, deck, "start", [*how, "time.end=0.1"])
            content = (self.folder / "start" / "checkpoint_end.h5").read_bytes()
            absurd = self.folder / "absurd.h5"
            # The second particle's, along y; with the state hash and the checksum that belong to it.
            content, hash_of = with_velocity(content, 1, 0.75, VELOCITY, 1e308)
            state_hash = self.hash("start")
            self.assertEqual(content.count(state_hash.encode()), 1)
            absurd.write_bytes(sealed(content.replace(state_hash.encode(), hash_of(state_hash).encode())))
            for ranks in (1, 3):
                with self.subTest(name=name, ranks=ranks):
                    result = self.run_deck(FAILED, ranks, deck, "out", how, "--restart", absurd)
                    self.assert_one_message(result, *words)
                    self.assertEqual(self.record("out")["run"]["exit_code"], FAILED)

    @unittest.skipIf(BACKEND == "cuda", "the driver needs more address space than the limit")
    def test_one_rank_without_memory_ends_all(self):
        many = LONELY
        for old, new in (("periodic", "wall"), ("max = [1.0, 1.0]", "max = [130.0, 130.0]"), ('"row"', '"lattice"'),
                         ("count = 2", "size = [1000, 1000]"), ("spacing = [0.5, 0.0]", "spacing = [0.12, 0.12]")):
            many = many.replace(old, new)
        deck = self.write("deck.toml", many)
        run = [SCREE, "run", str(deck), "--output", str(self.folder / "out"), "--set", EXPLICIT[0]]
        short = f"ulimit -v 640000; exec {' '.join(run)}"  # [KiB]
        result = subprocess.run([MPIEXEC, "-n", "1", *run, ":", "-n", "1", "bash", "-c", short], cwd=self.folder,
                                env=ENVIRONMENT, capture_output=True, text=True, timeout=LIMIT)
        self.assertEqual(result.returncode, BAD_INPUT, result.stdout + result.stderr)
        self.assertRegex(result.stderr, r"not enough memory: (running it on the CPU takes about [0-9.]+ GB, .+; )?"
                                        r"a run of 1000000 particles takes at least 0.96 GB on 2 ranks, "
                                        r"0.48 GB on each")

    def test_check_says_what_is_per_rank(self):
        words = [MPIEXEC, "-n", "3", SCREE, "check", str(DAM[0])]
        text = subprocess.run(words, env=ENVIRONMENT, capture_output=True, text=True, timeout=LIMIT, check=True).stdout
        self.assertIn("particles      500 on 3 ranks together", text)
        self.assertRegex(text, r"memory  +about [0-9.]+ [kM]B of state and scratch on all ranks together, "
                               r"[0-9.]+ [kM]B on rank 0")
        self.assertRegex(text, r"device memory  about [0-9.]+ MB on each rank's GPU \(estimate\)")
        if BACKEND == "cuda":
            both = [MPIEXEC, "-n", "2", "env", "CUDA_VISIBLE_DEVICES=0", SCREE, "check", str(DAM[0])]
            text = subprocess.run(both, env=ENVIRONMENT, capture_output=True, text=True, timeout=LIMIT,
                                  check=True).stdout
            self.assertRegex(text, r"\(estimate\), [0-9.]+ MB for the 2 ranks that share one; [0-9]+ MB are free")

    def test_a_full_disk_ends_all_with_one_message(self):
        settings = [*EXPLICIT, "integrator.substeps=3", "time.end=0.05", "output.snapshot_interval=0.005",
                    "output.history_contacts=[]"]  # the particles' file is to be the largest
        for on_both in (False, True):
            with self.subTest(on_both=on_both):
                out = f"full on both: {on_both}"
                free = self.command(1, DAM[0], out, settings)[3:]
                words = " ".join(f"'{word}'" for word in free)
                limited = ["bash", "-c", f"ulimit -f 300; trap '' XFSZ; exec {words}"]  # [KiB], more than one snapshot
                second = limited if on_both else free
                result = subprocess.run([MPIEXEC, "-n", "1", *limited, ":", "-n", "1", *second], cwd=self.folder,
                                        env=ENVIRONMENT, capture_output=True, text=True, timeout=LIMIT)
                self.assertEqual(result.returncode, IO_FAILED, result.stdout + result.stderr)
                self.assert_one_message(result, "particles.vtkhdf.spare: cannot")
                self.assertIn("particles.vtkhdf.spare", self.record(out)["run"]["status"])
                if results is not None:
                    self.assertGreater(len(list(results.snapshots(self.folder / out))), 0)

    def test_results_of_an_earlier_run_are_refused_once(self):
        deck = self.write("deck.toml", LONELY)
        self.run_deck(DONE, 2, deck, "out", ["time.end=0.01"])
        command = [word for word in self.command(2, deck, "out", ["time.end=0.01"]) if word != "--overwrite"]
        result = subprocess.run(command, cwd=self.folder, env=ENVIRONMENT, capture_output=True, text=True,
                                timeout=LIMIT)
        self.assertEqual(result.returncode, BAD_INPUT, result.stderr)
        self.assert_one_message(result, str(self.folder / "out"), "history.h5", "--overwrite")

    def test_a_rank_without_a_gpu_is_reported_once(self):
        deck = self.write("deck.toml", LONELY)
        run = [SCREE, "run", str(deck), "--backend", "cuda"]
        for ranks in ([run, ["env", "CUDA_VISIBLE_DEVICES=", *run]], [["env", "CUDA_VISIBLE_DEVICES=", *run]] * 2):
            with self.subTest(ranks=ranks):
                result = subprocess.run([MPIEXEC, "-n", "1", *ranks[0], ":", "-n", "1", *ranks[1]], cwd=self.folder,
                                        env=ENVIRONMENT, capture_output=True, text=True, timeout=LIMIT)
                self.assertEqual(result.returncode, BAD_INPUT, result.stderr)
                self.assert_one_message(result, "--backend cuda: ", "allowed here: auto, cpu")


class SignalTest(RanksTest):
    SETTINGS = [*EXPLICIT, "integrator.substeps=3", "time.end=40", "output.checkpoint_interval=0.02"]

    @classmethod
    def setUpClass(cls):
        # Where whoever started the tests has blocked it, mpirun would pass none on.
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGUSR1})

    def start(self, ranks):
        """A run that would take long, once it has written a checkpoint."""
        run = subprocess.Popen(self.command(ranks, DAM[0], "out", self.SETTINGS), cwd=self.folder, env=ENVIRONMENT,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(run.kill)
        self.wait_for(run, self.folder / "out" / "checkpoint.h5")
        return run

    def children(self, parent):
        listed = subprocess.run(["ps", "-o", "pid=,comm=", "--ppid", str(parent)], capture_output=True, text=True)
        lines = [line.split() for line in listed.stdout.splitlines()]
        return [int(words[0]) for words in lines if "scree" in words[1]]

    def test_a_signal_stops_all_ranks_with_a_checkpoint(self):
        # To one rank, or to mpirun, as a batch system does it.
        for to_one_rank, number in ((True, signal.SIGHUP), (False, signal.SIGUSR1), (False, signal.SIGUSR2)):
            with self.subTest(to_one_rank=to_one_rank, number=number.name):
                run = self.start(2)
                os.kill(self.children(run.pid)[1] if to_one_rank else run.pid, number)
                self.assertEqual(run.wait(LIMIT), STOPPED)
                record = self.record("out")
                self.assertIn("stopped by signal", record["run"]["status"])
                end = record["measures"]["simulated_time"] + 0.01
                self.run_deck(DONE, 3, DAM[0], "on", [*self.SETTINGS, f"time.end={end}"], "--restart",
                              self.folder / "out" / "checkpoint.h5")
                (self.folder / "out" / "checkpoint.h5").unlink()

    def test_checkpoints_by_the_clock_on_the_wall_change_no_bit(self):
        settings = [*EXPLICIT, "integrator.substeps=3", "time.end=0.2"]
        self.run_deck(DONE, 1, DAM[0], "none", [*settings, "output.checkpoint_wall_interval=0"])
        self.assertFalse((self.folder / "none" / "checkpoint.h5").exists())
        for ranks in (1, 2):
            self.run_deck(DONE, ranks, DAM[0], f"many {ranks}", [*settings, "output.checkpoint_wall_interval=1e-9"])
            self.assertTrue((self.folder / f"many {ranks}" / "checkpoint.h5").exists())
            self.assertEqual(self.hash(f"many {ranks}"), self.hash("none"))
            self.run_deck(DONE, 3 - ranks, DAM[0], "on", settings, "--restart",
                          self.folder / f"many {ranks}" / "checkpoint.h5")
            self.assertEqual(self.hash("on"), self.hash("none"))

    def test_a_signal_to_one_rank_before_the_first_step_stops_all(self):
        fifo = self.folder / "fifo.toml"
        os.mkfifo(fifo)
        words = [SCREE, "run", str(DAM[0]), "--output", str(self.folder / "out")]
        waiting = [str(fifo) if word == str(DAM[0]) else word for word in words]
        run = subprocess.Popen([MPIEXEC, "-n", "1", *words, ":", "-n", "1", *waiting], env=ENVIRONMENT, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(run.kill)
        with open(fifo, "w") as deck:  # waits for the rank, which then waits for its deck
            os.kill(self.children(run.pid)[1], signal.SIGUSR1)
            deck.write(DAM[0].read_text())
        text, trouble = run.communicate(timeout=LIMIT)
        self.assertEqual(run.returncode, STOPPED, text + trouble)
        self.assertEqual(text.splitlines(), [f"stopped by signal ({signal.strsignal(signal.SIGUSR1)}) before the first "
                                             "step, without a new checkpoint"])
        self.assertFalse((self.folder / "out").exists())

    def test_a_killed_rank_ends_the_job_and_leaves_the_last_checkpoint(self):
        run = self.start(2)
        os.kill(self.children(run.pid)[1], signal.SIGKILL)
        self.assertNotEqual(run.wait(LIMIT), DONE)
        with self.subTest("the checkpoint is complete"):
            result = subprocess.run(self.command(1, DAM[0], "on", [*self.SETTINGS, "time.end=0.0"], "--restart",
                                                 self.folder / "out" / "checkpoint.h5"), cwd=self.folder,
                                    env=ENVIRONMENT, capture_output=True, text=True, timeout=LIMIT)
            self.assertIn("time.end", result.stderr)  # it was read


if __name__ == "__main__":
    unittest.main(verbosity=2)
