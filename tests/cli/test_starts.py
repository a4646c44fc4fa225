"""What the run record says of the starts of a run: those before a restart are counted, wherever they ran.
Usage: as test_cli.py"""

import json
import signal
import unittest

from test_cli import DONE, EXPLICIT, LIMIT, CommandLineTest


class StartsTest(CommandLineTest):
    OFTEN = ("--set", "output.checkpoint_interval=0.1", "--set", "output.history_interval=0.1")

    def assert_starts_add_up(self, output, number):
        """The record: each start goes on where the last one ended, with its steps and seconds."""
        record = json.loads((self.folder / output / "run_record.json").read_text())
        starts, total = record["starts"], record["total"]
        self.assertEqual((len(starts), total["starts"]), (number, number))
        self.assertEqual([start["from"] for start in starts], [0, *(start["to"] for start in starts[:-1])])
        self.assertEqual(starts[-1]["to"], record["measures"]["simulated_time"])
        self.assertEqual(total["steps"], record["counts"]["steps"])
        self.assertEqual(sum(start["steps"] for start in starts), total["steps"])
        for name in ("wall_seconds", "loop_seconds", "cpu_seconds"):
            self.assertAlmostEqual(sum(start[name] for start in starts), total[name], places=9)
            self.assertEqual(starts[-1][name], record["cost"][name])
        for start in starts:
            self.assertTrue(start["wall_seconds"] >= start["loop_seconds"] > 0 or start["steps"] == 0)
            self.assertEqual((start["ranks"], start["backend"]), (1, record["run"]["backend"]))
        return record

    def go_on(self, output, checkpoint, *words):
        """From a checkpoint, into any folder, its own too."""
        return self.expect(DONE, "run", self.deck, "--output", self.folder / output, "--restart",
                           self.folder / checkpoint, *words)

    def test_starts_are_counted_in_any_folder(self):
        for words in ((), EXPLICIT):
            words = (*words, *self.OFTEN)
            folders = [f"{name} {len(words)}" for name in ("one", "two", "three")]
            one, two, three = folders
            self.run_deck(DONE, one, *words, "--set", "time.end=0.2")
            self.assert_starts_add_up(one, 1)
            self.go_on(two, f"{one}/checkpoint_end.h5", *words, "--set", "time.end=0.3")
            first = self.assert_starts_add_up(two, 2)["starts"][0]
            text = self.go_on(three, f"{two}/checkpoint_end.h5", *words, "--set", "time.end=0.4").stdout
            self.assertRegex(text, r"s CPU; all 3 starts of the run [0-9.]+ s wall, [0-9.]+ s CPU; results in ")
            self.assertEqual(self.assert_starts_add_up(three, 3)["starts"][0], first)
            self.go_on(two, f"{two}/checkpoint_end.h5", *words, "--set", "time.end=0.4")
            before = self.assert_starts_add_up(two, 3)["starts"]
            # Back to 0.3 s, just before the second start ended: what was taken after that is taken anew.
            self.go_on(two, f"{two}/checkpoint.h5.earlier", *words, "--set", "time.end=0.4")
            now = self.assert_starts_add_up(two, 3)["starts"]
            self.assertEqual(now[0], before[0])
            for name in ("from", "to", "steps"):
                self.assertEqual(now[1][name], before[1][name])
            self.assertLessEqual(now[1]["cpu_seconds"], before[1]["cpu_seconds"])

    def test_of_a_killed_run_what_its_last_checkpoint_knew(self):
        longer = ("--set", "time.step=4e-6", "--set", "output.history_interval=0.001")
        run = self.start("out", *longer, "--set", "output.checkpoint_interval=0.002")
        run.kill()
        self.assertEqual(run.wait(LIMIT), -signal.SIGKILL)
        self.go_on("out", "out/checkpoint.h5", *longer, "--set", "time.end=0.05")
        record = self.assert_starts_add_up("out", 2)
        killed = record["starts"][0]
        self.assertAlmostEqual(killed["to"] / 0.002, round(killed["to"] / 0.002), places=6)
        self.assertAlmostEqual(killed["steps"], killed["to"] / 4e-6, places=3)
        self.assertTrue(0 < killed["to"] < record["measures"]["simulated_time"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
