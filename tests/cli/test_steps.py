"""What check and run say of the deck's steps. Usage: SCREE=path/to/scree python3 test_steps.py"""

import re
import unittest

from test_cli import DONE, CommandLineTest


class StepsTest(CommandLineTest):
    def test_check_and_run_say_what_the_step_makes_of_impacts(self):
        damped = ("--set", "contact.pairs.0.damping=90.0", "--set", "time.end=0.02")
        fine = self.expect(DONE, "check", self.deck, *damped)
        self.assertRegex(fine.stdout, r"rebounds with 0\.5\d+ of the speed, in steps of 0\.0001 s with 0\.5\d+, "
                         r"0\.\d+ % off; steps up to 0\.000\d+ s keep within 1 %\n")
        self.assertNotIn("misjudge", fine.stderr)
        coarse = (*damped, "--set", "time.step=1e-2")
        warning = (r"warning: time\.step: steps of 0\.01 s misjudge rebounds of \"default\" on \"default\" by \d+ %: "
                   r"0\.\d+ of the speed instead of 0\.5\d+ of the speed; steps up to 0\.000\d+ s keep within 1 %, "
                   r"time\.control = \"adaptive\" within 0\.01 %\n")
        self.assertRegex(self.expect(DONE, "check", self.deck, *coarse).stderr, warning)
        log = self.run_deck(DONE, "out", *coarse)
        self.assertEqual(len(re.findall(warning, log.stdout + log.stderr)), 1)
        self.assertIn("misjudge rebounds", (self.folder / "out/run_record.json").read_text())
        adaptive = self.expect(DONE, "check", self.deck, *damped, "--set", "time.control=adaptive").stdout
        self.assertIn("in steps that adapt, to about ", adaptive)


if __name__ == "__main__":
    unittest.main(verbosity=2)
