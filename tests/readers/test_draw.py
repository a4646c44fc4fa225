"""Pictures and plots of runs: a 2D one with particles and bodies, a 3D one without bodies, one without particles, and
four mechanisms of triangles.

    python3 tests/readers/test_draw.py NET_400 BOX_OF_SPHERES SLIDER_CRANK DRUM_LIFTERS EXCAVATOR SCREW_LIFT WHEEL_RIG

takes the folders of their results. Needs postprocess/requirements.txt."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import matplotlib.image
import matplotlib.pyplot as plt
import matplotlib.text
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

import scree
from scree.errors import ScreeError
from scree.pictures.discs import DiscScene
from scree.pictures.mechanism import Mechanism
from scree.pictures.palette import BODY_COLOR
from scree.pictures.render import DrawnRun, PictureOptions, make_picture, save_picture, vtk_renders
from scree.pictures.space import SphereScene

NET, BOX, CRANK, DRUM, EXCAVATOR, SCREW, WHEEL = (pathlib.Path(path).resolve() for path in sys.argv[1:8])
ORANGE = matplotlib.colors.to_rgb(BODY_COLOR)


def draw(*words, folder="/", root=ROOT):
    """The program, started in that folder."""
    program = os.path.relpath(root / "postprocess" / "draw", folder)
    return subprocess.run([program, *map(str, words)], cwd=folder, capture_output=True, text=True)


def drawn(folder):
    return DrawnRun(scree.open(folder))


def look(run, **chosen):
    """Fitted to all of the run's snapshots."""
    found = PictureOptions(**chosen)
    found.fit(run, range(len(run.particles)))
    return found


def pixels(path):
    return matplotlib.image.imread(path)[..., :3]


def share_of(image, color):
    return (np.abs(image - color).max(axis=2) < 0.02).mean()


class ProgramTest(unittest.TestCase):
    """By the name that README gives, from another folder."""

    def check(self, results, bodies):
        for name in ("final.png", "energies.png", "animation.mp4", "animation.gif"):
            (results / name).unlink(missing_ok=True)
        others = [results / name for name in ("history.png", "film.mp4", "film.gif", "picture.png")]
        for path in others:  # of scree-post's other commands
            path.write_text("theirs")
        run = draw(results, "--frames", 3)
        self.assertEqual([path.read_text() for path in others], ["theirs"] * len(others))
        for path in others:
            path.unlink()
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertIn(str(results / "final.png"), run.stdout)
        animation = [path for path in results.glob("animation.*") if path.suffix in (".mp4", ".gif")]
        self.assertEqual(len(animation), 1)
        self.assertGreater(animation[0].stat().st_size, 5000)
        final, history = pixels(results / "final.png"), pixels(results / "energies.png")
        for image in (final, history):
            self.assertGreater(min(image.shape[:2]), 500)
            self.assertLess(max(image.shape[:2]), 2000)
            self.assertGreater(len(np.unique(np.round(32 * image).reshape(-1, 3), axis=0)), 50)
        self.assertEqual(share_of(final, ORANGE) > 1e-3, bodies)

    def test_a_run_in_the_plane(self):
        self.check(NET, bodies=True)

    def test_a_run_in_space(self):
        self.check(BOX, bodies=False)

    def test_a_run_without_particles(self):
        self.check(CRANK, bodies=True)

    def test_columns_of_the_history(self):
        listed = draw(NET, "--list")
        self.assertIn("contacts/net/fy [N]: contact force on the row's bodies", listed.stdout)
        plotted = draw(NET, "--only", "history", "--columns", "contacts/net/fx", "contacts/net/contacts")
        self.assertEqual((plotted.returncode, plotted.stdout.strip()), (0, str(NET / "energies.png")))
        self.assertIn("no column contacts/nte", draw(NET, "--only", "history", "--columns", "contacts/nte").stderr)

    def test_what_cannot_be_drawn_is_named(self):
        with tempfile.TemporaryDirectory() as empty:
            for folder in (empty, f"{empty}/missing"):
                run = draw(folder)
                self.assertEqual(run.returncode, 2)
                self.assertTrue(run.stderr.startswith("error: "), run.stderr)
                self.assertNotIn("Traceback", run.stderr)

    def test_a_fresh_clone_is_set_up_first(self):
        with tempfile.TemporaryDirectory() as folder:
            clone = pathlib.Path(folder) / "a clone"
            shutil.copytree(ROOT / "postprocess", clone / "postprocess")
            (clone / "jobs").mkdir()
            setup = clone / "jobs" / "setup.sh"  # in place of the one that installs
            setup.write_text(f'#!/bin/sh\necho "$@" >>"{folder}/calls"\nln -s "{ROOT}/.venv" "{clone}/.venv"\n')
            setup.chmod(0o755)
            link = pathlib.Path(folder) / "draw"
            link.symlink_to(clone / "postprocess" / "draw")
            for _ in range(2):
                run = subprocess.run([link, NET, "--list"], capture_output=True, text=True)
                self.assertEqual(run.returncode, 0, run.stderr)
            self.assertEqual(pathlib.Path(folder, "calls").read_text(), "--pictures\n")


