"""The commands of scree-post that draw: films, pictures and their colours, and the file for ParaView.

    python3 tests/postprocess/test_looks.py NET_400 DRUM_LIFTERS

takes the folders of their results. Needs postprocess/requirements.txt. What pictures show is tested by
tests/readers/test_draw.py, what ParaView's file does by tests/readers/test_paraview.py."""

import ast
import json
import sys
import unittest

import numpy as np
import PIL.Image
from test_commands import DONE, DRUM, NET, WRONG, CommandTest

import scree
from scree.pictures.render import DrawnRun, PictureOptions, make_picture


class FilmTest(CommandTest):
    def test_part_of_a_run_for_pages(self):
        for name in ("film.gif", "film.webp"):
            path = self.folder / name
            said = self.command(DONE, "animate", NET, "--from", "0.2", "--to", "0.3", "-o", path, "--rate", "5",
                                "--width", "400")
            self.assertEqual(said.strip(), str(path))
            with PIL.Image.open(path) as film:
                film.seek(film.n_frames - 1)
                film.load()
                self.assertEqual((film.n_frames, film.info["duration"], film.size[0]), (3, 200, 400))
        sizes = [path.stat().st_size]
        for quality in ("40", "5"):
            self.command(DONE, "animate", NET, "--from", "0.2", "--to", "0.3", "-o", path, "--width", "400",
                         "--quality", quality)
            sizes.append(path.stat().st_size)
        self.assertEqual(sizes, sorted(sizes, reverse=True))

    def test_the_colour_bar_stays_where_it_is(self):
        for folder, options in ((NET, PictureOptions()), (DRUM, PictureOptions(with_vtk=False))):
            picture, places = make_picture(DrawnRun(scree.open(folder)), [0, 1], options), []
            for snapshot in (0, 0, 1):
                picture.draw(snapshot)
                picture.figure.canvas.draw()
                places.append(picture.bar.ax.get_window_extent().bounds)
            self.assertEqual(len(set(places)), 1, places)
            self.assertGreater(places[0][3], 20 * places[0][2])

    def test_what_is_refused(self):
        for words, text in ((("--from", "7"), "no snapshot from 7 to inf s; they go from 0 to 1 s"),
                            (("-o", "film.avi"), "must end in .mp4, .webp or .gif"), (("--frames", "0"), "not above 0"),
                            (("--rate", "-1"), "not above 0"), (("--quality", "101"), "not from 1 to 100"),
                            (("--surfaces", "pressure"), "--surfaces is for 3D runs")):
            self.assertIn(text, self.command(WRONG, "animate", NET, *words))
        self.assertIn("--view and --axes are for planar runs",
                      self.command(WRONG, "animate", DRUM, "--view", 0, 1, 0, 1))


class PictureTest(CommandTest):
    def test_the_nearest_snapshot(self):
        path = self.folder / "picture.png"
        self.assertEqual(self.command(DONE, "picture", NET, "--time", "0.12", "-o", path).strip(), str(path))
        last, axes = self.folder / "last.png", self.folder / "axes.png"
        self.command(DONE, "picture", NET, "-o", last)
        self.command(DONE, "picture", NET, "-o", axes, "--axes")
        self.assertEqual(len({each.read_bytes() for each in (path, last, axes)}), 3)
        again = self.folder / "again.png"
        self.command(DONE, "picture", NET, "--time", "0.1", "-o", again)
        self.assertEqual(again.read_bytes(), path.read_bytes())
        with PIL.Image.open(path) as picture:
            said = picture.text
        self.assertEqual((said["Title"], said["Description"]),
                         ("5.3 net and 400 particles", "t = 0.1 s, 400 particles, 20 bodies (orange)"))
        self.assertRegex(said["Color bar"], r"^particle speed \[m/s\]: 0 to [0-9.]+$")
        self.assertRegex(said["Software"], r"^Scree [0-9.]+, commit ")

    def test_few_colors_for_a_small_file(self):
        whole, small = self.folder / "whole.png", self.folder / "small.png"
        self.command(DONE, "picture", NET, "-o", whole)
        self.command(DONE, "picture", NET, "-o", small, "--colors", "16")
        self.assertLess(small.stat().st_size, 0.5 * whole.stat().st_size)
        with PIL.Image.open(whole) as all_colors, PIL.Image.open(small) as picture:
            self.assertLessEqual(len(picture.getcolors()), 16)
            self.assertEqual((picture.size, picture.text), (all_colors.size, all_colors.text))

    def test_what_is_refused(self):
        self.assertIn("must be at most 256", self.command(WRONG, "picture", NET, "--colors", "300"))
        self.assertIn("xyz", self.command(WRONG, "picture", NET, "-o", self.folder / "picture.xyz"))
        self.assertIn("for planar runs", self.command(WRONG, "picture", DRUM, "--axes"))


class ColorTest(CommandTest):
    def test_of_a_field(self):
        drawn = DrawnRun(scree.open(NET))
        scene = make_picture(drawn, [0], PictureOptions(color="radius")).scene
        np.testing.assert_array_equal(scene.coloring.values(drawn.particles, 0), drawn.particles.rows(0, "radius"))
        picture = make_picture(drawn, [0], PictureOptions(color="group"))
        self.assertEqual([text.get_text() for text in picture.bar.ax.get_yticklabels()], ["block"])
        said = self.command(WRONG, "picture", NET, "--color", "nothing")
        self.assertIn("particles have no field nothing; there are ", said)

    def test_what_rests_looks_so(self):
        drawn = DrawnRun(scree.open(NET))
        rows = drawn.particles.rows
        drawn.particles.rows = lambda snapshot, name: rows(snapshot, name) * (name != "velocity")
        least = 0.1 * np.sqrt(np.linalg.norm(drawn.model.gravity) * 2 * np.median(rows(0, "radius")))
        top = make_picture(drawn, [0], PictureOptions()).scene.colors.norm.vmax
        self.assertTrue(least <= top <= 1.5 * least, (least, top))


class ParaviewTest(CommandTest):
    def test_a_file_that_names_its_folder(self):
        """What it shows is tested by tests/readers/test_paraview.py."""
        path = self.folder / "with space's" / "view.py"
        path.parent.mkdir()
        self.assertEqual(self.command(DONE, "paraview", NET, "-o", path).strip(), str(path))
        tree = ast.parse(path.read_text())
        names = {node.targets[0].id: node.value for node in tree.body if isinstance(node, ast.Assign)
                 and isinstance(node.targets[0], ast.Name)}
        self.assertEqual(ast.literal_eval(names["FOLDER"]), str(NET))
        self.assertEqual(json.loads(ast.literal_eval(names["DECK"])), json.loads(json.dumps(scree.open(NET).deck)))
        drawing = ast.literal_eval(names["DRAWING"])
        compile(drawing, "drawing", "exec")
        self.assertNotIn("from scree", drawing)
        defined = [node.name for node in ast.parse(drawing).body if isinstance(node, ast.FunctionDef | ast.ClassDef)]
        self.assertEqual(len(defined), len(set(defined)))  # all stand in one namespace there
        self.assertLessEqual({"Model", "Mechanism", "drawn", "forces"}, set(defined))
        self.assertIn("must end in .py", self.command(WRONG, "paraview", NET, "-o", self.folder / "view.pvsm"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
