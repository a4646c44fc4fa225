"""The sbatch files of jobs/ on a real SLURM, which runs on this machine for the test (cluster.py). Exits with 4, which
ctest shows as skipped, where SLURM is not installed. Usage: SCREE=path/to/scree python3 test_slurm.py"""

import json
import os
import pathlib
import re
import signal
import sys
import time
import unittest

from cluster import Cluster, missing

SCREE = os.environ["SCREE"]
HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
DECK = HERE.parent / "ranks/dam_break.toml"
COMMON = ["--backend", "cpu", "--set", "integrator.particles=velocity-verlet", "--set", "integrator.substeps=3",
          "--set", "output.checkpoint_interval=0.02", "--set"]
SHORT, LONG = [*COMMON, "time.end=0.1"], [*COMMON, "time.end=0.6"]  # the long one is met on its way
LIMIT = 150  # [s] for any one wait: past it, a job hangs
SKIPPED = 4

DONE, BAD_INPUT, STOPPED = 0, 2, 5
ENDED = ("COMPLETED", "FAILED", "CANCELLED", "TIMEOUT", "NODE_FAIL", "OUT_OF_MEMORY", "BOOT_FAIL")
MPIRUN = {"SCREE_LAUNCHER": "mpirun"}

cluster = None  # the tests share one


def setUpModule():
    global cluster
    cluster = Cluster()
    unittest.addModuleCleanup(stop)
    cluster.start()
    for name, settings in ("short", SHORT), ("long", LONG):
        result = cluster.run(SCREE, "run", str(DECK), "--output", str(cluster.folder / name), *settings)
        assert result.returncode == DONE, result.stderr


def stop():
    left = cluster.stop()
    assert not left, f"processes left behind: {left}"


class SlurmTest(unittest.TestCase):
    def setUp(self):
        self.results = cluster.folder / self.id().rsplit(".", 1)[-1]

    def submit(self, file, *words, results=None, options=(), settings=SHORT, environment=None):
        """Submits DECK, or the words; returns the job's id."""
        log = "%A_%a" if file == "array" else "%j"
        words = [str(DECK), str(results or self.results), *settings] if not words else [str(word) for word in words]
        submitted = cluster.run("sbatch", "--parsable", f"--output={cluster.folder}/{log}.log", "--time=10",
                                "--signal=B:USR1@60", *options, f"{ROOT}/jobs/{file}.sbatch", *words,
                                cwd=cluster.folder, environment={"SCREE": SCREE, **(environment or {})})
        self.assertEqual(submitted.returncode, 0, submitted.stderr)
        return submitted.stdout.strip()

    def job(self, job):
        """What SLURM knows about a job."""
        shown = cluster.run("scontrol", "--oneliner", "show", "job", job)
        self.assertEqual(shown.returncode, 0, shown.stderr)
        return dict(word.split("=", 1) for word in shown.stdout.split() if "=" in word)

    def log(self, job):
        path = cluster.folder / f"{job}.log"
        return path.read_text() if path.exists() else ""

    def until(self, condition, job):
        deadline = time.monotonic() + LIMIT
        while not (value := condition()):
            self.assertLess(time.monotonic(), deadline, f"{self.job(job)}\n{self.log(job)}{cluster.logs()}")
            time.sleep(0.1)
        return value

    def finish(self, job, state="COMPLETED", code=DONE, restarts=0):
        """Waits for the end of a job, which must be this one."""
        self.until(lambda: self.job(job)["JobState"] in ENDED, job)
        self.until(lambda: not cluster.processes_of_job(job, "scree"), job)
        shown = self.job(job)
        self.assertEqual((shown["JobState"], shown["ExitCode"]), (state, f"{code}:0"), self.log(job))
        if restarts is not None:
            self.assertEqual(shown["Restarts"], str(restarts), self.log(job))
        return self.log(job)

    def halted(self, job, after=0):
        """Halts all ranks of the job once there is a checkpoint newer than this one; returns them."""
        checkpoint = self.results / "checkpoint.h5"
        deadline = time.monotonic() + LIMIT
        while not checkpoint.exists() or checkpoint.stat().st_mtime_ns <= after:
            self.assertLess(time.monotonic(), deadline, f"{self.job(job)}\n{self.log(job)}{cluster.logs()}")
            time.sleep(0.005)
        ranks = cluster.processes_of_job(job, "scree")
        self.assertTrue(ranks, f"ended too soon: {self.log(job)}")
        self.send(signal.SIGSTOP, ranks)
        return ranks

    def send(self, number, ranks):
        for rank in ranks:
            os.kill(rank, number)

    def warn(self, job, ranks, number="USR1"):
        """The signal that SLURM sends before the time limit, or another, to a job whose ranks are halted: they
        go on."""
        known = self.log(job).count("asking the run")
        self.assertEqual(cluster.run("scancel", "--batch", f"--signal={number}", job).returncode, 0)
        self.until(lambda: self.log(job).count("asking the run") > known, job)
        self.send(signal.SIGCONT, ranks)

    def record(self, results=None):
        return json.loads(((results or self.results) / "run_record.json").read_text())["run"]

    def assert_bits(self, of, ranks, results=None, continued=False):
        """The run is done, has the bits of a run on one rank without interruption, and had so many ranks. Whether its
        last part continued from a checkpoint."""
        record = self.record(results)
        checkpoint = str(self.results / "checkpoint.h5") if continued else ""
        self.assertEqual(record["restarted_from"], checkpoint)
        self.assertEqual((record["status"], record["ranks"]), ("done", ranks))
        self.assertEqual(record["state_hash"], self.record(cluster.folder / of)["state_hash"])


