"""The folder of results: what is refused, overwritten, left as it is.
Usage: SCREE=path/to/scree python3 test_folder.py"""

import os
import pathlib
import shutil
import signal
import unittest

from test_cli import BAD_INPUT, DECK, DONE, IO_FAILED, LIMIT, CommandLineTest

SHORT = ("--set", "time.end=0.02", "--set", "output.checkpoint_interval=0.01")
LONG = ("--set", "time.step=2e-5", "--set", "output.history_interval=0.001", "--set", "output.checkpoint_interval=0.01")


class FolderTest(CommandLineTest):
    def run_into(self, code, output, *words):
        return self.expect(code, "run", self.deck, "--output", self.folder / output, *words)

    def contents(self, output):
        return {path.name: path.read_bytes() for path in (self.folder / output).iterdir()}

    def test_results_are_not_overwritten_unasked(self):
        self.run_into(DONE, "out", *SHORT)
        before = self.contents("out")
        message = self.run_into(BAD_INPUT, "out", *SHORT).stderr
        for word in (str(self.folder / "out"), *before, "--overwrite", "--output", "continues them",
                     f"--restart {self.folder}/out/checkpoint"):
            self.assertIn(word, message)
        # Nor by a run that goes on from another folder, or that is refused for what comes later.
        self.run_into(DONE, "other", *SHORT)
        restart = ("--restart", self.folder / "other/checkpoint.h5")
        self.assertIn("--overwrite", self.run_into(BAD_INPUT, "out", *SHORT, *restart).stderr)
        for words in (("--set", "time.step=-1"), ("--set", "bodies.0.mass=0"), ("--restart", self.folder / "none.h5"),
                      ("--set", "parallel.transport=nccl", "--backend", "cuda", "--set", "time.step=1"), restart + (
                          "--set", "time.end=0.005")):
            with self.subTest(words=words):
                self.expect(IO_FAILED if "none.h5" in str(words[-1]) else BAD_INPUT, "run", self.deck, "--output",
                            self.folder / "out", "--overwrite", *SHORT, *words)
                self.assertEqual(self.contents("out"), before)

    def test_what_is_overwritten_goes_as_a_whole(self):
        self.run_into(DONE, "out", *SHORT)
        self.write("out/notes.txt", "mine")
        for name in ("checkpoint_failed.h5", "bodies.vtkhdf.spare", "checkpoint_end.h5.tmp"):
            self.write(f"out/{name}", "left by a run that was killed")
        particles = DECK.index("[[particles]]")
        head = DECK[:min(DECK.index(table) for table in ("[[bodies]]", "[[particles]]"))]
        self.deck = self.write("smaller.toml", head + DECK[particles:].split("[output]")[0])
        self.run_into(DONE, "fresh", "--set", "time.end=0.01")
        self.run_into(DONE, "out", "--set", "time.end=0.01", "--overwrite")
        self.assertEqual(set(self.contents("out")), set(self.contents("fresh")) | {"notes.txt"})
        self.assertNotIn("bodies.vtkhdf", self.contents("out"))

    def test_a_continued_run_leaves_no_checkpoint_of_steps_that_it_takes_anew(self):
        self.run_into(DONE, "out", *SHORT)
        end = (self.folder / "out/checkpoint_end.h5").read_bytes()
        self.run_into(DONE, "out", *SHORT, "--restart", self.folder / "out/checkpoint.h5")
        self.assertEqual((self.folder / "out/checkpoint_end.h5.earlier").read_bytes(), end)
        self.assertFalse((self.folder / "out/checkpoint.h5.earlier").exists())
        self.run_into(DONE, "out", *SHORT, "--overwrite")
        self.assertFalse((self.folder / "out/checkpoint_end.h5.earlier").exists())

    def test_two_runs_do_not_share_a_folder_and_a_kill_leaves_it_to_the_next(self):
        self.run_into(DONE, "whole", *LONG)
        first = self.start("out", *LONG)
        first.send_signal(signal.SIGSTOP)
        for words in ((), ("--overwrite",), ("--restart", self.folder / "out/checkpoint.h5")):
            message = self.run_into(BAD_INPUT, "out", *LONG, *words).stderr
            self.assertIn(f"process {first.pid} on host {os.uname().nodename}", message)
            self.assertIn(str(self.folder / "out/scree.lock"), message)
        first.kill()
        first.wait(LIMIT)
        self.assertTrue((self.folder / "out/scree.lock").exists())
        self.run_into(DONE, "out", *LONG, "--restart", self.folder / "out/checkpoint.h5")
        self.assert_same_results("out", "whole")
        self.assertFalse((self.folder / "out/scree.lock").exists())

    def test_a_signal_and_a_failure_let_go_of_the_folder(self):
        run = self.start("out", *LONG)
        run.send_signal(signal.SIGTERM)
        run.stdout.read()
        run.wait(LIMIT)
        self.assertFalse((self.folder / "out/scree.lock").exists())
        self.run_deck(3, "out", "--set", "integrator.max_iterations=2")
        self.assertFalse((self.folder / "out/scree.lock").exists())

    def test_a_copied_checkpoint_alone_is_where_a_run_begins(self):
        self.run_into(DONE, "first", *SHORT)
        (self.folder / "out").mkdir()
        shutil.copy(self.folder / "first/checkpoint.h5", self.folder / "out/checkpoint.h5")
        self.run_into(DONE, "out", *SHORT, "--restart", self.folder / "out/checkpoint.h5")
        shutil.copy(self.folder / "first/checkpoint_end.h5", self.folder / "first/mine.h5")
        self.run_into(DONE, "first", "--set", "time.end=0.03", "--restart", self.folder / "first/mine.h5")
        rows = self.history("first")
        self.assertEqual((float(rows[1].split(",")[0]), float(rows[-1].split(",")[0])), (0, 0.03))

    def test_without_a_folder_each_deck_has_its_own(self):
        self.expect(DONE, "run", self.deck, *SHORT)
        self.assertTrue((self.folder / "results/deck/history.h5").exists())
        shutil.copy(self.deck, self.folder / "second.toml")
        self.expect(DONE, "run", "second.toml", *SHORT)

    def test_links_in_the_folder_are_not_followed(self):
        victim = self.write("victim", "untouched")
        (self.folder / "out").mkdir()
        for name in ("checkpoint.h5", "checkpoint_end.h5", "run_record.json", "particles.vtkhdf", "history.csv"):
            for beside in (".tmp", ".spare"):
                pathlib.Path(self.folder / "out" / (name + beside)).symlink_to(victim)
        self.run_into(DONE, "out", *SHORT)
        self.assertEqual(victim.read_text(), "untouched")
        self.assertFalse([path for path in (self.folder / "out").iterdir() if path.is_symlink()])


if __name__ == "__main__":
    unittest.main()
