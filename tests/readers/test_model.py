"""What pictures make of decks, and of where bodies are, without a run.

    python3 tests/readers/test_model.py

needs postprocess/requirements.txt."""

import pathlib
import sys
import unittest
from types import SimpleNamespace

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "postprocess"))

from scree.pictures.framing import picture_axes, plane_bounds
from scree.pictures.mechanism import SHORT, Mechanism, barrels, shortest_tree, zigzags
from scree.pictures.model import GROUND, Model
from scree.pictures.surfaces import sharp_edges
from scree.pictures.walls import cut, rectangle, section, solids


class Centers:
    """Of mass, of all bodies in one snapshot, as a Series tells of them; origin: theirs where it is left out."""

    def __init__(self, position, **fields):
        count = len(position)
        self._fields = {"origin": position, "kind": [1] * count, "body": range(count), "position": position} | fields

    def __len__(self):
        return 1

    def has(self, name):
        return name in self._fields

    def rows(self, snapshot, name):
        return np.array(self._fields[name])


def area(polygon):
    """Of a plane polygon in space."""
    spokes = polygon[1:] - polygon[0]
    return np.linalg.norm(np.cross(spokes[:-1], spokes[1:]).sum(axis=0)) / 2


def deck(**changes):
    empty = {side: "open" for side in ("x_min", "x_max", "y_min", "y_max", "z_min", "z_max")}
    space = {"dimension": 2, "min": [-1.0, -1.0], "max": [1.0, 2.0], **empty}
    return {"title": "", "gravity": [0.0, -9.8], "space": space, **changes}


