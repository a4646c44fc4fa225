"""Frames, solids and markers as the command line shows them. Usage: as test_cli.py"""

import json
import math
import pathlib
import sys
import unittest

from test_cli import BAD_INPUT, DONE, CommandLineTest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import results  # noqa: E402

BOOM = pathlib.Path(__file__).resolve().parents[2] / "input/examples/boom.toml"
REFUSED = (
    ("bodies.boom.solids.0.size=[2.0, 0.0, 0.1]", "a list of 3 numbers above 0 [m]"),
    ("bodies.boom.solids.1.kind=cone", '"sphere", "box", "cylinder", "capsule"'),
    ("bodies.boom.mass=3.0", "follows from solids; leave it out"),
    ("bodies.tube.x_axis=[1.0, 0.0, 0.0]", "must be perpendicular to z_axis; the cosine between them is 0.707"),
    ("bodies.tube.quaternion=[1.0, 0.0, 0.0]", "a list of 4 numbers"),
    ("bodies.tube.x_axis=[0.0, 0.0, 0.0]", "must not be 0"),
    ("markers.eye.body=bom", 'did you mean "boom"'),
    ('joints.ball.markers=["stem", "ey"]', 'there is no marker named "ey"'),
    ('joints.ball.markers=["stem", "bore"]', "do not meet"),
    ('joints.ball.markers=["stem"]', "a list of 2 texts"),
    ("joints.hinge.axis=[1.0, 0.0, 0.0]", "not used together with markers"),
    ('spring_dampers.oil.local_points=[[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]', "not used together with markers"),
)


class FramesTest(CommandLineTest):
    def run_boom(self, output, *words):
        settings = [word for setting in ("time.end=1.0", *words) for word in ("--set", setting)]
        self.expect(DONE, "run", BOOM, "--output", self.folder / output, *settings)
        return results.rows(self.folder / output)

    def test_what_a_deck_must_not_say(self):
        for setting, text in REFUSED:
            with self.subTest(setting=setting):
                message = self.expect(BAD_INPUT, "check", BOOM, "--set", setting).stderr
                self.assertIn(f"--set {setting}: ", message)
                self.assertIn(text, message)

    def test_a_message_names_file_line_and_key(self):
        deck = BOOM.read_text().replace('name = "hinge"\nbody = "boom"\nz_axis = [0.0, 1.0, 0.0]',
                                        'name = "hinge"\nbody = "boom"\nz_axis = [0.0, -1.0, 0.0]')
        line = deck[: deck.index('markers = ["tower"')].count("\n") + 1
        message = self.expect(BAD_INPUT, "check", self.write("deck.toml", deck)).stderr
        self.assertIn(f'deck.toml:{line}:11: joints.hinge.markers = ["tower", "hinge"]: the z axes of the two markers '
                      "must point in the same direction at t = 0; they are off by 180 degrees", message)

    def test_the_frames_origin_stays_in_the_hinge(self):
        rows = self.run_boom("out")
        self.assertGreater(rows[-1]["bodies/boom/z"], 0.02)
        for row in rows:
            for axis in "xyz":
                self.assertAlmostEqual(row[f"bodies/boom/origin_{axis}"], 0, delta=1e-10)
                self.assertAlmostEqual(row[f"bodies/boom/origin_v{axis}"], 0, delta=1e-6)  # positions meet, not rates

    def test_reactions_along_the_marker_are_those_along_the_space(self):
        """The stem's axis z is that of the rod, which the orientation of the rod says."""
        row = self.run_boom("out")[-1]
        w, x, y, z = (row[f"bodies/rod/e{k}"] for k in range(4))
        axis = (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y))
        along = sum(a * row[f"reactions/ball/f{k}"] for a, k in zip(axis, "xyz"))
        self.assertAlmostEqual(row["reactions/ball/marker_fz"], along, delta=1e-9)
        size = [math.hypot(*(row[f"reactions/ball/{of}f{k}"] for k in "xyz")) for of in ("", "marker_")]
        self.assertAlmostEqual(*size, delta=1e-9)

    def test_a_restart_goes_on_bit_for_bit(self):
        def state(output):
            return json.loads((self.folder / output / "run_record.json").read_text())["run"]["state_hash"]

        self.run_boom("whole")
        self.run_boom("part", "time.end=0.5")
        self.expect(DONE, "run", BOOM, "--output", self.folder / "part", "--set", "time.end=1.0",
                    "--restart", self.folder / "part/checkpoint_end.h5")
        self.assertEqual(state("part"), state("whole"))


if __name__ == "__main__":
    unittest.main()
