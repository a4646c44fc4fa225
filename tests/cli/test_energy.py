"""What a run says of its energy: nothing of round-off, the same whatever is recorded, and the truth of what is lost.
Environment: SCREE, the program."""

import json
import shutil
import unittest

from test_cli import DONE, CommandLineTest

CHANGED = "the time integration has changed the energy"
# A ball flies to and fro between two elastic walls.
BOUNCE = """\
gravity = [0.0, 0.0, 0.0]
[space]
dimension = 3
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
x_min = "wall"
x_max = "wall"
[time]
end = 4.0
[[contact.pairs]]
stiffness = 1e5
[[particles]]
kind = "list"
positions = [[0.0, 0.0, 0.0]]
velocity = [3.0, 0.0, 0.0]
radius = 0.1
mass = 1.0
"""
# Beams in a row, held at rest on redundant revolute joints.
REST = """\
gravity = [0.0, -9.81, 0.0]
[space]
dimension = 3
min = [{0:.1f}, -5.0, -5.0]
max = [{1:.1f}, 5.0, 5.0]
[time]
end = 1.0
[integrator]
redundant = "minimum-norm"
[[bodies]]
name = "beam"
kind = "spatial"
count = 4
position = [{2:.1f}, 0.0, 0.0]
spacing = [1.0, 0.0, 0.0]
solids = [{{ kind = "box", size = [1.0, 0.1, 0.1], density = 1000.0 }}]
[[joints]]
name = "root"
type = "fixed"
bodies = ["ground", "beam.0"]
[[joints]]
name = "sleeve"
type = "cylindrical"
chain = "beam"
axis = [0.0, 1.0, 0.0]
[[joints]]
name = "hinge"
type = "revolute"
chain = "beam"
axis = [0.0, 1.0, 0.0]
"""
# An arm that a driver holds against a motor.
HELD = """\
gravity = [0.0, 0.0, {gravity}]
[space]
dimension = 3
min = [-{size}, -{size}, -{size}]
max = [{size}, {size}, {size}]
[time]
end = 0.1
step = 1e-3
control = "fixed"
[[bodies]]
name = "arm"
kind = "spatial"
mass = 1.0
inertia_tensor = [0.01, 0.02, 0.02, 0.0, 0.0, 0.0]
position = [{arm}, 0.0, 0.0]
[[joints]]
name = "hinge"
type = "revolute"
bodies = ["ground", "arm"]
point = [0.0, 0.0, 0.0]
axis = [0.0, 1.0, 0.0]
[[drivers]]
name = "hold"
joint = "hinge"
motion = 0.0
[[motors]]
name = "motor"
joint = "hinge"
type = "effort"
effort = 1.0
"""
# Grains meet each other, and some leave through floor and lid.
FALL = """\
gravity = [0.0, -0.5]
[space]
dimension = 2
min = [0.0, 0.0]
max = [1.0, 1.0]
x_min = "wall"
x_max = "wall"
[time]
end = 1.0
step = {step}
control = "fixed"
[integrator]
particles = "{particles}"
[[contact.pairs]]
stiffness = 1e4
damping = {damping}
[[particles]]
name = "grains"
kind = "random"
count = 80
min = [0.0, 0.0]
max = [1.0, 1.0]
radius = 0.03
mass = 0.1
random_velocity = 2.0
seed = 3
[output]
history_interval = 0.1
"""