class ModelTest(unittest.TestCase):
    def test_gravity_points_down(self):
        for up in np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0], [0.6, 0, -0.8]], dtype=float):
            axes = picture_axes(up)
            np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
            self.assertAlmostEqual(np.linalg.det(axes), 1)
            self.assertAlmostEqual(axes[0] @ up, 0)
            self.assertGreater(axes[1] @ up, 0.5)
            self.assertGreater(axes[2] @ up, 0.2)  # from above
        space = {**deck()["space"], "dimension": 3, "min": [0, 0, 0], "max": [1, 1, 1]}
        np.testing.assert_array_equal(Model(deck(gravity=[9.8, 0, 0], space=space)).up, [-1, 0, 0])
        np.testing.assert_array_equal(Model(deck(gravity=[0, 0, 0], space=space)).up, [0, 0, 1])

    def test_edges_turn(self):
        points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1]], dtype=float)
        triangles = np.array([[0, 1, 2], [2, 1, 3], [1, 0, 4]])  # a square in two, and one that stands on its side
        self.assertEqual({tuple(map(int, edge)) for edge in sharp_edges(points, triangles)},
                         {(0, 1), (0, 2), (1, 3), (2, 3), (0, 4), (1, 4)})

    def test_a_spring_swings_unless_it_is_short(self):
        ends = np.array([[[0, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, SHORT * 0.05, 0]]], dtype=float)
        long, short = zigzags(ends, 0.05)
        self.assertAlmostEqual(np.abs(long[:, 0]).max(), 0.05)
        self.assertAlmostEqual(np.abs(short[:, 0]).max(), 0)
        np.testing.assert_array_equal(long[[0, -1]], ends[0])

    def test_springs_with_actuators_are_cylinders(self):
        bodies = [{"name": "rod", "kind": "planar", "position": [2.0, 0.0], "angle": 0.0, "spacing": [0.0, 0.0]}]
        step = {"kind": "step", "value": 0.0, "end_value": 9.0, "start": 0.0, "end": 1.0}
        springs = [{"bodies": ["ground", "rod"], "points": [[0.0, y], [2.0, y]], "actuator": actuator}
                   for y, actuator in ((0.0, 0.0), (1.0, step), (2.0, {"kind": "constant", "value": 0.0}))]
        model = Model(deck(bodies=bodies, spring_dampers=springs))
        bodies = Centers(position=[[4, 0, 0]], angle=[0])
        lines, _ = Mechanism(model, lambda snapshot: model.motion(bodies, snapshot), 0.01).draw(0)
        self.assertEqual(len(lines["spring"]), 2)
        np.testing.assert_allclose(lines["rod"], [[[0, 1, 0], [4, 1, 0]]])
        np.testing.assert_allclose(lines["barrel"], [[[0, 1, 0], [1.2, 1, 0]]])  # 0.6 of what it was long
        np.testing.assert_allclose(barrels(lines["rod"] / 4, np.array([2.0])), [[[0, 0.25, 0], [0.9, 0.25, 0]]])

    def test_bars_are_the_shortest(self):
        points = np.array([[0, 0, 0], [3, 0, 0], [1, 0, 0], [2, 0, 0]], dtype=float)
        self.assertEqual({frozenset(map(int, pair)) for pair in shortest_tree(points)},
                         {frozenset(pair) for pair in ((0, 2), (2, 3), (3, 1))})

    def test_a_body_is_where_its_centre_is_in_the_periodic_box(self):
        bodies = [{"name": "rod", "kind": "planar", "position": [1.0, 0.0], "angle": 0.0, "spacing": [0.0, 0.0]}]
        space = {**deck()["space"], "x_min": "periodic", "x_max": "periodic"}
        model = Model(deck(bodies=bodies, space=space))
        period = model.period[0]
        motion = model.motion(Centers(position=[[0.5, 0.5, 0]], origin=[[0.5 - 3 * period, 0.5, 0]], angle=[0.5]), 0)
        np.testing.assert_allclose(motion.origins[[0, GROUND]], [[0.5, 0.5, 0], [0, 0, 0]])
        np.testing.assert_allclose(motion.rotations[0, :, 0], [np.cos(0.5), np.sin(0.5), 0], atol=1e-15)

    def test_meshes_that_touch_nothing_are_counted_last(self):
        uses = [[("box", False), ("drum", True)], [("pipe", True)]]
        bodies = [{"name": f"b{k}", "kind": "planar", "position": [0.0, 0.0], "angle": 0.0, "spacing": [0.0, 0.0],
                   "collides": True, "meshes": [{"mesh": mesh, "collides": touches} for mesh, touches in own]}
                  for k, own in enumerate(uses)]
        meshes = [{"name": kind, "kind": kind} for kind in ("box", "drum", "pipe")]
        walls = [{"name": "floor", "mesh": "box"}]
        self.assertEqual(Model(deck(bodies=bodies, meshes=meshes, walls=walls)).holding, [True, True, False, False])
        bodies[1]["collides"] = False
        self.assertEqual(Model(deck(bodies=bodies, meshes=meshes, walls=walls)).holding, [True, False, False, True])

    def test_a_body_without_a_size_is_drawn_in_the_space(self):
        model = Model(deck(bodies=[{"name": "point", "kind": "planar", "position": [0.5, 0.5], "angle": 0.0,
                                    "spacing": [0.0, 0.0]}]))
        bodies = Centers(position=[[0.5, 0.5, 0]], angle=[0], radius=[0])
        run = SimpleNamespace(model=model, bodies=bodies, particles=Centers(position=[]), surfaces=None,
                              motion=lambda snapshot: model.motion(bodies, snapshot))
        low, high = plane_bounds(run, [0])
        self.assertTrue((low < model.low)[:2].all() and (high > model.high)[:2].all())

    def test_a_body_in_space_turns_as_its_quaternion_says(self):
        at = {"name": "top", "kind": "spatial", "position": [0.0, 0.0, 2.0], "spacing": [0.0, 0.0, 0.0]}
        joints = [{"name": "tip", "type": "spherical", "bodies": ["ground", "top"], "point": [0.0, 0.0, 1.0]}]
        half = np.sqrt(0.5)  # by a quarter turn about x: y to z
        for pose in ({"rotation_axis": [2.0, 0.0, 0.0], "rotation_angle": np.pi / 2},
                     {"quaternion": [half, half, 0.0, 0.0]}):
            model = Model(deck(bodies=[at | pose], joints=joints))
            (pairs, local, _) = model.connections["spherical"]
            np.testing.assert_allclose(local[0], [[0, 0, 1], [0, -1, 0]], atol=1e-15)
            motion = model.motion(Centers(position=[[0, 0, 2]], orientation=[[1, 0, 0, 0]]), 0)
            np.testing.assert_allclose(motion.positions(pairs, local)[0], [[0, 0, 1], [0, -1, 2]], atol=1e-15)

    def test_frames_beside_centres_of_mass_and_markers(self):
        """A rod of two balls of 1 and 3 parts at 0 and 1 along its x axis, which starts along the global z."""
        solids = [{"kind": "sphere", "radius": 0.1, "density": density, "offset": [x, 0.0, 0.0]}
                  for x, density in ((0.0, 1.0), (1.0, 3.0))]
        rod = {"name": "rod", "kind": "spatial", "position": [0.0, 0.0, 2.0], "spacing": [0.0, 0.0, 0.0],
               "solids": solids, "x_axis": [0.0, 0.0, 1.0], "z_axis": [0.0, 1.0, 0.0]}
        markers = [{"name": "floor", "body": "ground", "local_point": [0.0, 0.0, 3.0]},
                   {"name": "end", "body": "rod", "local_point": [1.0, 0.0, 0.0]}]
        joints = [{"name": "ball", "type": "spherical", "markers": ["floor", "end"]},
                  {"name": "free", "type": "point-on-line", "bodies": ["ground", "rod"], "axis": [1.0, 0.0, 0.0]}]
        model = Model(deck(bodies=[rod], markers=markers, joints=joints))
        (pairs, local, _) = model.connections["spherical"]
        np.testing.assert_allclose(model.start.positions(pairs, local)[0], [[0, 0, 3]] * 2, atol=1e-15)
        np.testing.assert_allclose(model.connections["point-on-line"][1][0], [[0, 0, 2.75], [0.75, 0, 0]], atol=1e-15)
        half = np.sqrt(0.5)  # a quarter turn about z
        bodies = Centers(position=[[0, 0.75, 2]], origin=[[0, 0, 2]], orientation=[[half, 0, 0, half]])
        motion = model.motion(bodies, 0)
        np.testing.assert_allclose(motion.positions(pairs, local)[0], [[0, 0, 3], [0, 1, 2]], atol=1e-15)