class PictureTest(unittest.TestCase):
    def test_the_colour_bar_is_that_of_particles(self):
        for results, particles in ((NET, True), (BOX, True), (CRANK, False)):
            run = drawn(results)
            picture = make_picture(run, [len(run.particles) - 1], look(run))
            self.assertEqual(picture.bar is not None, particles)
            self.assertEqual(len(picture.figure.axes), 1 + particles)
            self.assertEqual("particle" in picture.caption(0), particles)
        self.assertEqual(picture.caption(0), "t = 0 s, 3 bodies (orange)")
        self.assertEqual(picture.title.get_text(), "slider-crank")

    def test_the_box_is_the_space(self):
        run = drawn(BOX)
        scene = SphereScene(run, [len(run.particles) - 1], use_vtk=False)
        self.assertLess(run.particles.rows(len(run.particles) - 1, "position")[:, 2].min(), 0.1)
        np.testing.assert_array_equal(scene.box, [[0, 0, 0], [0.2, 0.2, 0.4]])
        self.assertEqual(len(scene.faces()), 3)  # six sides are walls; those in front would hide the particles
        width = np.ptp(scene.project(np.array([[0, 0.2, 0.2], [0.2, 0, 0.2]]))[:, 0])
        self.assertLess(width, 2 * scene.half[0])

    def test_all_of_a_swing_is_in_view(self):
        run = drawn(CRANK)
        x_min, x_max, y_min, y_max = DiscScene(run, [len(run.particles) - 1], None).view
        self.assertLess(x_min, -0.2)
        self.assertGreater(x_max, 0.86)
        self.assertTrue(y_min < -0.2 and y_max > 0.2)


    def test_the_scale_is_of_what_is_in_the_picture(self):
        """Half of the particles have fallen out of sight, and are as fast as that takes."""
        for results, with_vtk in ((NET, False), (BOX, False), (BOX, True)):
            run = drawn(results)
            down, last = run.model.up * 50 * np.ptp([run.model.low, run.model.high]), len(run.particles) - 1
            rows, fallen = run.particles.rows, np.arange(run.particles.count(last)) % 2 == 0
            changes = {"position": lambda values: values - fallen[:, None] * down,
                       "velocity": lambda values: values * np.where(fallen, 1000.0, 1.0)[:, None]}
            still = np.linalg.norm(rows(last, "velocity")[~fallen], axis=1)
            run.particles.rows = lambda snapshot, name: changes.get(name, lambda values: values)(rows(snapshot, name))
            if with_vtk and not vtk_renders():
                continue
            picture = make_picture(run, [last], look(run, with_vtk=with_vtk))
            least = 0.1 * np.sqrt(np.linalg.norm(run.model.gravity) * 2 * rows(last, "radius").max())
            self.assertLessEqual(picture.colors.high, 1.5 * max(still.max(), least))
            self.assertGreater(picture.colors.high, 0.9 * np.percentile(still, 90))
            self.assertIn(f"particle speed [m/s]: 0 to {picture.colors.high:g}", picture.imprint(last)["Color bar"])
            plt.close(picture.figure)

    def test_meshes_in_the_plane_make_no_margin(self):
        """They reach out of it, for other programs to show; a picture's margin is a share of what is in the plane."""
        run = drawn(NET)
        before = DiscScene(run, [0], None).view

        class Walls:
            field = None

            @staticmethod
            def bounds(snapshots):
                return np.array([*before[::2], -100.0]), np.array([*before[1::2], 100.0])
        run.surfaces = Walls()
        width, height = np.ptp(before[:2]), np.ptp(before[2:])
        after = DiscScene(run, [0], None).view
        self.assertLess(np.ptp(after[:2]), width + 0.1 * max(width, height))

    def test_words_are_within_the_figure(self):
        """Also where the title is long and the picture narrow, and in films, which have another size."""
        for results in (NET, BOX, CRANK):
            run = drawn(results)
            run.title = "a title that is as long as titles of decks can be, " * 4
            picture = make_picture(run, [len(run.particles) - 1], look(run, with_vtk=False))
            picture.draw(len(run.particles) - 1)
            width, height = picture.figure.canvas.get_width_height()
            renderer = picture.figure.canvas.get_renderer()
            words = [text for text in picture.figure.findobj(matplotlib.text.Text) if text.get_text().strip() and
                     text.get_visible()]
            self.assertGreater(len(words), 2)
            for text in words:
                box = text.get_window_extent(renderer)
                self.assertTrue(box.x0 >= 0 and box.y0 >= 0 and box.x1 <= width and box.y1 <= height,
                                f"{text.get_text()!r}: {box} of {width} x {height}")
            plt.close(picture.figure)


