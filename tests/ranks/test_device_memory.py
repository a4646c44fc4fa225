"""Runs that find no memory on a GPU, because another program has taken it: refused before they start, or ended with one
message and a state to go on from. Needs a GPU.
Usage: SCREE=path/to/scree MPIEXEC=path/to/mpirun HOLD_DEVICE_MEMORY=path/to/hold_device_memory SCREE_TEST_BACKEND=cuda
python3 test_device_memory.py"""

import contextlib
import os
import shutil
import signal
import subprocess
import unittest

from mpi_case import (BAD_INPUT, DONE, ENVIRONMENT, EXPLICIT, FAILED, IMPLICIT, LIMIT, LONELY, RanksTest, gpus)

HOLD_DEVICE_MEMORY = os.environ["HOLD_DEVICE_MEMORY"]

# Two slabs of spheres of which one flies through the other, without touching it. The list of either fits into the room
# that it has at the start; from t = 9 s on the two need more, and nothing else does: there are no ghosts.
SLABS = """[space]
dimension = 3
min = [0.0, 0.0, 0.0]
max = [40.0, 151.0, 151.0]

[time]
end = 16.0
step = 1e-4
control = "fixed"

[contact]
skin = 1.37

[[contact.pairs]]
stiffness = 1.0

[[particles]]
name = "at_rest"
kind = "lattice"
origin = [18.5, 0.5, 0.5]
spacing = [1.0, 1.0, 1.0]
size = [8, 150, 150]
radius = 0.1
mass = 1.0

[[particles]]
name = "agitated"
kind = "lattice"
origin = [1.0, 1.0, 0.5]
spacing = [1.0, 1.0, 1.0]
size = [8, 150, 150]
radius = 0.1
mass = 1.0
velocity = [1.0, 0.0, 0.0]

[output]
history_interval = 1.0
checkpoint_interval = 1.0
"""


# Spheres with friction. Each rank generates some layers and receives others: the domain is cut across its length.
LONG_BED = """[space]
dimension = 3
min = [0.0, 0.0, 0.0]
max = [2.6, 0.65, 0.65]

[time]
end = 5e-4
step = 1e-5

[integrator]
particles = "velocity-verlet"

[[materials]]
name = "grain"
density = 2500.0

[[contact.pairs]]
stiffness = 1e4
friction = 0.4

[[particles]]
name = "bed"
kind = "lattice"
origin = [0.006, 0.006, 0.006]
spacing = [0.01, 0.01, 0.01]
size = [255, 63, 63]
radius = 0.005
random_velocity = 0.01
material = "grain"
"""