class WarningTest(CommandLineTest):
    def run_text(self, text, *settings, output="out", code=DONE, restart=()):
        """Warnings of the energy, and measures."""
        words = [word for setting in settings for word in ("--set", setting)]
        deck = self.write("deck.toml", text)
        overwrite = () if restart else ("--overwrite",)
        self.expect(code, "run", deck, "--output", self.folder / output, *overwrite, *restart, *words)
        record = json.loads((self.folder / output / "run_record.json").read_text())
        return [text for text in record["warnings"] if "accounted for" in text], record["measures"]

    def test_a_ball_that_keeps_its_energy(self):
        exchanged = []
        for interval in (0, 0.1, 1, 4):
            for more in ((), ("time.control=fixed", "time.step=2e-4", "integrator.particles=velocity-verlet")):
                warnings, measures = self.run_text(BOUNCE, f"output.history_interval={interval}", *more)
                self.assertEqual(warnings, [])
                exchanged.append(measures["energy_exchanged"])
        self.assertLess(max(exchanged) - min(exchanged), 1e-3 * 4.5)
        self.assertAlmostEqual(exchanged[0], 4.5, delta=0.0045)

    def test_a_ball_that_loses_its_energy(self):
        for interval in (0, 0.1, 4):
            warnings, measures = self.run_text(BOUNCE, f"output.history_interval={interval}", "time.control=fixed",
                                               "time.step=4e-3", "integrator.hht_alpha=-0.3")
            self.assertGreater(measures["energy_taken_by_integrator"], 0.01 * 4.5)
            self.assertEqual(len(warnings), 1)
            self.assertRegex(warnings[0], CHANGED + ".* % of the 4.5[0-9]* J exchanged .*: shorten time.step, or set")

    def test_bodies_at_rest(self):
        for where in (0, 1e3, 1e6):
            for interval in (0, 0.5):
                text = REST.format(where - 5, where + 5, where + 0.5)
                warnings, _ = self.run_text(text, f"output.history_interval={interval}")
                self.assertEqual(warnings, [])

    def test_a_body_that_is_held(self):
        for gravity, size in ((-9.81, 1.0), (0.0, 1.0), (-9.81, 1e-6), (-9.81, 1e6)):
            with self.subTest(gravity=gravity, size=size):
                self.assertEqual(self.run_text(HELD.format(gravity=gravity, size=size, arm=0.3 * size))[0], [])

    def test_nothing_is_said_of_a_run_that_took_no_step(self):
        text = FALL.format(step=1e-4, particles="velocity-verlet", damping=20)
        failing = ("space.leaving='error'", "particles.0.velocity=[0.0,-9000.0]")
        self.assertEqual(self.run_text(text, *failing, code=3)[0], [])

    # Warned of: steps, and what belongs to them.
    COARSE = (({"particles": "velocity-verlet", "step": 7e-4, "damping": 20}, ()),
              ({"particles": "hht", "step": 4e-3, "damping": 10}, ()))

    def test_particles_that_drift_are_measured_as_those_that_are_removed(self):
        for steps, settings in self.COARSE:
            (drift, a), (remove, b) = (self.run_text(FALL.format(**steps), f"space.leaving='{leaving}'", *settings)
                                       for leaving in ("ballistic", "remove"))
            self.assertEqual(drift, remove)
            self.assertEqual(len(remove), 1)
            for name in ("energy_exchanged", "balance_error", "energy_taken_by_integrator"):
                self.assertAlmostEqual(a[name], b[name], delta=1e-9 * b["energy_exchanged"])

    def test_intervals_of_the_output_do_not_change_what_was_exchanged(self):
        for steps, settings in self.COARSE:
            text = FALL.format(**steps).replace('[space]\n', '[space]\nleaving = "remove"\n')
            found = [self.run_text(text, *settings, f"output.history_interval={interval}")
                     for interval in (0, 0.1, 1)]
            exchanged = [measures["energy_exchanged"] for _, measures in found]
            self.assertLess(max(exchanged) - min(exchanged), 0.01 * min(exchanged))
            self.assertEqual([len(warnings) for warnings, _ in found], [1, 1, 1])

    def test_the_remedy_fits_the_steps(self):
        adaptive = ("time.control='adaptive'", "time.tolerance=1e-2")
        for steps, settings, expected in (
                ({"particles": "velocity-verlet", "step": 7e-4, "damping": 20}, (),
                 r"has changed the energy by .*: shorten time.step: in these steps the energy of impacts is off by "
                 r"up to [0-9.]+ %"),
                ({"particles": "hht", "step": 4e-3, "damping": 10}, (), 'shorten time.step, or set time.control = "a'),
                ({"particles": "hht", "step": 4e-3, "damping": 10}, adaptive, "lower time.tolerance, or bring")):
            with self.subTest(expected):
                warnings, _ = self.run_text(FALL.format(**steps), "space.leaving='remove'", *settings)
                self.assertEqual(len(warnings), 1)
                self.assertRegex(warnings[0], expected)
                self.assertNotIn("substeps", warnings[0])

    def test_the_dissipation_of_coarse_steps_is_accounted_for(self):
        text = FALL.format(particles="velocity-verlet", step=1.4e-4, damping=40)
        warnings, measures = self.run_text(text, "space.leaving='remove'", "contact.pairs.0.friction=1.0",
                                           "contact.pairs.0.tangential_damping_ratio=1.0")
        self.assertEqual(warnings, [])
        self.assertLess(abs(measures["balance_error"]), 5e-3 * measures["energy_exchanged"])

    def test_an_interrupted_run_says_what_a_whole_one_says(self):
        for steps, settings in self.COARSE:
            text, settings = FALL.format(**steps), ("space.leaving='ballistic'", *settings)
            whole = self.run_text(text, *settings, output="whole")
            self.run_text(text, *settings, "time.end=0.4", output="part")
            going_on = ("--restart", self.folder / "part/checkpoint_end.h5")
            for output in ("other", "part"):  # a folder of its own, then the same one
                found = self.run_text(text, *settings, output=output, restart=going_on)
                self.assertEqual(found, whole)
                self.assertEqual(len(found[0]), 1)
            shutil.rmtree(self.folder / "other")


if __name__ == "__main__":
    unittest.main(verbosity=2)