class SurfaceTest(unittest.TestCase):
    def test_a_drum_shows_what_it_holds(self):
        """Against the same picture without the drum, and without the grains."""
        run = drawn(DRUM)
        run.surfaces.triangles = {}
        bare = self.image(run)
        run = drawn(DRUM)
        full = self.image(run)
        self.shrink_grains(run)
        empty = self.image(run)

        def differ(one, other):
            return np.abs(one - other).max(axis=2) > 0.1
        self.assertGreater(differ(full, bare).mean(), 0.1)  # the drum is there
        self.assertGreater(differ(full, empty).mean(), 0.02)  # and what is in it

    def test_a_field_colours_the_triangles_that_have_some(self):
        plain, run = self.image(drawn(DRUM)), drawn(DRUM)
        snapshots = range(len(run.particles))
        run.surfaces.color_by("wear_depth", snapshots)
        self.assertEqual(run.surfaces.label(), "wear depth [m]")
        values = [run.surfaces.values(snapshot)["bodies"] for snapshot in snapshots]
        self.assertEqual(values[0].max(), 0)
        self.assertTrue((values[-1] >= values[1]).all())  # it only grows
        self.assertTrue(0 < run.surfaces.limit <= values[-1].max())
        if vtk_renders():
            self.assertGreater((np.abs(self.image(run) - plain).max(axis=2) > 0.1).mean(), 0.1)
        with self.assertRaises(ScreeError):
            run.surfaces.color_by("speed", snapshots)

    def test_an_opaque_drum_hides_what_it_holds(self):
        run = drawn(DRUM)
        full = self.image(run, 1.0)
        self.shrink_grains(run)
        shown = (np.abs(full - self.image(run, 1.0)).max(axis=2) > 0.1).mean()
        self.assertEqual(shown < 1e-3, vtk_renders())  # without VTK there are edges alone

    def test_an_opacity_is_a_share_and_a_speed_above_zero(self):
        for option, values in (("--opacity", ("1.1", "-0.1", "nan", "x")), ("--fastest", ("0", "-1", "inf", "nan"))):
            for wrong in values:
                run = draw(DRUM, f"{option}={wrong}")
                self.assertEqual(run.returncode, 2)
                self.assertIn(option, run.stderr)

    def test_the_colour_scale_ends_where_it_is_told_to(self):
        run = drawn(DRUM)
        self.assertEqual(make_picture(run, [0], look(run, fastest=0.3)).scene.colors.norm.vmax, 0.3)

    @staticmethod
    def image(run, opacity=None):
        with tempfile.TemporaryDirectory() as folder:
            path, last = pathlib.Path(folder) / "picture.png", len(run.particles) - 1
            save_picture(make_picture(run, [last], look(run, opacity=opacity, with_vtk=vtk_renders())), last, path)
            return pixels(path)

    @staticmethod
    def shrink_grains(run):
        """Out of sight; without any the picture would be laid out in another way."""
        rows = run.particles.rows
        run.particles.rows = lambda snapshot, name: rows(snapshot, name) * (1e-6 if name == "radius" else 1)


