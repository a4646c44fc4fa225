"""The commands of scree-post.

    python3 tests/postprocess/test_commands.py NET_400 DRUM_LIFTERS

takes the folders of their results. Needs postprocess/requirements.txt. What pictures show is tested by
tests/readers/test_draw.py, films, pictures and
ParaView's file by test_looks.py."""

import contextlib
import html.parser
import io
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

import pandas
import pyvista
import scree
from scree.cli import main
from scree.columns import axis, column_label, panels, x_axis
from scree.differences import absolute_differences, differences, matched, over
from scree.plots import balance_panel, energy_panels, history_figure

NET, DRUM = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
DONE, DIFFERENT, WRONG = 0, 1, 2


class CommandTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="scree_commands_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def command(self, code, *words):
        """Returns what it prints, errors included."""
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            try:
                found = main([str(word) for word in words])
            except SystemExit as stop:  # of wrong words
                found = stop.code
        self.assertEqual(found, code, said.getvalue())
        return said.getvalue()

    def copy_of_the_net(self):
        """Without what other tests draw there."""
        drawn = shutil.ignore_patterns("*.png", "*.gif", "*.mp4")
        return pathlib.Path(shutil.copytree(NET, self.folder / "copy", ignore=drawn))


class PlotTest(CommandTest):
    def test_energies_are_told_apart(self):
        history = scree.open(NET).history
        stored, passed, balance = energy_panels(history)
        labels = [line.label for panel in (stored, passed) for line in panel.lines]
        self.assertEqual(len(labels), len(set(labels)))
        self.assertFalse(any("_" in label or "/" in label or "exchanged" in label for label in labels))
        np.testing.assert_allclose(sum(line.values for line in stored.lines[:-1]), stored.lines[-1].values, rtol=1e-9)
        self.assertEqual(min(line.values.min() for line in stored.lines if "gravitational" in line.label), 0)
        share = np.abs(history["energy/balance_error"]).max() / np.max(history["energy/exchanged"])
        np.testing.assert_allclose(np.abs(balance.lines[0].values).max(), 100 * share)
        self.assertIn(f"{100 * share:.2g} % of the", balance.title)

    def test_a_balance_of_nothing_has_no_share(self):
        column = scree.Quantity(np.zeros(3), "J")
        panel = balance_panel({"energy/balance_error": column, "energy/exchanged": column})
        self.assertNotIn("%", panel.title + panel.axis)

    def test_columns_that_stay_zero_are_no_lines(self):
        figure = history_figure(scree.open(NET).history, "net", ["contacts/net/f*"], energies=False)
        (axes,) = figure.axes
        texts = [text.get_text() for text in axes.texts]
        self.assertEqual([text.get_text() for text in axes.get_legend().get_texts()], ["net, x", "net, y"])
        self.assertEqual(texts, ["Zero throughout: net, z."])
        self.assertEqual(axes.get_ylabel(), "force [N]")
        self.assertEqual(axes.get_title("left"), "Contact force on the row's bodies")

    def test_one_curve_says_whose_it_is(self):
        """By the legend where others of its panel stay zero, else by the title."""
        history = scree.open(NET).history
        (axes,) = history_figure(history, "net", ["contacts/net/f[xz]"], energies=False).axes
        self.assertEqual([text.get_text() for text in axes.get_legend().get_texts()], ["net, x"])
        (axes,) = history_figure(history, "net", ["contacts/net/fy"], energies=False).axes
        self.assertEqual(axes.get_title("left"), "net, contact force on the row's bodies, y")
        column = scree.Quantity(np.ones(2), "m", "position")
        self.assertEqual(panels({"particles/17/x": column}, ["particles/17/x"])[0][0], "particle 17, position, x")

    def test_over_a_column(self):
        history = scree.open(NET).history
        figure = history_figure(history, "net", ["contacts/net/f[xy]"], energies=False, x="contacts/net/contacts")
        (axes,) = figure.axes
        self.assertEqual(axes.get_xlabel(), "net, contacts of the row's bodies with particles")
        for line, name in zip(axes.lines, ("x", "y")):
            np.testing.assert_array_equal(line.get_xdata(), history["contacts/net/contacts"])
            np.testing.assert_array_equal(line.get_ydata(), history[f"contacts/net/f{name}"])
        self.assertEqual(x_axis(history, "step/time")[1], "time [s]")
        self.assertEqual(x_axis(history, "contacts/net/fy")[1], "net, contact force on the row's bodies, y [N]")
        path = self.folder / "over.png"
        self.command(DONE, "plot", NET, "--x", "energy/kinetic", "--columns", "step/contacts", "-o", path)
        self.assertGreater(path.stat().st_size, 20000)
        self.assertIn("error: no column contact/net/fy; did you mean contacts/net/fy",
                      self.command(WRONG, "plot", NET, "--x", "contact/net/fy"))
        self.assertIn("energy/elastic_* matches 2 columns, and the horizontal axis takes one: energy/elastic_contacts",
                      self.command(WRONG, "plot", NET, "--x", "energy/elastic_*"))

    def test_files_and_what_is_refused(self):
        for suffix in ("png", "svg"):
            path = self.folder / f"plot.{suffix}"
            self.assertEqual(self.command(DONE, "plot", NET, "-o", path).strip(), str(path))
            self.assertGreater(path.stat().st_size, 20000)
        self.assertIn("xyz", self.command(WRONG, "plot", NET, "-o", self.folder / "plot.xyz"))
        self.assertIn("error: no column nothing; there are: ",
                      self.command(WRONG, "plot", NET, "--columns", "nothing"))
        self.assertIn("contacts/net/fy [N]: contact force", self.command(DONE, "plot", NET, "--list"))
        self.assertIn("error: nothing to plot", self.command(WRONG, "plot", NET, "--no-energies"))
        said = self.command(WRONG, "plot", NET, "-o", self.folder / "no" / "plot.png")
        self.assertRegex(said, r"^error: .*No such file or directory.*\n$")
        self.command(WRONG, "plot")


