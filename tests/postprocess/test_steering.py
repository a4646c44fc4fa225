"""Runs that Python steers in pieces, by the example.

    SCREE=build/release/scree python3 tests/postprocess/test_steering.py

Needs postprocess/requirements.txt."""

import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

PROGRAM = os.environ["SCREE"]
EXAMPLE = ROOT / "postprocess/examples/steer.py"


def example():
    spec = importlib.util.spec_from_file_location("steer", EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class SteeringTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="scree_steering_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_pieces_are_the_run_with_the_whole_table(self):
        steer = example()
        run, deck = steer.steer(self.folder / "pieces", steer.machine(), steer.controller(), 6, quiet=True,
                                scree=PROGRAM)
        self.assertEqual(len(deck["motors.motor.effort.values"]), 7)
        self.assertGreater(np.abs(deck["motors.motor.effort.values"]).max(), 1.0)
        self.assertEqual(len(run.record["starts"]), 6)
        self.assertEqual(run.record["run"]["changes"], [])
        whole = deck.run(self.folder / "whole", quiet=True, scree=PROGRAM)
        self.assertEqual(run.record["run"]["state_hash"], whole.record["run"]["state_hash"])
        np.testing.assert_array_equal(run.history["coordinates/pin/angle"], whole.history["coordinates/pin/angle"])
        self.assertGreater(run.history["coordinates/pin/angle"][-1], 0.2)

    def test_what_has_passed_cannot_be_changed(self):
        steer = example()
        run, deck = steer.steer(self.folder / "run", steer.machine(), steer.controller(), 2, quiet=True, scree=PROGRAM)
        table = deck["motors.motor.effort"]
        table["times"].append(0.06)
        table["values"].append(0.0)
        table["values"][1] += 1.0
        deck["time.end"] = 0.06
        with self.assertRaisesRegex(steer.scree.ScreeError, "belongs to another deck.*motors.motor.effort"):
            deck.run(run.folder, "--restart", run.folder / "checkpoint_end.h5", quiet=True, scree=PROGRAM)

    def test_the_example_itself(self):
        text = EXAMPLE.read_text(encoding="utf-8").replace("PIECE, PIECES = 0.02, 25", "PIECE, PIECES = 0.02, 3")
        copy = self.folder / "steer.py"
        copy.write_text(text, encoding="utf-8")
        said = subprocess.run([sys.executable, copy, self.folder / "out"], check=True, capture_output=True, text=True,
                              env=os.environ | {"PYTHONPATH": str(ROOT / "postprocess"), "SCREE": PROGRAM}).stdout
        self.assertRegex(said, r"^t = 0.06 s: the arm is at \S+ rad, wanted: 0.6 rad; the motor gives \S+ N m\n$")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
