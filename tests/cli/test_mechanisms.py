"""What the program says of joints and drivers: contradictions, redundancy, energy. Usage: as test_cli.py"""

import json
import unittest

from test_cli import DONE, CommandLineTest

# Turned once in a second.
CRANK = """\
gravity = [0.0, 0.0, 0.0]

[space]
dimension = 3
min = [-3.0, -3.0, -3.0]
max = [3.0, 3.0, 3.0]
leaving = "drift"

[time]
end = 1.0

[output]
history_interval = 1e-2

[[bodies]]
name = "crank"
kind = "spatial"
position = [0.25, 0.0, 0.0]
mass = 2.0
inertia_tensor = [0.01, 0.05, 0.05, 0.0, 0.0, 0.0]
velocity = [0.0, 1.5707963267948966, 0.0]
body_angular_velocity = [0.0, 0.0, 6.283185307179586]

[[joints]]
name = "hinge"
type = "revolute"
bodies = ["ground", "crank"]
point = [0.0, 0.0, 0.0]
axis = [0.0, 0.0, 1.0]
"""
DRIVER = """
[[drivers]]
name = "drive"
joint = "hinge"
motion = { kind = "ramp", rate = 6.283185307179586 }
"""


class EnergyTest(CommandLineTest):
    def warnings(self, deck, *settings):
        words = [word for setting in settings for word in ("--set", setting)]
        result = self.expect(DONE, "run", self.write("crank.toml", deck), "--output", self.folder / "out",
                             "--overwrite", *words)
        record = json.loads((self.folder / "out/run_record.json").read_text())
        self.assertRegex(result.stdout, r"J exchanged, [-+.0-9e]+ J taken out by the time integration; ")
        return record["warnings"], record["measures"]

    def test_a_crank_at_constant_speed_exchanges_next_to_nothing(self):
        for steps in ((), ("time.control=fixed", "time.step=5e-3")):
            warnings, measures = self.warnings(CRANK + DRIVER, *steps)
            self.assertGreater(abs(measures["energy_taken_by_integrator"]), 0.01 * measures["energy_exchanged"])
            self.assertEqual(warnings, [])

    def test_steps_that_are_too_long_for_it(self):
        warnings, _ = self.warnings(CRANK, "time.control=fixed", "time.step=0.05", "output.history_interval=0.05",
                                    "time.end=5", "integrator.hht_alpha=-0.3")
        self.assertIn("the time integration has changed the energy by ", warnings[0])


if __name__ == "__main__":
    unittest.main()