class MechanismTest(unittest.TestCase):
    def test_joints_meet_in_every_snapshot(self):
        run = drawn(CRANK)
        self.assertEqual({kind: len(found[0]) for kind, found in run.model.connections.items()},
                         {"revolute": 3, "translational": 1})
        mechanism = Mechanism(run.model, run.motion, 0.01)
        for snapshot in range(len(run.particles)):
            motion = run.motion(snapshot)
            pairs, local, _ = run.model.connections["revolute"]
            ends = motion.positions(pairs, local)
            np.testing.assert_allclose(ends[:, 0], ends[:, 1], atol=1e-8)
            lines, points = mechanism.draw(snapshot)
            np.testing.assert_allclose(points["revolute"], ends[:, 0], atol=1e-8)
            self.assertEqual(lines["bar"].shape, (3, 2, 3))  # the crank, and the rod from pin to pin by its centre
            np.testing.assert_allclose(np.linalg.norm(np.diff(lines["bar"], axis=1), axis=2).sum(), 0.8)
            self.assertEqual(len(points["held"]), 2)

    def test_springs_end_on_their_bodies(self):
        run = drawn(NET)
        lines, points = Mechanism(run.model, run.motion, 1e-3).draw(len(run.particles) - 1)
        centers = run.motion(len(run.particles) - 1).origins
        self.assertEqual(len(lines["spring"]), 19)
        np.testing.assert_allclose(lines["spring"][:, 0], centers[:19])
        np.testing.assert_allclose(lines["spring"][:, -1], centers[1:20])
        np.testing.assert_allclose(points["held"][:, :2], [[-0.95, -0.6], [0.95, -0.6]])


class ExampleTest(unittest.TestCase):
    """The mechanisms among the examples do what their decks say, also before they touch a grain."""

    def test_an_excavator_moves_by_its_cylinders(self):
        run = drawn(EXCAVATOR)
        mechanism, last = Mechanism(run.model, run.motion, 0.01), len(run.particles) - 1
        pairs, local, _ = run.model.connections["revolute"]
        self.assertEqual(len(pairs), 6)
        for snapshot in range(last + 1):
            ends = run.motion(snapshot).positions(pairs, local)
            np.testing.assert_allclose(ends[:, 0], ends[:, 1], atol=1e-9)  # the loop of four of them is closed

        def lengths(snapshot):
            rods = mechanism.draw(snapshot)[0]["rod"]
            return np.linalg.norm(rods[:, 1] - rods[:, 0], axis=1)
        # What the cylinders want at 0.9 s; loads take some mm.
        np.testing.assert_allclose(lengths(last) - lengths(0), [-0.04, 0.0122, -0.0012], atol=0.004)

    def test_a_screw_is_turned_by_its_motor(self):
        history = scree.open(SCREW).history
        self.assertAlmostEqual(history["coordinates/bearing/angle_rate"][-1], 25, delta=0.1)
        self.assertTrue((np.abs(history["efforts/motor/effort"]) <= 0.5).all())

    def test_a_wheel_spins_faster_than_it_rolls(self):
        history = scree.open(WHEEL).history
        way, angle = (history[f"coordinates/{name}"].values for name in ("rails/displacement", "axle/angle"))
        self.assertAlmostEqual(way[-1], 0.06, places=9)
        np.testing.assert_allclose(0.08 * angle, way, atol=1e-9)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
