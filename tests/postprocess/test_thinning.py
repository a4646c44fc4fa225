"""Thinned results: which particles remain, what their files hold, and that pictures of them look alike.

    python3 tests/postprocess/test_thinning.py NET_400 DRUM_LIFTERS

takes the folders of their results. Needs postprocess/requirements.txt."""

import json
import sys
import unittest

import numpy as np
import PIL.Image
from test_commands import DONE, DRUM, NET, WRONG, CommandTest

import scree
from scree.pictures.render import DrawnRun, PictureOptions, make_picture
from scree.thinning import OTHERS, POSITIONS, VALUES, rounded, seen

ABOVE = np.eye(3)  # looking down along z
LEVELS = 16  # difference of a colour that one sees, of 255


class SeenTest(unittest.TestCase):
    def test_what_is_behind_is_hidden(self):
        points = np.array([[0, 0, 0], [0, 0, -3], [0.6, 0, -3], [5, 5, -9], [0.05, 0, 0.99]], dtype=float)
        radii = np.array([1.0, 0.9, 0.9, 0.1, 0.05])  # below the first; beside it; alone; on its top
        self.assertEqual(seen(points, radii, ABOVE).tolist(), [True, False, True, True, True])
        self.assertEqual(seen(points, radii, -ABOVE).tolist(), [True, True, True, True, False])
        self.assertEqual(seen(points[:0], radii[:0], ABOVE).tolist(), [])

    def test_every_ray_ends_at_a_sphere_that_is_kept(self):
        """Rays through spheres of very different sizes."""
        rng = np.random.default_rng(3)
        points, radii = rng.random((400, 3)), rng.uniform(0.01, 0.08, 400)
        kept = seen(points, radii, ABOVE)
        self.assertTrue(0.1 < kept.mean() < 0.9)
        rays = rng.random((4000, 2))
        squares = radii**2 - np.square(rays[:, None] - points[:, :2]).sum(axis=2)  # [rays][spheres]
        heights = np.where(squares > 0, points[:, 2] + np.sqrt(np.maximum(squares, 0)), -np.inf)
        met = np.isfinite(heights).any(axis=1)
        self.assertTrue(kept[heights[met].argmax(axis=1)].all())

    def test_rounding(self):
        values = np.random.default_rng(4).normal(0, 3, 1000)
        for error in (1e-4, 0.02, 7.0):
            self.assertLessEqual(np.abs(rounded(values, error) - values).max(), error)
            self.assertGreater(len(np.unique(values)), len(np.unique(rounded(values, error))))
        np.testing.assert_array_equal(rounded(values, 0.0), values)


class ThinTest(CommandTest):
    def thinned(self, run, *words):
        folder = self.folder / f"thin_{len(list(self.folder.iterdir()))}"
        self.assertEqual(self.command(DONE, "thin", run, "-o", folder, *words).strip(), str(folder))
        return scree.open(folder)

    def test_particles_that_remain_are_those_of_the_run(self):
        """Also in a plane, where none is hidden and their number changes."""
        for folder in (NET, DRUM):
            run, thin = scree.open(folder), self.thinned(folder, "--at-once", 2)
            np.testing.assert_array_equal(thin.snapshots.times, run.snapshots.times)
            for found, whole in zip(thin.snapshots, run.snapshots):
                ids = whole.particles["global_id"].values
                rows = np.searchsorted(ids, found.particles["global_id"].values)
                np.testing.assert_array_equal(ids[rows], found.particles["global_id"].values)
                self.assertEqual(list(found.particles), list(whole.particles))
                self.assertEqual(thin.series("particles").whole_count(found.number), len(ids))
                self.assertEqual(len(rows) == len(ids), folder == NET)
                for name, field in whole.particles.items():
                    limit = POSITIONS * whole.particles["radius"].values.min() if name == "position" else \
                        VALUES * np.percentile(np.abs(found.particles[name].values), 99) * (1 + 2 * VALUES)
                    apart = np.abs(found.particles[name].values - field.values[rows]).max()
                    self.assertLessEqual(apart, limit, name)
                    self.assertEqual(found.particles[name].unit, field.unit)

    def test_the_rest_of_the_results_is_the_same(self):
        run, thin = scree.open(DRUM), self.thinned(DRUM)
        for kind in set(OTHERS) & set(run.snapshots[0].kinds):
            for found, whole in zip(thin.snapshots, run.snapshots):
                for name, field in getattr(whole, kind).items():
                    np.testing.assert_array_equal(getattr(found, kind)[name].values, field.values, f"{kind} {name}")
        np.testing.assert_array_equal(thin.history["energy/total"], run.history["energy/total"])
        self.assertEqual(thin.record, json.loads((DRUM / "run_record.json").read_text()))
        files = [folder / "particles.vtkhdf" for folder in (thin.folder, DRUM)]
        self.assertLess(files[0].stat().st_size, 0.5 * files[1].stat().st_size)

    def test_vtk_reads_each_snapshot(self):
        thin = self.thinned(DRUM)
        for kind in ("particles", "surfaces"):
            reader = scree.reader(thin.folder / f"{kind}.vtkhdf")
            for number, snapshot in enumerate(thin.snapshots):
                reader.set_active_time_point(number)
                mesh, points = reader.read(), getattr(snapshot, kind)
                np.testing.assert_array_equal(mesh.points, points["position"].values.astype(mesh.points.dtype))
                self.assertEqual(mesh.n_cells, len(points.triangles) or points.count)

    def test_a_part_of_the_run_and_more_sides(self):
        run = scree.open(DRUM)
        part = self.thinned(DRUM, "--from", 0.05, "--to", 0.15)
        np.testing.assert_array_equal(part.snapshots.times, run.snapshots.times[1:2])
        sides = self.thinned(DRUM, "--from", 0.05, "--to", 0.15, "--all-sides")
        ids = [set(each.snapshots[0].particles["global_id"].values.tolist()) for each in (part, sides)]
        self.assertLess(ids[0], ids[1])
        np.testing.assert_array_equal(part.snapshots[0].surfaces["position"], run.snapshots[1].surfaces["position"])
        again = self.thinned(part.folder)
        self.assertEqual(again.series("particles").whole_count(0), run.snapshots[1].particles.count)

    def test_pictures_look_alike(self):
        thin = self.thinned(DRUM)
        paths = [self.folder / name for name in ("whole.png", "thin.png")]
        for folder, path in zip((DRUM, thin.folder), paths):
            self.command(DONE, "picture", folder, "-o", path, "--opacity", 0)
        whole, found = (PIL.Image.open(path) for path in paths)
        self.assertEqual(found.text, whole.text)
        apart = np.abs(np.asarray(found, dtype=int) - np.asarray(whole, dtype=int)).max(axis=2)
        self.assertLess((apart > LEVELS).mean(), 2e-3)
        drawn = DrawnRun(thin)
        count = scree.open(DRUM).snapshots[-1].particles.count
        self.assertIn(f"{count:,} particles", make_picture(drawn, [2], PictureOptions(with_vtk=False)).caption(2))

    def test_what_is_refused(self):
        for words, text in ((("-o", DRUM), "holds the results themselves"),
                            (("--from", 7), "no snapshot from 7 to inf s; they go from 0 to 0.16 s"),
                            (("--at-once", 0), "not above 0")):
            self.assertIn(text, self.command(WRONG, "thin", DRUM, *words))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
