"""Bushings and dry friction of joints, as the command line shows them. Usage: as test_cli.py"""

import json
import pathlib
import sys
import unittest

from test_cli import BAD_INPUT, DONE, CommandLineTest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import results  # noqa: E402

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "input/examples"
BELT, ENGINE = EXAMPLES / "stick_slip.toml", EXAMPLES / "engine_mount.toml"
REFUSED = (
    (BELT, ["joint_frictions.0.joint=spring"], "there is no joint named"),
    (BELT, ["joint_frictions.0.friction_coefficient=-0.1"], "at least 0"),
    (BELT, ["joint_frictions.0.stiffness=0"], "above 0"),
    (BELT, ["joint_frictions.0.radius=0.1"], 'joint "contact" slides'),
    (BELT, ["joint_frictions.0.static_ratio=1"], "belong together"),
    (ENGINE, ["bushings.0.stiffness=[1, 2]"], "must have 6 entries"),
    (ENGINE, ["bushings.1.damping=[1, 1, 1, -1, 1, 1]"], "below 0"),
    (ENGINE, ["bushings.0.axis=[1, 1, 0]"], "must be perpendicular to axis"),
    (ENGINE, ["bushings.0.name=rear"], "rear"),
)


class BushingsTest(CommandLineTest):
    def run_deck(self, deck, output, *words):
        self.expect(DONE, "run", deck, "--output", self.folder / output, *words)
        return json.loads((self.folder / output / "run_record.json").read_text())["run"]

    def rows(self, output):
        return results.rows(self.folder / output)

    def test_what_a_deck_must_not_say(self):
        for deck, overrides, text in REFUSED:
            with self.subTest(overrides=overrides):
                words = [word for override in overrides for word in ("--set", override)]
                message = self.expect(BAD_INPUT, "check", deck, *words).stderr
                self.assertIn(text, message)

    def test_a_restart_in_the_middle_of_sticking_goes_on_bit_for_bit(self):
        whole = self.run_deck(BELT, "whole", "--set", "time.end=1.5")
        self.run_deck(BELT, "part", "--set", "time.end=0.8")
        last = self.rows("part")[-1]
        self.assertLess(abs(last["efforts/friction/rate"]), 1e-3)
        self.assertGreater(last["efforts/friction/effort"], 3)
        part = self.run_deck(BELT, "part", "--set", "time.end=1.5",
                             "--restart", self.folder / "part/checkpoint_end.h5")
        self.assertEqual(part["state_hash"], whole["state_hash"])

    def test_a_restart_may_change_friction_but_not_how_much_of_it_there_is(self):
        self.run_deck(BELT, "part", "--set", "time.end=0.2")
        restart = ("--set", "time.end=0.3", "--restart", self.folder / "part/checkpoint_end.h5", "--allow-changes")
        self.run_deck(BELT, "other", *restart, "--set", "joint_frictions.0.friction_coefficient=0.5")
        deck = self.folder / "free.toml"
        text = BELT.read_text()
        deck.write_text(text[:text.index("[[joint_frictions]]")] + text[text.index("[[spring_dampers]]"):])
        message = self.expect(BAD_INPUT, "run", deck, "--output", self.folder / "other2", *restart).stderr
        self.assertIn("joint_frictions", message)

    def test_the_block_sticks_and_slips(self):
        self.run_deck(BELT, "out")
        rows = self.rows("out")
        efforts = [row["efforts/friction/effort"] for row in rows]
        slips = [row["efforts/friction/effort"] for row in rows if abs(row["efforts/friction/rate"]) > 0.1]
        self.assertAlmostEqual(min(slips), 0.4 * 9.81, places=3)
        self.assertAlmostEqual(max(slips), 0.4 * (9.81 + 5), places=3)
        self.assertLess(max(efforts), 1.5 * 0.4 * (9.81 + 5) + 1e-3)
        self.assertGreater(max(efforts), 1.45 * 0.4 * (9.81 + 5))
        self.assertLess(max(abs(row["energy/balance_error"]) for row in rows), 1e-6)

    def test_bushings_are_recorded_and_restarted(self):
        """Their forces and the unbalance make the engine's accelerations; the mean of them carries the weight."""
        self.run_deck(ENGINE, "whole")
        rows = self.rows("whole")
        self.assertEqual(rows[0]["bushings/rear/fz"], 600)
        self.assertEqual(rows[0]["bushings/left/fz"], 300)
        late = [row for row in rows if row["step/time"] >= 1]
        up = [row["bushings/rear/fz"] + 0.5 ** 0.5 * sum(row[f"bushings/{name}/fz"] + sign * row[f"bushings/{name}/fy"]
                                                         for name, sign in (("left", -1), ("right", 1)))
              for row in late]
        self.assertAlmostEqual(sum(up) / len(up), 120 * 9.81, delta=25)
        self.assertLess(max(abs(row["bushings/rear/turn_x"]) for row in rows), 0.02)
        self.run_deck(ENGINE, "part", "--set", "time.end=0.9")
        part = self.run_deck(ENGINE, "part", "--restart", self.folder / "part/checkpoint_end.h5")
        whole = json.loads((self.folder / "whole/run_record.json").read_text())["run"]
        self.assertEqual(part["state_hash"], whole["state_hash"])
        self.run_deck(ENGINE, "few", "--set", "output.history_bushings=1")
        self.assertNotIn("bushings/right/fz", self.rows("few")[0])


if __name__ == "__main__":
    unittest.main()