class WordsTest(unittest.TestCase):
    def test_columns_have_words(self):
        for name, unit, description, legend in (
                ("contacts/bucket/fx", "N", "contact force on the body", "bucket, contact force on the body, x"),
                ("reactions/pin/torque_z", "N m", "reaction torque", "pin, reaction torque, about z"),
                ("bodies/top/e0", "1", "orientation, a unit quaternion", "top, orientation, w"),
                ("coordinates/axle/angle_rate", "rad/s", "rate of the coordinate", "rate of axle angle"),
                ("step/contacts", "1", "contacts, including those with walls", "contacts")):
            self.assertEqual(column_label(name, unit, description).legend(True), legend)
        self.assertEqual((axis("N"), axis("1"), axis("kg/s")), ("force [N]", "number", "[kg/s]"))

    def test_a_panel_says_what_its_lines_share(self):
        history = {name: scree.Quantity(np.zeros(2), unit, text) for name, unit, text in
                   (("contacts/a/fx", "N", "force on it"), ("contacts/b/fx", "N", "force on it"),
                    ("contacts/a/contacts", "1", "contacts of it"))}
        self.assertEqual(panels(history, list(history)),
                         [("Force on it", "force [N]", {"contacts/a/fx": "a, x", "contacts/b/fx": "b, x"}),
                          ("a, contacts of it", "number", {"contacts/a/contacts": "a"})])


class EmptyWordsTest(CommandTest):
    def test_an_empty_name_is_refused(self):
        for words in (("urdf", ""), ("export", NET, "-o", ""), ("picture", ""), ("report", NET, "-o", " ")):
            with self.subTest(words=words):
                self.assertIn("is empty; is a variable of a script not set?", self.command(2, *words))


