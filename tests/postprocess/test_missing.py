"""Runs that lack files, fields, bodies or particles: each command ends well, or says in one line what is missing.

    SCREE=build/release/scree python3 tests/postprocess/test_missing.py

Needs postprocess/requirements.txt."""

import contextlib
import io
import os
import pathlib
import shutil
import sys
import tempfile
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

import scree
from scree.cli import main

PROGRAM = os.environ["SCREE"]
SNAPSHOTS = [f"{kind}.vtkhdf" for kind in ("particles", "bodies", "surfaces", "contacts", "links")]
FILES = {"particles": SNAPSHOTS[:1], "bodies": SNAPSHOTS[1:2], "links": SNAPSHOTS[4:], "surfaces": SNAPSHOTS[2:3],
         "history": ["history.h5"], "record": ["run_record.json"], "snapshots": SNAPSHOTS,
         "deck": ["run_record.json", "checkpoint.h5", "checkpoint_end.h5"], "results": [*SNAPSHOTS, "history.h5"]}
PICTURES = {"picture": ["picture", "RUN", "--no-vtk"], "color": ["picture", "RUN", "--no-vtk", "--color", "group"],
            "animate": ["animate", "RUN", "--no-vtk", "--frames", "2", "-o", "OUT/film.gif"],
            "draw": ["draw", "RUN", "--no-vtk", "--no-animation"]}
COMMANDS = {**PICTURES, "plot": ["plot", "RUN"], "list": ["plot", "RUN", "--list"],
            "compare": ["compare", "RUN", "WHOLE"], "paraview": ["paraview", "RUN"],
            "settle": ["settle", "RUN", "-o", "OUT/settled"], "thin": ["thin", "RUN", "-o", "OUT/thin"],
            "report": ["report", "RUN", "--no-vtk"],
            **{form: ["export", "RUN", "--format", form, "-o", f"OUT/{form}"]
               for form in ("csv", "vtp", "vtu", "ply", "stl")}}


def deck(dimension, particles=True, bodies=True, shapes=True, **output):
    flat = dimension == 2
    found = scree.Deck(gravity=[0.0] * (dimension - 1) + [-9.81],
                       space={"dimension": dimension, "min": [-1.0] * dimension, "max": [1.0] * dimension,
                              "y_min" if flat else "z_min": "wall"},
                       time={"end": 0.002, "step": 1e-3, "control": "fixed"})
    found["output"] = {"snapshot_interval": 0.001, **output}
    found.add("contact.pairs", stiffness=1e4, restitution=0.5)
    if bodies:
        table = {"name": "rod", "position": [0.1] + [0.0] * (dimension - 1), "mass": 1.0}
        table |= {"inertia": 0.1} if flat else {"kind": "spatial", "inertia_tensor": [0.1, 0.1, 0.1, 0, 0, 0]}
        if shapes and flat:
            table["shapes"] = [{"radius": 0.05}]
        elif shapes:
            found.add("meshes", name="box", kind="box", size=[0.3, 0.3, 0.1])
            table["meshes"] = [{"mesh": "box"}]
        found.add("bodies", **table)
        found.add("joints", name="pin", type="revolute", bodies=["ground", "rod"], point=[0.0] * dimension,
                  **({} if flat else {"axis": [0.0, 1.0, 0.0]}))
    if particles:
        found.add("particles", name="grains", kind="lattice", origin=[-0.5] * dimension, spacing=[0.1] * dimension,
                  size=[3, 2, 1][:dimension], radius=0.025, mass=0.01)
    return found


class MissingTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="scree_missing_")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        decks = {"flat": deck(2, contacts=True), "deep": deck(3), "no_particles": deck(2, particles=False),
                 "no_bodies": deck(2, bodies=False), "no_shapes": deck(2, particles=False, shapes=False),
                 "no_links": deck(2, links=False), "no_fields": deck(2, fields=[]),
                 "no_fields_deep": deck(3, fields=[], surface_fields=[]), "radii": deck(2, fields=["radius"]),
                 "velocities": deck(3, fields=["velocity"])}
        for name, each in decks.items():
            each.run(cls.folder / name, quiet=True, scree=PROGRAM)

    def command(self, run, words):
        """Exit code and lines of what it says."""
        said, out = io.StringIO(), self.folder / "out"
        out.mkdir(exist_ok=True)
        places = {"RUN": str(run), "WHOLE": str(self.folder / "flat")}
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            code = main([places.get(word, word.replace("OUT", str(out))) for word in words])
        return code, said.getvalue().splitlines()

    def without(self, name, files):
        copy = self.folder / "copy"
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(self.folder / name, copy)
        for file in files:
            (copy / file).unlink(missing_ok=True)
        return copy

    def ends_well(self, run, refused, name, commands=tuple(COMMANDS)):
        """Each command but the refused ones, which say why in one line."""
        for command, words in ((command, COMMANDS[command]) for command in commands):
            with self.subTest(run=name, command=command):
                code, lines = self.command(run, words)
                errors = [line for line in lines if line.startswith("error: ")]
                if command in refused:
                    self.assertEqual((code, len(errors)), (2, 1), lines)
                else:
                    self.assertIn(code, (0, 1) if command == "compare" else (0,), lines)
                    self.assertEqual(errors, [])

    def test_what_the_deck_has_not(self):
        films = {*PICTURES, "settle"}
        for name, refused in {"flat": set(), "deep": set(), "no_particles": {"settle"}, "no_bodies": set(),
                              "no_shapes": {"ply", "stl", "settle"}, "no_links": set(), "no_fields": films | {"thin"},
                              "no_fields_deep": films | {"thin"}, "radii": films,
                              "velocities": films | {"thin"}}.items():
            self.ends_well(self.folder / name, refused, name)

    def test_files_that_are_not_there(self):
        films, forms = {*PICTURES, "settle", "thin"}, {"vtp", "vtu", "ply", "stl"}
        refused = {"particles": films, "history": {"plot"}, "record": {"thin"},
                   "snapshots": films | {"paraview"} | forms, "deck": films,
                   "results": films | {"plot", "paraview", "report", "csv"} | forms}
        for missing, files in FILES.items():
            name = "deep" if missing == "surfaces" else "flat"
            self.ends_well(self.without(name, files), refused.get(missing, set()), f"{name} without {missing}",
                           [command for command in COMMANDS if command not in ("animate", "color", "vtu")])

    def test_a_run_without_particles_vtkhdf_is_opened(self):
        run = scree.open(self.without("flat", FILES["particles"]))
        self.assertEqual(len(run.snapshots), 3)
        np.testing.assert_allclose(run.snapshots.times, [0, 0.001, 0.002])
        self.assertEqual((run.snapshots[-1].time, run.body_names), (0.002, ["rod"]))
        self.assertEqual((run.material_names, run.group_names), ([], []))
        self.assertEqual(run.snapshots[-1].bodies.count, 2)
        with self.assertRaisesRegex(scree.ScreeError, "the run has no particles.vtkhdf"):
            run.snapshots[-1].particles
        self.assertEqual(len(run.snapshots.at(0.001).to_pyvista()), 3)

    def test_a_report_says_why_it_has_no_picture(self):
        for name, files, said in (("radii", [], "particles have no field velocity"),
                                  ("flat", FILES["particles"], "holds no particles.vtkhdf, which pictures need"),
                                  ("flat", FILES["deck"], "there is no deck yet")):
            copy = self.without(name, files)
            self.assertEqual(self.command(copy, COMMANDS["report"])[0], 0)
            page = (copy / "report.html").read_text(encoding="utf-8")
            self.assertRegex(page, f'<p class="warning">No picture: .*{said}')
            self.assertIn('<h2 id="energy">', page)

    def test_what_is_exported_of_the_rest(self):
        out = self.folder / "out"
        shutil.rmtree(out, ignore_errors=True)
        code, lines = self.command(self.folder / "velocities", COMMANDS["stl"])
        self.assertEqual((code, len(lines)), (0, 2))
        self.assertRegex(lines[0], "^warning: particles.stl: left out: no field radius; there are position, ")
        self.assertEqual({path.name.split("_")[0] for path in (out / "stl").iterdir()}, {"surfaces"})
        code, lines = self.command(self.folder / "no_shapes", COMMANDS["ply"])
        self.assertEqual(code, 2)
        self.assertRegex(lines[-1], "no snapshot can be written as ply: there are neither meshes nor spheres")

    def test_a_file_is_no_run(self):
        for name in ("particles.vtkhdf", "run_record.json"):
            code, lines = self.command(self.folder / "flat" / name, COMMANDS["plot"])
            self.assertEqual((code, len(lines)), (2, 1))
            self.assertIn(f"{name}: is a file; a run is opened by its folder, here {self.folder}", lines[0])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