class WallTest(unittest.TestCase):
    def test_a_plane_cuts_a_box(self):
        low, high = np.zeros(3), np.ones(3)
        hexagon = section(low, high, np.full(3, 0.5), np.array([1.0, 1.0, 1.0]))
        self.assertEqual(len(hexagon), 6)
        self.assertAlmostEqual(area(hexagon), 3 * np.sqrt(3) / 4)
        self.assertAlmostEqual(area(section(low, high, np.array([0.3, 9, 9]), np.array([-2.0, 0, 0]))), 1)
        self.assertEqual(len(section(low, high, np.array([2.0, 0, 0]), np.array([1.0, 0, 0]))), 0)

    def test_what_is_behind_a_wall_is_solid(self):
        walls = [{"name": "slope", "point": [0.0, 0.0], "normal": [1.0, 1.0]}]
        space = {**deck()["space"], "x_max": "wall"}
        found = solids(Model(deck(walls=walls, space=space)), np.array([-2.0, -2.0]), np.array([2.0, 3.0]))
        (side, (point, normal)), (slope, _) = found
        np.testing.assert_array_equal((side[:, 0].min(), side[:, 0].max()), (1, 2))
        self.assertAlmostEqual(area(np.pad(side, ((0, 0), (0, 1)))), 5)
        np.testing.assert_array_equal((point[0], normal[0]), (1, -1))
        self.assertAlmostEqual(area(np.pad(slope, ((0, 0), (0, 1)))), 2)  # half of the square below it, in the space
        self.assertEqual(len(cut(rectangle([0, 0], [1, 1]), np.array([2.0, 0]), np.array([1.0, 0]))), 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