class CompareTest(CommandTest):
    def change(self, folder, name, dataset, row, by):
        with h5py.File(folder / name, "r+") as file:
            file[dataset][row] += by

    def test_a_copy_has_the_same_bits(self):
        said = self.command(DONE, "compare", NET, self.copy_of_the_net())
        self.assertIn("state of the last checkpoint: the same\nthe same bits (1001 rows", said)

    def test_what_differs_is_told_with_its_size_and_time(self):
        other = self.copy_of_the_net()
        self.change(other, "history.h5", "energy/kinetic", 40, 3.0)
        self.change(other, "particles.vtkhdf", "VTKHDF/Points", 401, 1e-3)
        one, two = differences(scree.open(NET), scree.open(other))
        scale = np.max(scree.open(NET).history["energy/kinetic"])
        self.assertEqual((one.name, two.name, one.unit), ("energy/kinetic", "particles/position", "J"))
        np.testing.assert_allclose((one.largest, one.time, one.relative), (3, 0.04, 3 / scale))
        np.testing.assert_allclose((two.largest, two.time), (1e-3, 0.05))
        self.assertIn("2 differences", self.command(DIFFERENT, "compare", NET, other))
        self.command(DIFFERENT, "compare", NET, other, "--tolerance", "1e-6")
        self.assertIn("the same (", self.command(DONE, "compare", NET, other, "--tolerance", "0.1"))

    def test_one_bit_is_a_difference(self):
        other = self.copy_of_the_net()
        with h5py.File(other / "history.h5", "r+") as file:
            file["energy/total"][7] = np.nextafter(file["energy/total"][7], np.inf)
        self.assertEqual([each.name for each in differences(scree.open(NET), scree.open(other))], ["energy/total"])

    def test_what_only_one_run_has(self):
        other = self.copy_of_the_net()
        with h5py.File(other / "history.h5", "r+") as file:
            del file["energy/total"]
        (other / "bodies.vtkhdf").unlink()
        said = self.command(DIFFERENT, "compare", NET, other, "--tolerance", "1")
        self.assertIn(f"energy/total: in {NET} only", said)
        self.assertIn(f"bodies: in {NET} only", said)
        self.assertIn("drum", self.command(DIFFERENT, "compare", NET, DRUM))

    def test_times_that_only_one_run_has(self):
        """What follows is compared at the times of both, not by number."""
        other = self.copy_of_the_net()
        with h5py.File(other / "history.h5", "r+") as file:
            for column in scree.files.datasets(file).values():
                kept = np.delete(column[:], [5, 6])
                column.resize(kept.shape)
                column[:] = kept
            file["step/time"][3] += 1e-12
        said = self.command(DIFFERENT, "compare", NET, other, "--tolerance", "1e-9")
        self.assertIn(f"rows: 2 more rows from t = 0.005 s to 0.006 s in {NET}\n", said)
        self.assertIn("1 difference (999 rows", said)
        first, second = matched(np.array([0, 0.1, 0.2, 0.3]), np.array([0, 0.2 + 1e-11, 0.25, 0.3, 0.4]))
        self.assertEqual((first.tolist(), second.tolist()), ([0, 2, 3], [0, 1, 3]))
        self.assertEqual([len(found) for found in matched(np.array([0.5]), np.array([0.5]))], [1, 1])

    def test_numbers_that_are_none(self):
        nan, inf = np.nan, np.inf
        found = absolute_differences(np.array([1, nan, nan, inf, inf]), np.array([3, nan, 1, inf, -inf]))
        np.testing.assert_array_equal(found, [2, 0, inf, 0, inf])
        self.assertEqual((over(0, 0), over(1, 0), over(1, 4)), (0, inf, 0.25))


class ExportTest(CommandTest):
    def test_tables(self):
        self.command(DONE, "export", NET, "--times", "0.5", "1.0", "--kinds", "particles", "-o", self.folder / "out")
        names = sorted(path.name for path in (self.folder / "out").iterdir())
        self.assertEqual(names, ["history.csv", "particles_0010.csv", "particles_0020.csv"])
        run = scree.open(NET)
        table = pandas.read_csv(self.folder / "out/particles_0010.csv")
        np.testing.assert_array_equal(table["velocity_x [m/s]"], run.snapshots[10].particles["velocity"][:, 0])
        history = pandas.read_csv(self.folder / "out/history.csv")
        np.testing.assert_array_equal(history["energy/total [J]"], run.history["energy/total"])
        self.assertEqual(list(history)[0], "time [s]")

    def test_tables_of_triangles_have_their_places(self):
        self.command(DONE, "export", DRUM, "--times", "0", "--kinds", "surfaces", "-o", self.folder)
        table = pandas.read_csv(self.folder / "surfaces_0000.csv")
        surfaces = scree.open(DRUM).snapshots[0].surfaces
        corners = surfaces["position"][surfaces.triangles]
        np.testing.assert_allclose(table[["x [m]", "y [m]", "z [m]"]], corners.mean(axis=1), atol=1e-12)

    def test_files_for_vtk(self):
        self.command(DONE, "export", DRUM, "--format", "vtp", "-o", self.folder)
        series = xml.etree.ElementTree.parse(self.folder / "surfaces.pvd").findall(".//DataSet")
        run = scree.open(DRUM)
        np.testing.assert_array_equal([float(each.get("timestep")) for each in series], run.snapshots.times)
        mesh = pyvista.read(self.folder / series[-1].get("file"))
        np.testing.assert_array_equal(mesh.cell_data["pressure"], run.snapshots[-1].surfaces["pressure"])
        self.command(DONE, "export", DRUM, "--format", "vtu", "--times", "0", "-o", self.folder / "vtu")
        grains = pyvista.read(self.folder / "vtu/particles_0000.vtu")
        self.assertEqual(grains.n_points, run.snapshots[0].particles.count)

    def test_meshes_of_true_size(self):
        self.command(DONE, "export", NET, "--format", "ply", "--times", "0", "--kinds", "bodies", "-o", self.folder)
        balls, shapes = pyvista.read(self.folder / "bodies_0000.ply"), scree.open(NET).snapshots[0].bodies
        reach = (shapes["position"] + shapes["radius"][:, None]).max(axis=0)
        np.testing.assert_allclose(np.array(balls.bounds)[1::2], reach, atol=2e-3)
        self.command(DONE, "export", DRUM, "--format", "stl", "--times", 0.1, "--kinds", "surfaces", "-o", self.folder)
        self.assertEqual(pyvista.read(self.folder / "surfaces_0001.stl").n_cells,
                         len(scree.open(DRUM).snapshots[1].surfaces.triangles))


