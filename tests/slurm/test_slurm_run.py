"""jobs/slurm_run.sh without SLURM: what it continues, leaves as it is and refuses. Usage: SCREE=path/to/scree python3
test_slurm_run.py"""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
LIMIT = 150  # [s] for any one run: past it, it hangs
ENVIRONMENT = dict(os.environ, SCREE=os.environ["SCREE"], SCREE_LAUNCHER="env", SLURM_JOB_ID="7",
                   OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
SETTINGS = ("--backend", "cpu", "--set", "integrator.particles=velocity-verlet", "--set", "integrator.substeps=3")

DONE, BAD_INPUT = 0, 2


class SlurmRunTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="scree_slurm_run_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.deck = pathlib.Path(shutil.copy(HERE.parent / "ranks/dam_break.toml", self.folder))

    def job(self, code, *options, results="out", deck=None, script="slurm_run.sh", settings=SETTINGS, **environment):
        words = ["bash", ROOT / "jobs" / script, deck or self.deck, self.folder / results, *settings, *options]
        ended = subprocess.run(list(map(str, words)), cwd=ROOT, env={**ENVIRONMENT, **environment}, timeout=LIMIT,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual(ended.returncode, code, ended.stdout)
        return ended.stdout

    def record(self, results="out"):
        return json.loads((self.folder / results / "run_record.json").read_text())

    def test_a_run_that_is_done_goes_on_with_a_later_end_and_is_otherwise_left(self):
        short, longer = ("--set", "time.end=0.01"), ("--set", "time.end=0.02")
        self.assertIn("begins", self.job(DONE, *short))
        before = self.record()
        self.assertIn("done already", self.job(DONE, *short))
        self.assertEqual(self.record(), before)

        log = self.job(DONE, *longer)
        self.assertIn("but not known to be with these words", log)
        self.assertIn("continues from", log)
        self.assertEqual(self.record()["measures"]["simulated_time"], 0.02)
        self.assertIn("done already", self.job(DONE, *longer))
        self.job(DONE, *longer, results="whole")
        self.assertEqual(self.record()["run"]["state_hash"], self.record("whole")["run"]["state_hash"])

        # What is refused once is refused again, and what was done stays done.
        for _ in range(2):
            self.assertIn("another deck", self.job(BAD_INPUT, *longer, "--set", "time.step=1e-4"))
            self.assertIn("past time.end", self.job(BAD_INPUT, *short))
        self.assertIn("done already", self.job(DONE, *longer))

    def test_an_edited_deck_and_another_deck_are_noticed(self):
        end = ("--set", "time.end=0.01")
        self.job(DONE, *end)
        os.utime(self.deck)
        self.assertIn("continues from", self.job(DONE, *end))
        self.assertIn("done already", self.job(DONE, *end))
        same = shutil.copy2(self.deck, self.folder / "same.toml")
        self.assertIn("not known to be with these words", self.job(DONE, *end, deck=same))
        other = self.folder / "other.toml"
        other.write_text(self.deck.read_text().replace("damping = 5.0", "damping = 6.0"))
        self.assertIn("another deck", self.job(BAD_INPUT, *end, deck=other))

    def test_a_run_that_was_done_without_the_script_is_looked_at_by_scree(self):
        end = ("--set", "time.end=0.01")
        subprocess.run([ENVIRONMENT["SCREE"], "run", self.deck, "--output", self.folder / "out", *SETTINGS, *end],
                       env=ENVIRONMENT, check=True, stdout=subprocess.DEVNULL, timeout=LIMIT)
        done = self.record()["run"]["state_hash"]
        self.assertIn("continues from", self.job(DONE, *end))
        self.assertEqual(self.record()["run"]["state_hash"], done)
        self.assertIn("done already", self.job(DONE, *end))

    def test_options_that_are_the_scripts_own_are_refused(self):
        for words in ("--restart", "a.h5"), ("--restart=a.h5",):
            self.assertIn(f"copy it to {self.folder}/out/checkpoint.h5", self.job(BAD_INPUT, *words))
        for words in ("--output", "a"), ("--output=a",):
            self.assertIn("the results go to RESULTS", self.job(BAD_INPUT, *words))
        self.assertFalse((self.folder / "out").exists())
        self.job(DONE, "--set", "time.end=1e-3", "--", "--restart", "1")  # PETSc's word

    def test_a_copied_checkpoint_is_where_a_run_begins(self):
        self.job(DONE, "--set", "time.end=0.01", results="first")
        (self.folder / "out").mkdir()
        shutil.copy(self.folder / "first/checkpoint_end.h5", self.folder / "out/checkpoint.h5")
        self.assertIn("continues from", self.job(DONE, "--set", "time.end=0.02"))
        self.assertEqual(self.record()["measures"]["simulated_time"], 0.02)

    def test_results_without_a_checkpoint_are_those_of_the_job_or_refused(self):
        (self.folder / "out").mkdir()
        (self.folder / "out/history.h5").write_text("of a run that was killed at once")
        end = ("--set", "time.end=0.01")
        self.assertIn("--overwrite", self.job(BAD_INPUT, *end))
        self.assertIn("start 2 on this node: begins", self.job(DONE, *end, SLURM_RESTART_COUNT="1"))
        (self.folder / "out/checkpoint_end.h5").unlink()
        (self.folder / "out/run_record.json").unlink()
        self.assertIn("start 1 on this node: begins", self.job(DONE, *end, "--overwrite"))

    def test_the_lock_of_a_job_that_has_ended_is_taken_away(self):
        lock = self.folder / "out/scree.lock"
        lock.parent.mkdir()
        # As squeue answers: for a job that waits, one that it does not know, one that runs, and where it cannot ask.
        for code, text, taken in ((0, "PENDING", True), (1, "slurm_load_jobs error: Invalid job id specified", True),
                                  (0, "", True), (0, "RUNNING", False), (0, "COMPLETING", False),
                                  (1, "slurm_load_jobs error: Unable to contact slurm controller", False)):
            with self.subTest(text=text):
                squeue = self.folder / "squeue"
                squeue.write_text(f'#!/bin/sh\n[ "$2" = --jobs=12 ] || exit 9\necho "{text}"\nexit {code}\n')
                squeue.chmod(0o755)
                lock.write_text("host elsewhere\nprocess 5\njob 12\n")
                log = self.job(DONE, "--set", "time.end=0.001", "--overwrite", SCREE_LAUNCHER="true",
                               PATH=f"{self.folder}:{os.environ['PATH']}")
                self.assertEqual("has ended without removing its lock" in log, taken)
                self.assertEqual(lock.exists(), not taken)

    def test_the_launcher_does_not_load_opencl_unless_told(self):
        launcher = self.folder / "launcher"
        launcher.write_text('#!/bin/sh\necho "hwloc: $HWLOC_COMPONENTS"\n')
        launcher.chmod(0o755)
        self.assertIn("hwloc: -opencl\n", self.job(DONE, SCREE_LAUNCHER=str(launcher)))
        self.assertIn("hwloc: all\n", self.job(DONE, SCREE_LAUNCHER=str(launcher), HWLOC_COMPONENTS="all"))

    def test_elements_of_an_array(self):
        line = " ".join(map(str, (self.deck, *SETTINGS, "--set")))
        decks = self.folder / "decks.txt"

        def element(number, code):
            return self.job(code, script="array.sbatch", deck=decks, settings=(), SLURM_ARRAY_TASK_ID=str(number))

        decks.write_text(f"# decks\n\n \t\n{line} time.end=0.005")
        for number in 1, 2, 3:
            self.assertIn(f"line {number} of {decks} is empty or a comment", element(number, DONE))
        self.assertIn(f"there is no line 5 in {decks}, which has 4", element(5, BAD_INPUT))
        self.assertFalse((self.folder / "out").exists())
        element(4, DONE)
        self.assertIn("done already", element(4, DONE))
        decks.write_text(f"\n\n\n{line} time.end=0.01\n")
        self.assertIn("continues from", element(4, DONE))
        self.assertEqual(self.record("out/4")["measures"]["simulated_time"], 0.01)


if __name__ == "__main__":
    unittest.main()
