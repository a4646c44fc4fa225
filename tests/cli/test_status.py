"""What can be told of a run from outside: scree status. Usage: as test_cli.py"""

import json
import os
import pathlib
import re
import signal
import subprocess
import time
import unittest

from test_cli import BAD_INPUT, DONE, ENVIRONMENT, FAILED, IO_FAILED, LIMIT, SCREE, STOPPED, CommandLineTest


class StatusTest(CommandLineTest):
    def status(self, *folders, code=DONE):
        return self.expect(code, "status", *(self.folder / folder for folder in folders)).stdout

    def start_long_run(self):
        """Handed back once it has told of itself."""
        run = subprocess.Popen([SCREE, "run", str(self.deck), "--output", "out", "--set", "time.end=1000"],
                               cwd=self.folder, env=ENVIRONMENT, stdout=subprocess.DEVNULL)
        self.addCleanup(run.kill)
        while run.poll() is None and not (self.folder / "out/status.toml").exists():
            time.sleep(0.05)
        return run

    def test_a_run_that_goes_on_and_one_that_was_killed(self):
        run = self.start_long_run()
        text = self.status("out")
        self.assertRegex(text, rf"\Astate          running: process {run.pid} on host \S+, .*, alive; last status ")
        self.assertRegex(text, r"simulated      \S+ of 1000 s \(\d+ %\)\n")
        run.kill()
        run.wait(LIMIT)
        text = self.status("out")
        self.assertRegex(text, rf"\Astate          killed: process {run.pid} on host \S+ wrote its last status ")
        self.assertNotIn("time left", text)

    def test_a_run_tells_what_its_lists_took(self):
        gas = pathlib.Path(__file__).resolve().parents[2] / "input/examples/gas_periodic.toml"
        text = self.expect(DONE, "run", gas, "--output", self.folder / "gas").stdout
        told = re.search(r" (\d+) list builds \((\d+) % of the time without output; skin (\S+) m, (.*)\)\n", text)
        record = json.loads((self.folder / "gas/run_record.json").read_text())
        seconds = {stage["stage"]: stage["seconds"] for stage in record["stages"] if stage["stage"] != "output"}
        share = sum(seconds[stage] for stage in ("migrate", "sort_cells", "exchange_halo", "neighbors"))
        self.assertEqual(int(told[1]), record["counts"]["list_builds"])
        self.assertAlmostEqual(float(told[3]), record["measures"]["list_skin"], delta=1e-2 * float(told[3]))
        self.assertEqual(told[4], "chosen by the program" if record["counts"]["list_skin_chosen"] else "the default")
        self.assertGreater(int(told[2]), 10)
        self.assertAlmostEqual(int(told[2]), 100 * share / sum(seconds.values()), delta=1)

    def test_a_run_that_was_stopped(self):
        run = self.start_long_run()
        run.send_signal(signal.SIGTERM)
        self.assertEqual(run.wait(LIMIT), STOPPED)
        text = self.status("out")
        self.assertIn(f"state          stopped by signal: {signal.strsignal(signal.SIGTERM)}; process {run.pid}", text)
        # It tells of its end, where its checkpoint is, too.
        self.assertRegex(text, r"simulated      (\S+) of 1000 s .*\n(.*\n)*"
                               r"checkpoint     checkpoint\.h5, t = \1 s, written \d+ s ago\n")

    def test_a_run_that_is_done(self):
        self.run_deck(DONE, "out")
        text = self.status("out")
        for line in ("state          done; process ", "simulated      0.4 of 0.4 s (100 %)\n", "steps          4000, ",
                     "checkpoint     checkpoint_end.h5, t = 0.4 s, written ", "contacts       ", "particle-steps/s",
                     "written        2 snapshots, 4001 rows of the history\n", "warnings       0\n"):
            self.assertIn(line, text)
        self.assertRegex(text, r"energy         balance error \S+ J of \S+ J exchanged \(\S+\)\n")
        self.assertRegex(text, r"on disk        \d\S* [kM]B\n")

    def test_a_run_that_failed(self):
        self.run_deck(FAILED, "out", "--set", "space.leaving=error", "--set", "particles.discs.velocity=[0.0, 50.0]")
        text = self.status("out")
        self.assertRegex(text, r"\Astate          failed: .*particle")
        time, = re.findall(r"simulated      (\S+) of 0\.4 s \(\d+ %\)\n", text)
        good, = re.findall(r"checkpoint     checkpoint_failed.h5, t = (\S+) s, ", text)
        self.assertLessEqual(float(good), float(time))
        steps, rows = (re.findall(pattern, text) for pattern in (r"steps +(\d+),", r", (\d+) rows of the history"))
        record = json.loads((self.folder / "out/run_record.json").read_text())
        for number in (r"contacts       \d+", r"exchanged \(\S+\)"):
            self.assertRegex(text, number + ", at the last row of the history\n")
        self.assertEqual(int(rows[0]), record["counts"]["history_rows"])
        self.assertEqual(float(time), round(1e-4 * int(steps[0]), 9))

    def test_several_folders_are_a_table(self):
        self.run_deck(DONE, "a")
        (self.folder / "empty").mkdir()
        lines = self.status("a", "a").splitlines()
        self.assertEqual(len(lines), 3)
        self.assertRegex(lines[1], r"/a +done +0\.4 of 0\.4 s +100 % +4000 +\S+ particle-steps/s +\S+$")
        text = self.status("a", "empty", "none", code=BAD_INPUT)
        self.assertIn("contains no status.toml of a run", text)
        self.assertRegex(text, r"/none +no such folder\n")
        self.assertIn("done", text)

    def test_what_cannot_be_told_is_one_message(self):
        def message(code):
            text = self.expect(code, "status", self.folder / "out").stderr
            self.assertRegex(text, r"^error: .*\n$")
            return text

        self.assertIn(": no such folder", message(BAD_INPUT))
        self.run_deck(DONE, "out")
        path = self.folder / "out/status.toml"
        text = path.read_text()
        path.write_text(text[:len(text) // 2])
        self.assertIn("status.toml: is damaged: ", message(IO_FAILED))
        path.write_text(text.replace("steps = 4000", "steps = 'many'"))
        self.assertIn("status.toml: is damaged: steps is missing", message(IO_FAILED))
        path.unlink()
        path.mkdir()
        self.assertIn("contains no status.toml of a run", message(BAD_INPUT))

    def test_overwriting_removes_it_and_a_restart_begins_anew(self):
        self.run_deck(DONE, "out", "--set", "time.end=0.2")
        (self.folder / "other").mkdir()
        os.rename(self.folder / "out/status.toml", self.folder / "other/status.toml")
        self.assertIn("status.toml", self.expect(BAD_INPUT, "run", self.deck, "--output", self.folder / "other").stderr)
        self.expect(DONE, "run", self.deck, "--output", self.folder / "out", "--restart",
                    self.folder / "out/checkpoint_end.h5")
        self.assertIn("0.4 of 0.4 s (100 %)", self.status("out"))


if __name__ == "__main__":
    unittest.main()
