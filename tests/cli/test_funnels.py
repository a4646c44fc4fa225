"""Grains run out of a funnel and a hopper, made from a few numbers, and none goes through their sides.
Usage: SCREE=path/to/scree python3 test_funnels.py"""

import pathlib
import sys
import unittest

import numpy as np
from test_cli import BAD_INPUT, DONE, CommandLineTest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import results  # noqa: E402

OUTLET, TOP, LENGTH, TUBE, HEIGHT, RADIUS = 0.03, 0.1, 0.08, 0.03, 0.15, 0.005  # widths, and of the grains [m]
DECK = """gravity = [0.0, 0.0, -9.81]

[space]
dimension = 3
min = [-0.1, -0.1, 0.0]
max = [0.1, 0.1, 0.4]
x_min = "wall"
x_max = "wall"
y_min = "wall"
y_max = "wall"
z_min = "wall"

[time]
end = 0.5
step = 5e-5
control = "fixed"

[integrator]
particles = "velocity-verlet"

[[contact.pairs]]
stiffness = 2e3
restitution = 0.4
friction = 0.2

[output]
snapshot_interval = 0.02
history_interval = 0.1

[[meshes]]
name = "hopper"
offset = [0.0, 0.0, {height}]
length = {length}
outlet_length = {tube}
{shape}

[[walls]]
name = "hopper"
mesh = "hopper"

[[particles]]
name = "grains"
kind = "lattice"
center = [0.0, 0.0, 0.26]
spacing = [0.0105, 0.0105, 0.0105]
size = [5, 5, 8]
radius = {radius}
density = 2500.0
random_velocity = 0.05
"""
ROUND = f'kind = "funnel"\nradius = {OUTLET}\ntop_radius = {TOP}\nsegments = 48'
SQUARE = f'kind = "hopper"\nsize = [{2 * OUTLET}, {2 * OUTLET}]\ntop_size = [{2 * TOP}, {2 * TOP}]'


class FunnelTest(CommandLineTest):
    def use(self, shape):
        self.deck = self.write("deck.toml", DECK.format(height=HEIGHT, length=LENGTH, tube=TUBE, radius=RADIUS,
                                                        shape=shape))

    def check_that_grains_run_out(self, distance):
        """distance: of places [rows][3] from the axis, on which the sides are all as far."""
        self.run_deck(DONE, "out")
        for _, grains in results.snapshots(self.folder / "out"):
            place = grains["position"]
            z = place[:, 2] - HEIGHT
            inside = np.interp(z, [-TUBE, 0, LENGTH], [OUTLET, OUTLET, TOP])
            held = (z > -TUBE) & (z < LENGTH)
            self.assertTrue(np.all(distance(place)[held] < inside[held]))
        self.assertEqual(len(place), 200)
        self.assertGreater(np.mean(z < -TUBE), 0.95)

    def test_a_funnel(self):
        self.use(ROUND)
        self.assertIn("an open surface", self.expect(DONE, "check", self.deck).stdout)
        self.check_that_grains_run_out(lambda place: np.hypot(place[:, 0], place[:, 1]))

    def test_a_hopper(self):
        self.use(SQUARE)
        self.check_that_grains_run_out(lambda place: np.max(np.abs(place[:, :2]), axis=1))

    def test_what_is_refused(self):
        for shape, message in ((ROUND.replace(f"top_radius = {TOP}", ""),
                                'meshes.hopper.top_radius: missing; with kind = "funnel" it must be'),
                               (ROUND.replace(f"top_radius = {TOP}", "top_radius = 0.0"),
                                'meshes.hopper.kind = "funnel": top_radius = 0: must be positive'),
                               (SQUARE + "\nsegments = 8",
                                'meshes.hopper.segments = 8: not used with kind = "hopper"'),
                               (SQUARE.replace('"hopper"', '"silo"'), 'did you mean "hopper"?')):
            self.use(shape)
            self.assertIn(message, self.expect(BAD_INPUT, "check", self.deck).stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
