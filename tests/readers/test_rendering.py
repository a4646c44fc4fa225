"""What VTK draws: shadows, and what one looks through.

    python3 tests/readers/test_rendering.py DRUM_LIFTERS EXCAVATOR SCREW_LIFT

takes the folders of their results. Needs postprocess/requirements.txt, and an OpenGL library."""

import pathlib
import sys
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

import scree
from scree.pictures.framing import picture_axes
from scree.pictures.render import DrawnRun
from scree.pictures.spheres import SphereRenderer

DRUM, EXCAVATOR, SCREW = (pathlib.Path(path).resolve() for path in sys.argv[1:4])


class RenderingTest(unittest.TestCase):
    def test_a_sphere_throws_its_shadow_on_the_ground(self):
        up = np.array([0.0, 0.0, 1.0])
        renderer = SphereRenderer((200, 200), np.zeros(3), picture_axes(up), 2.0, 2.0)
        renderer.add_ground(up, -0.5)
        image = renderer.image(np.zeros((1, 3)), np.full(1, 0.5), np.array([[1.0, 1.0, 1.0]]))
        light = image.min(axis=2)
        below, sides = light[125:140, 90:130].min(), np.concatenate([light[:10], light[-10:]])
        self.assertTrue(100 < below < 225, below)
        self.assertEqual(sides.min(), 255)

    def test_spheres_are_of_true_size(self):
        """Also where one is in front of the other: each pixel sees the nearest."""
        renderer = SphereRenderer((300, 300), np.zeros(3), np.eye(3), 1.5, 2.0)
        red, blue = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
        centers = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.9], [1.0, 1.0, 0.0]])
        image = renderer.image(centers, np.array([1.0, 0.5, 0.25]), np.array([red, blue, red])).astype(int)
        is_blue, is_red = image[..., 2] > image[..., 0] + 20, image[..., 0] > image[..., 2] + 20
        np.testing.assert_allclose(is_blue.sum() / 100**2, np.pi * 0.5**2, rtol=0.03)
        np.testing.assert_allclose(is_red.sum() / 100**2, np.pi * (1.0 - 0.5**2 + 0.25**2), rtol=0.03)

    def test_one_looks_through_what_may_hold_particles(self):
        expected = {DRUM: ({True}, set()), EXCAVATOR: ({False}, set()), SCREW: ({False}, {False, True})}
        for results, sides in expected.items():
            glass = DrawnRun(scree.open(results)).surfaces.glass
            self.assertEqual((set(glass["bodies"]), set(glass["walls"])), sides)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