class DeviceMemoryTest(RanksTest):
    @contextlib.contextmanager
    def no_memory(self, gpu):
        """Nothing is free on the GPU, and what is freed there is taken."""
        with subprocess.Popen([HOLD_DEVICE_MEMORY, str(gpu)], stdout=subprocess.PIPE, text=True) as hold:
            try:
                self.assertEqual(hold.stdout.readline(), "held\n", f"{HOLD_DEVICE_MEMORY} has not got GPU {gpu}")
                yield
                self.assertIsNone(hold.poll(), f"{HOLD_DEVICE_MEMORY} has ended while it should hold the memory")
            finally:
                hold.kill()

    def start(self, words):
        run = subprocess.Popen(words, cwd=self.folder, env=ENVIRONMENT, stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.kill)
        return run

    def assert_failed_for_want_of_memory(self, run):
        message = run.communicate(timeout=LIMIT)[1]
        self.assertEqual(run.returncode, FAILED, f"0: the run has found the memory that it should not find\n{message}")
        self.assertEqual(message.count("error:"), 1, message)
        self.assertIn("out of memory", message)

    def test_a_list_that_cannot_grow_leaves_the_last_good_state(self):
        deck = self.write("slabs.toml", SLABS)
        for how in ([*EXPLICIT, "time.step=1e-4"], [*IMPLICIT, "time.step=4e-4"]):
            with self.subTest(how=how):
                shutil.rmtree(self.folder / "out", ignore_errors=True)
                run = self.start(self.command(1, deck, "out", how)[3:])  # scree itself, to be stopped
                self.wait_for(run, self.folder / "out" / "checkpoint.h5")
                run.send_signal(signal.SIGSTOP)  # far from the list's growth, for as long as taking the memory takes
                with self.no_memory(0):
                    run.send_signal(signal.SIGCONT)
                    self.assert_failed_for_want_of_memory(run)
                self.assertEqual(self.record("out")["run"]["exit_code"], FAILED)
                failed = self.folder / "out" / "checkpoint_failed.h5"
                self.assertTrue(failed.exists(), "there is no checkpoint_failed.h5")
                self.run_deck(DONE, 1, deck, "on", how, "--restart", failed)
                self.run_deck(DONE, 1, deck, "whole", how)
                self.assertEqual(self.hash("on"), self.hash("whole"),
                                 "the run went on from another state than it was in")

    def test_several_ranks_hold_little_more_than_one(self):
        deck = self.write("long_bed.toml", LONG_BED)
        held = {}
        for ranks in (1, 4):
            self.run_deck(DONE, ranks, deck, f"{ranks}")
            held[ranks] = self.record(f"{ranks}")["cost"]["device_memory_kib"]
        self.assertGreater(held[1], 500_000)
        self.assertLess(held[4], 1.3 * held[1], "each has some 40 MB for itself, and ghosts")

    def test_a_full_gpu_is_refused_before_the_run_starts(self):
        many = LONELY
        for old, new in (("max = [1.0, 1.0]", "max = [14.0, 14.0]"), ('"row"', '"lattice"'),
                         ("count = 2", "size = [70, 70]"), ("origin = [0.25, 0.5]", "origin = [0.1, 0.1]"),
                         ("spacing = [0.5, 0.0]", "spacing = [0.2, 0.2]"), ("end = 1.0", "end = 0.01")):
            self.assertIn(old, many)
            many = many.replace(old, new)
        deck = self.write("deck.toml", many)
        for ranks in (1, 2):
            with self.subTest(ranks=ranks), self.no_memory(0):
                result = self.run_deck(BAD_INPUT, ranks, deck, "refused")
                self.assert_one_message(result)
                self.assertRegex(result.stderr, r"error: --backend cuda: .*memory.*; allowed here: auto, cpu\n")
                self.assertFalse((self.folder / "refused").exists(), "a refused run has made its folder")
                log = self.run_deck(DONE, ranks, deck, f"auto {ranks}", backend="auto").stdout
                self.assertRegex(log, r"(?m)^backend cpu: .*memory")

    @unittest.skipUnless(gpus() > 1, "needs two GPUs")
    def test_a_rank_without_device_memory_ends_all(self):
        crowd = LONELY
        for old, new in (("dimension = 2", "dimension = 3"), ("min = [0.0, 0.0]", "min = [0.0, 0.0, 0.0]"),
                         ("max = [1.0, 1.0]", "max = [100.0, 100.0, 100.0]"), ('"row"', '"lattice"'),
                         ("count = 2", "size = [100, 100, 100]"), ("origin = [0.25, 0.5]", "origin = [0.5, 0.5, 0.5]"),
                         ("spacing = [0.5, 0.0]", "spacing = [1.0, 1.0, 1.0]"), ("radius = 0.05", "radius = 0.3"),
                         ("velocity = [0.0, 0.123456789]", "random_velocity = 1.0"), ("end = 1.0", "end = 1e4"),
                         ('y_max = "periodic"', 'y_max = "periodic"\nz_min = "periodic"\nz_max = "periodic"')):
            self.assertIn(old, crowd)
            crowd = crowd.replace(old, new)
        deck = self.write("deck.toml", crowd)
        settings = [*EXPLICIT, "output.checkpoint_interval=0.2", "output.history_interval=0.2"]
        run = self.start(self.command(2, deck, "out", settings))
        self.wait_for(run, self.folder / "out" / "checkpoint.h5")
        with self.no_memory(1):  # which a list wants that has more than the one before
            self.assert_failed_for_want_of_memory(run)
        # Where the other rank could be told, both have written it.
        left = self.folder / "out" / "checkpoint_failed.h5"
        if not left.exists():
            left = self.folder / "out" / "checkpoint.h5"
        reached = self.record("out")["measures"]["simulated_time"]
        self.run_deck(DONE, 2, deck, "on", [*settings, f"time.end={reached + 1}"], "--restart", left)


if __name__ == "__main__":
    unittest.main(verbosity=2)
