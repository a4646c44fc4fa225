"""Conditions that end a run: exit code, record, status, log, restarts and messages. Usage: as test_cli.py"""

import json
import re
import unittest

from test_cli import BAD_INPUT, DONE, DECK, CommandLineTest

REGION = """[[output.history_regions]]
name = "bottom"
kind = "box"
min = [-0.35, -1.0]
max = [0.35, -0.5]
"""
FALLEN = """[[stop]]
name = "fallen"
column = "regions/bottom/number"
above = 0.5
over = 0.01
"""


class StopTest(CommandLineTest):
    def setUp(self):
        super().setUp()
        self.write("deck.toml", DECK + REGION + FALLEN)

    def record(self, output):
        return json.loads((self.folder / output / "run_record.json").read_text())

    def test_the_reason_is_in_record_status_and_log(self):
        log = self.run_deck(DONE, "out").stdout
        reason = re.search(r'ended by the stop condition ("fallen": regions/bottom/number above 0\.5 for 0\.01 s; '
                           r"\d at t = (\S+) s)\n", log)
        self.assertLess(float(reason[2]), 0.39)
        record = self.record("out")
        self.assertEqual((record["run"]["status"], record["run"]["exit_code"]), ("done", DONE))
        self.assertEqual(record["run"]["stop_condition"], reason[1])
        self.assertAlmostEqual(record["measures"]["simulated_time"], float(reason[2]), 12)
        self.assertEqual(record["counts"]["snapshots"], 2)
        status = self.expect(DONE, "status", self.folder / "out").stdout
        self.assertIn("state          done; process ", status)
        self.assertIn(f"ended by       stop condition {reason[1]}\n", status)
        self.assertIn("checkpoint     checkpoint_end.h5, t = ", status)
        # There was no disc in the region before the last 0.01 s.
        numbers = [row.split(",") for row in self.history("out")]
        column = numbers[0].index("regions/bottom/number [1]")
        self.assertEqual([float(row[column]) > 0.5 for row in numbers[-102:]], [False] + 101 * [True])

    def test_a_run_without_a_condition_that_is_met_says_nothing(self):
        log = self.run_deck(DONE, "out", "--set", "stop.fallen.above=100").stdout
        self.assertNotIn("stop condition", log)
        self.assertEqual(self.record("out")["run"]["stop_condition"], "")
        self.assertNotIn("ended by", self.expect(DONE, "status", self.folder / "out").stdout)

    def test_a_restart_says_that_nothing_is_left_to_do(self):
        self.run_deck(DONE, "out")
        whole = self.record("out")
        end = self.folder / "out/checkpoint_end.h5"
        log = self.expect(DONE, "run", self.deck, "--output", self.folder / "out", "--restart", end).stdout
        self.assertIn('nothing left to do: the run was ended by the stop condition "fallen": ', log)
        again = self.record("out")
        for key in ("stop_condition", "state_hash", "status"):
            self.assertEqual(again["run"][key], whole["run"][key])
        self.assertEqual(again["counts"]["steps"], whole["counts"]["steps"])
        log = self.expect(DONE, "run", self.deck, "--output", self.folder / "out", "--restart", end,
                          "--set", "stop.fallen.above=100").stdout
        self.assertNotIn("stop condition", log)
        self.run_deck(DONE, "free", "--set", "stop=[]")
        self.assertEqual(self.record("out")["run"]["state_hash"], self.record("free")["run"]["state_hash"])

    def test_check_shows_conditions_and_refuses_unknown_columns_as_a_run_does(self):
        self.assertIn('stop           "fallen": regions/bottom/number above 0.5 for 0.01 s\n',
                      self.expect(DONE, "check", self.deck).stdout)
        wrong = ["--set", "stop.fallen.column=region/bottom/number"]
        for words in (["check", self.deck, *wrong],
                      ["run", self.deck, "--output", self.folder / "out", "--overwrite", *wrong]):
            error = self.expect(BAD_INPUT, *words).stderr
            self.assertEqual(error, "error: --set stop.fallen.column=region/bottom/number: the history has no such "
                                    'column; did you mean "regions/bottom/number"?\n')


if __name__ == "__main__":
    unittest.main()
