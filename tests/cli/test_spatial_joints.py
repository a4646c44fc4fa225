"""Coordinates of joints in space as the command line shows them. Usage: as test_cli.py"""

import json
import math
import pathlib
import sys
import unittest

from test_cli import BAD_INPUT, DONE, CommandLineTest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import results  # noqa: E402

ARM = pathlib.Path(__file__).resolve().parents[2] / "input/examples/swing_arm.toml"
REFUSED = (
    (["motors.0.coordinate=displacement"], "has no displacement, but an angle"),
    (["motors.0.coordinate=turn"], "angle"),
    (["joints.2.type=planar", "joint_springs.0.joint=hub"], "is a planar joint; it must be revolute, "),
    (["joints.1.type=cylindrical"], "name one of them"),
    (["joints.1.type=cylindrical", "motors.0.coordinate=angle"], "give a list with one of them"),
    (["couplers.0.coordinates=['angle', 'angle']"], "must have 3 entries, as joints"),
    (["couplers.0.coordinates=['angle', 'angle', 'displacement']"], 'joint "hub" is a revolute joint and has no'),
    (["joints.1.type=screw"], "lead"),
    (["joints.1.type=screw", "joints.1.lead=0.0"], "must not be 0"),
    (["joints.1.lead=0.1"], "screw"),
    (["output.history_coordinates=-1"], "at least 0"),
)


class SpatialJointsTest(CommandLineTest):
    def arm(self, code, output, *words):
        return self.expect(code, "run", ARM, "--output", self.folder / output, *words)

    def record(self, output):
        return json.loads((self.folder / output / "run_record.json").read_text())["run"]

    def rows(self, output):
        return results.rows(self.folder / output)

    def test_what_a_deck_must_not_say(self):
        for overrides, text in REFUSED:
            with self.subTest(overrides=overrides):
                words = [word for override in overrides for word in ("--set", override)]
                self.assertIn(text, self.expect(BAD_INPUT, "check", ARM, *words).stderr)

    def test_the_arm_turns_its_wheel_and_keeps_its_books(self):
        self.arm(DONE, "out")
        rows = self.rows("out")
        last = rows[-1]
        shaft, pivot, hub = (last[f"coordinates/{name}/angle"] for name in ("shaft", "pivot", "hub"))
        self.assertAlmostEqual(shaft - pivot, 3 * hub, delta=1e-9)
        self.assertGreater(hub, 10 * 2 * math.pi)
        self.assertEqual(last["coordinates/shaft/angle_rate"], last["efforts/motor/rate"])
        for before, after in zip(rows, rows[1:]):
            turn = 0.01 * (before["coordinates/hub/angle_rate"] + after["coordinates/hub/angle_rate"]) / 2
            self.assertAlmostEqual(after["coordinates/hub/angle"] - before["coordinates/hub/angle"], turn, delta=5e-3)
        self.assertEqual(max(row["efforts/motor/effort"] for row in rows), 25)
        self.assertLess(min(row["efforts/stop/effort"] for row in rows), -1)
        self.assertLess(max(abs(row["energy/balance_error"]) for row in rows), 1e-3 * last["energy/driver_work"])

    def test_a_restart_counts_on(self):
        self.arm(DONE, "whole", "--set", "time.end=1.5")
        self.arm(DONE, "part", "--set", "time.end=1.0")
        self.arm(DONE, "part", "--set", "time.end=1.5", "--restart", self.folder / "part/checkpoint_end.h5")
        self.assertEqual(self.record("part")["state_hash"], self.record("whole")["state_hash"])
        self.assertEqual(self.rows("part")[-1], self.rows("whole")[-1])


if __name__ == "__main__":
    unittest.main()