class RunTest(SlurmTest):
    def test_one_node_with_srun_and_with_mpirun(self):
        jobs = {}
        for launcher in ({}, MPIRUN):
            for ranks in (2, 4):
                results = cluster.folder / f"one_node_{len(launcher)}_{ranks}"
                jobs[results] = ranks, self.submit("one_node", results=results, options=[f"--ntasks={ranks}"],
                                                   environment=launcher)
        for results, (ranks, job) in jobs.items():
            with self.subTest(results=results.name):
                self.finish(job)
                self.assert_bits("short", ranks, results)

    def test_several_nodes(self):
        job = self.submit("several_nodes", options=["--nodes=2", "--ntasks-per-node=2"])
        self.finish(job)
        self.assertEqual(self.job(job)["NumNodes"], "2")
        self.assert_bits("short", 4)

    def test_an_array_of_decks(self):
        decks = cluster.folder / "decks.txt"
        good = " ".join([str(DECK), *SHORT])
        decks.write_text(f"{good}\n{good} --set time.stp=1\n\n  # {good}\n{good}")
        array = self.submit("array", decks, self.results, options=["--array=1-6"])
        bad = {2: "time.stp", 6: f"there is no line 6 in {decks}, which has 5"}
        for element in range(1, 7):
            with self.subTest(element=element):
                name = f"{array}_{element}"
                if element in bad:
                    self.assertIn(bad[element], self.finish(name, "FAILED", BAD_INPUT))
                elif element in (3, 4):
                    self.assertIn(f"line {element} of {decks} is empty or a comment: nothing to run", self.finish(name))
                    self.assertFalse((self.results / str(element)).exists())
                else:
                    self.finish(name)
                    self.assert_bits("short", 1, self.results / str(element))

    def test_every_rank_sees_the_gpus_of_its_node_and_takes_its_own(self):
        for options, ranks in (["--nodes=1", "--ntasks=2"], 2), (["--nodes=2", "--ntasks-per-node=2"], 4):
            for launcher in (["srun"], ["salloc", "--quiet", "mpirun"]):
                if len(launcher) > 1 and ranks > 2:
                    continue  # mpirun's daemons of two nodes would meet on one machine
                with self.subTest(launcher=launcher[-1], ranks=ranks):
                    resources = [*options, "--gpus-per-node=2"]
                    shown = cluster.run(*launcher[:1], *resources, *launcher[1:], "jobs/mapping.sh", cwd=ROOT)
                    self.assertEqual(shown.returncode, 0, shown.stderr)
                    lines = sorted(shown.stdout.splitlines())
                    self.assertEqual(len(lines), ranks, shown.stdout)
                    nodes = [re.search(r"node (\w+),", line)[1] for line in lines]
                    # Any nodes, where one is still busy with the last job's end.
                    self.assertEqual(len(set(nodes)), ranks // 2)
                    for rank, line in enumerate(lines):
                        node = nodes[rank // 2 * 2]
                        self.assertIn(f"rank {rank} of {ranks}: node {node}, local rank {rank % 2}, ", line)
                        self.assertIn(f"GPU {rank % 2} of 0 1", line)
        alone = cluster.run("srun", "--nodes=1", "--ntasks=2", "--gpus-per-task=1", "jobs/mapping.sh", cwd=ROOT)
        self.assertEqual(len(alone.stdout.splitlines()), 2, alone.stdout + alone.stderr)
        for rank, line in enumerate(sorted(alone.stdout.splitlines())):
            self.assertTrue(line.endswith(f"GPU {rank} of {rank}"), alone.stdout + alone.stderr)


class EndTest(SlurmTest):
    def test_the_time_limit_leads_to_a_checkpoint_and_back_into_the_queue(self):
        # SLURM looks every 30 s for jobs near their limit. This run is shorter; it is halted until SLURM has looked.
        job = self.submit("long", settings=LONG, options=["--ntasks=2", "--time=1"])
        ranks = self.halted(job)
        self.assertEqual(len(ranks), 2)
        self.until(lambda: "the time limit is near" in self.log(job), job)
        self.send(signal.SIGCONT, ranks)
        log = self.finish(job, restarts=None)  # one, or more on a slow machine
        self.assertGreater(int(self.job(job)["Restarts"]), 0)
        self.assertRegex(log, "start 1 on n[01]: begins")
        self.assertIn("back in the queue", log)
        self.assertRegex(log, f"start 2 on n[01]: continues from {self.results}/checkpoint.h5")
        self.assert_bits("long", 2, continued=True)

    def test_the_same_with_mpirun_up_to_the_last_requeue(self):
        environment = {**MPIRUN, "SCREE_REQUEUES": "1"}
        job = self.submit("long", settings=LONG, options=["--ntasks=2"], environment=environment)
        self.warn(job, self.halted(job))
        self.until(lambda: "back in the queue" in self.log(job), job)
        self.warn(job, self.halted(job, after=(self.results / "checkpoint.h5").stat().st_mtime_ns))
        log = self.finish(job, "FAILED", STOPPED, restarts=1)
        self.assertIn("after 1 of at most 1 requeues", log)
        self.assertIn("stopped by signal", self.record()["status"])

        self.finish(self.submit("one_node", settings=LONG))  # on one rank now
        self.assert_bits("long", 1, continued=True)
        ended = self.record()["ended"]
        self.assertIn("done already", self.finish(self.submit("long", settings=LONG)))
        self.assertEqual(self.record()["ended"], ended)

    def test_a_job_that_slurm_puts_back_continues(self):
        job = self.submit("long", settings=LONG, options=["--nodes=2", "--ntasks-per-node=1"])
        self.halted(job)  # SLURM lets the ranks go on to end them
        self.assertEqual(cluster.run("scontrol", "requeue", job).returncode, 0)
        self.assertIn("continues from", self.finish(job, restarts=1))
        self.assert_bits("long", 2, continued=True)

    def test_a_cancelled_job_leaves_a_checkpoint_and_does_not_come_back(self):
        job = self.submit("long", settings=LONG, options=["--ntasks=2"])
        self.halted(job)
        self.assertEqual(cluster.run("scancel", job).returncode, 0)
        self.until(lambda: self.job(job)["JobState"] in ENDED, job)
        shown = self.job(job)
        self.assertEqual((shown["JobState"], shown["Restarts"]), ("CANCELLED", "0"), self.log(job))
        self.assertIn("stopped by signal", self.record()["status"])
        self.finish(self.submit("long", settings=LONG))
        self.assert_bits("long", 1, continued=True)

    def test_a_job_with_mpirun_can_be_ended_with_a_checkpoint(self):
        job = self.submit("long", settings=LONG, options=["--ntasks=2"], environment=MPIRUN)
        self.warn(job, self.halted(job), "TERM")
        self.assertIn("ends with exit code 5", self.finish(job, "FAILED", STOPPED))
        self.assertIn("stopped by signal", self.record()["status"])

    def test_a_job_without_requeues_ends_with_a_checkpoint(self):
        job = self.submit("one_node", settings=LONG)
        self.warn(job, self.halted(job))
        self.assertIn("submitted again, the run continues", self.finish(job, "FAILED", STOPPED))

    def test_a_signal_that_comes_before_the_run_can_hear_it_stops_it_too(self):
        deaf = cluster.folder / "deaf"
        deaf.write_text("#!/bin/sh\nexec sleep 60\n")
        deaf.chmod(0o755)
        job = self.submit("one_node", environment={"SCREE_LAUNCHER": str(deaf)})
        self.until(lambda: cluster.processes_of_job(job, "sleep"), job)
        self.warn(job, [])
        self.assertIn("before the run could hear it", self.finish(job, "FAILED", STOPPED))

    def test_a_failure_ends_the_job(self):
        bad = [*SHORT, "--set", "time.step=0"]
        self.assertIn("time.step", self.finish(self.submit("long", settings=bad), "FAILED", BAD_INPUT))
        log = self.finish(self.submit("long", environment={"SCREE": "nowhere/scree"}), "FAILED", BAD_INPUT)
        self.assertIn("no program nowhere/scree", log)

    def test_a_killed_rank_ends_the_job(self):
        for name, launcher in ("srun", {}), ("mpirun", MPIRUN):
            with self.subTest(name):
                self.results = cluster.folder / f"killed_{name}"
                job = self.submit("long", settings=LONG, options=["--ntasks=2"], environment=launcher)
                ranks = self.halted(job)
                self.send(signal.SIGKILL, ranks[1:])
                self.send(signal.SIGCONT, ranks[:1])
                self.until(lambda: self.job(job)["JobState"] in ENDED, job)
                shown = self.job(job)
                self.assertEqual((shown["JobState"], shown["Restarts"]), ("FAILED", "0"), self.log(job))
                self.until(lambda: not cluster.processes_of_job(job, "scree"), job)


if __name__ == "__main__":
    if missing():
        print(f"skipped: SLURM is not installed (jobs/setup.sh --slurm); there is no {', '.join(missing())}")
        sys.exit(SKIPPED)
    unittest.main(verbosity=2)