class Page(html.parser.HTMLParser):
    """The texts, pictures and links, where these lead, and what is open at the end."""

    def __init__(self, text):
        super().__init__()
        self.texts, self.pictures, self.links, self.places, self.open = [], [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        if tag == "img":
            self.pictures.append(dict(attributes)["src"])
        self.links += [value for name, value in attributes if name == "href"]
        self.places += [value for name, value in attributes if name == "id"]
        if tag == "img":
            return
        if tag != "meta":
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag

    def handle_data(self, data):
        self.texts.append(data)


class ReportTest(CommandTest):
    def test_all_is_in_one_page(self):
        path = self.folder / "report.html"
        self.command(DONE, "report", NET, "-o", path)
        page = Page(path.read_text())
        self.assertEqual((page.open, len(page.pictures)), ([], 5))  # with the reactions
        self.assertTrue(all(picture.startswith("data:image/png;base64,iVBOR") for picture in page.pictures))
        text = "\n".join(page.texts)
        record = scree.open(NET).record
        for part in ("5.3 net and 400 particles", "400 particles, 20 bodies", record["run"]["state_hash"],
                     'name = "net"', "contact force", "particle-steps per second"):
            self.assertIn(part, text)
        self.assertIsNone(re.search(r"(?:src|href)=\"(?!data:|#)", path.read_text()))
        self.assertEqual(page.links, [f"#{place}" for place in page.places])
        self.assertIn("Efforts and contact forces", text)

    def test_warnings_and_words_that_html_would_take(self):
        other = self.copy_of_the_net()
        record = (other / "run_record.json").read_text()
        (other / "run_record.json").write_text(re.sub(r'"warnings" : \[[^]]*\]', '"warnings" : ["too <b>fast</b>"]',
                                                      record))
        self.command(DONE, "report", other)
        page = (other / "report.html").read_text()
        self.assertIn('<p class="warning">too &lt;b&gt;fast&lt;/b&gt;</p>', page)
        self.assertNotIn("No warnings", page)

    def test_a_restarted_run_is_as_fast_as_its_starts_were(self):
        record, other = scree.open(NET).record, self.copy_of_the_net()
        steps, own = record["counts"]["steps"], record["starts"][0]
        record["starts"] = [own | {"steps": steps - 10, "loop_seconds": 99.0, "backend": "<old>"}, own | {"steps": 10}]
        record["total"] |= {"starts": 2, "wall_seconds": 110.0, "loop_seconds": 100.0}
        (other / "run_record.json").write_text(json.dumps(record))
        self.command(DONE, "report", other)
        for part in (f"110 s in 2 starts, {4 * steps:.3g} particle-steps per second", "Times of the last start.",
                     f"{steps - 10:,} steps in 99 s; 1 rank, &lt;old&gt;, "):
            self.assertIn(part, (other / "report.html").read_text())

    def test_of_nothing(self):
        (self.folder / "run_record.json").write_text((NET / "run_record.json").read_text())
        self.assertIn("neither history nor snapshots", self.command(WRONG, "report", self.folder))


class ProgramTest(unittest.TestCase):
    def test_the_program_runs_from_any_folder(self):
        result = subprocess.run([ROOT / "postprocess/scree-post", "compare", NET, NET], cwd="/", capture_output=True,
                                text=True)
        self.assertEqual(result.returncode, DONE, result.stderr)
        self.assertIn("the same bits", result.stdout)

    def test_help_needs_no_libraries(self):
        """So that it comes at once."""
        code = "import sys, scree.cli\ntry: scree.cli.main(['--help'])\n" \
               "except SystemExit: print([m for m in ('vtk', 'pyvista', 'matplotlib', 'pandas') if m in sys.modules])"
        result = subprocess.run([sys.executable, "-c", code], cwd=ROOT / "postprocess", capture_output=True, text=True)
        self.assertEqual(result.stdout.splitlines()[-1], "[]")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
