"""Motors, springs and limits on joints, and couplers, as the command line shows them. Usage: as test_cli.py"""

import json
import pathlib
import sys
import unittest

from test_cli import BAD_INPUT, DONE, CommandLineTest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import results  # noqa: E402

PRESS = pathlib.Path(__file__).resolve().parents[2] / "input/examples/press.toml"
REFUSED = (
    (["motors.0.joint=knees"], "there is no joint named"),
    (["motors.0.limit=0"], "above 0"),
    (["motors.0.stall_effort=1"], "speed"),
    (["couplers.0.radii=[0.1, 0]"], "must be above 0"),
    (['couplers.0.joints=["axle", "axle"]'], "is repeated"),
    (['couplers.0.joints=["axle", "guide"]'], 'joint "guide" must be revolute here'),
    (['couplers.0.joints=["axle", "shaft", "knee"]'], "must have 2 entries for this type"),
    (["joint_limits.0.upper=-0.2", "joint_limits.0.lower=0.2"], "must be above lower = 0.2"),
    (["joint_limits.0.exponent=0.5"], "at least 1"),
    (["joint_springs.0.rates=[0.0, 1.0]", "joint_springs.0.damping_efforts=[0.0]"], "must have 2 entries, as rates"),
    (["joint_springs.0.coordinates=[0.0, 0.0]", "joint_springs.0.elastic_efforts=[0.0, 1.0]"],
     "must increase; entry 1 is 0 after 0"),
    (["joint_springs.0.interpolation=clamped", "joint_springs.0.rates=[0.0, 1.0]",
      "joint_springs.0.damping_efforts=[0.0, 1.0]"], "linear, natural, monotone"),
    (["joint_springs.0.name=motor"], "motor"),
    (["couplers.0.name=knee"], "knee"),
)


class JointForcesTest(CommandLineTest):
    def press(self, code, output, *words):
        return self.expect(code, "run", PRESS, "--output", self.folder / output, *words)

    def record(self, output):
        return json.loads((self.folder / output / "run_record.json").read_text())["run"]

    def test_what_a_deck_must_not_say(self):
        for overrides, text in REFUSED:
            with self.subTest(overrides=overrides):
                words = [word for override in overrides for word in ("--set", override)]
                message = self.expect(BAD_INPUT, "check", PRESS, *words).stderr
                self.assertTrue(any(f"--set {override}: " in message for override in overrides), message)
                self.assertIn(text, message)

    def test_check_counts_them(self):
        text = self.expect(DONE, "check", PRESS).stdout
        self.assertIn("5 joints, 0 drivers, 3 force elements", text)
        self.assertIn("12 coordinates, 11 constraints: 1 degree of freedom", text)

    def test_the_press_keeps_its_speed_and_its_books(self):
        self.press(DONE, "out")
        rows = results.rows(self.folder / "out")
        self.assertLessEqual(max(abs(row["efforts/motor/effort"]) for row in rows), 1)
        late = [row["efforts/motor/rate"] for row in rows[len(rows) // 2:]]
        self.assertAlmostEqual(sum(late) / len(late), -30, delta=2)
        buffer = [row["efforts/buffer/effort"] for row in rows]
        self.assertLess(min(buffer), -10)
        self.assertLessEqual(max(buffer), 0)
        self.assertLess(max(abs(row["energy/balance_error"]) for row in rows), 2e-3 * rows[-1]["energy/driver_work"])

    def test_a_restart_goes_on_bit_for_bit(self):
        self.press(DONE, "whole", "--set", "time.end=1.2")
        self.press(DONE, "part", "--set", "time.end=0.7")
        self.press(DONE, "part", "--set", "time.end=1.2", "--restart", self.folder / "part/checkpoint_end.h5")
        self.assertEqual(self.record("part")["state_hash"], self.record("whole")["state_hash"])

    def test_a_motors_function_may_change_after_the_restart(self):
        """As of a driver: what the motor did until then is the same."""
        later = "motors.0.rate={ kind = 'table', times = [0.0, 0.8, 1.0, 3.0], values = [-30.0, -30.0, %s, -20.0] }"
        self.press(DONE, "part", "--set", "time.end=0.7", "--set", later % -30.0)
        restart = ("--set", "time.end=1.2", "--restart", self.folder / "part/checkpoint_end.h5")
        self.press(DONE, "other", *restart, "--set", later % -10.0)
        self.assertIn("motors.motor", self.press(BAD_INPUT, "other2", *restart).stderr)

    def test_a_restart_may_change_a_stop_but_not_the_motors(self):
        self.press(DONE, "part", "--set", "time.end=0.7")
        restart = ("--restart", self.folder / "part/checkpoint_end.h5", "--allow-changes")
        self.press(DONE, "other", *restart, "--set", "time.end=0.8", "--set", "joint_limits.0.stiffness=1e4")
        self.press(BAD_INPUT, "other2", *restart, "--set", "motors.0.type=effort", "--set", "motors.0.effort=1.0")


SERVO = """
gravity = [0.0, 0.0]
[space]
dimension = 2
min = [-1.0, -1.0]
max = [1.0, 1.0]
[time]
end = 0.5
step = 1e-2
control = "fixed"
[[bodies]]
name = "arm"
position = [0.0, 0.0]
mass = 1.0
inertia = 0.8
[[joints]]
name = "hinge"
type = "revolute"
bodies = ["ground", "arm"]
point = [0.0, 0.0]
[[motors]]
name = "servo"
joint = "hinge"
type = "position"
position = 0.3
position_gain = 1e7
rate_gain = 1e5
"""


class ServoTest(CommandLineTest):
    def test_a_servo_that_its_first_step_throws_off(self):
        """Its period of 1.8 ms is not resolved by steps of 10 ms: they take it 0.38 rad off, 0.3 rad being the way."""
        deck = self.write("servo.toml", SERVO)
        warned = "servo 'servo' starts 0.3 rad off its position"
        self.assertIn(warned, self.expect(DONE, "check", deck).stderr)
        out = self.folder / "out"
        run = self.expect(DONE, "run", deck, "--output", out, "--set", "time.end=0.01")
        self.assertIn("joint 'hinge' may overshoot by 0.375 rad", run.stderr)
        self.assertAlmostEqual(0.3 - results.columns(out)["efforts/servo/coordinate"][-1], 0.375, delta=0.05)
        for remedy in ("motors.servo.limit=50.0", "motors.servo.position=0.0", "time.control=adaptive",
                       "time.step=1e-3", "motors.servo.position_gain=1e4"):
            words = ["--set", remedy, *(("--set", "motors.servo.rate_gain=100.0") if "1e4" in remedy else ())]
            self.assertNotIn("servo 'servo' starts", self.expect(DONE, "check", deck, *words).stderr)


if __name__ == "__main__":
    unittest.main()
