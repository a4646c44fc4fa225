"""Grains and clumps for decks, as the program takes them.

    SCREE=build/release/scree python3 tests/postprocess/test_packing.py

Needs postprocess/requirements.txt."""

import contextlib
import io
import os
import pathlib
import sys
import tempfile
import unittest

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

import scree
from scree import clumps, packing
from scree.cli import main

PROGRAM = os.environ["SCREE"]
SIEVES, PASSING = [1e-3, 2e-3, 4e-3], [0.0, 0.4, 1.0]
ROUND_OFF = 1e-12  # relative


def box(dimension=3, size=0.02):
    deck = scree.Deck(space={"dimension": dimension, "min": [0.0] * dimension, "max": [size] * dimension})
    deck["time.end"] = 1e-4
    deck.add("contact.pairs", stiffness=1e4)
    return deck


class FolderTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="scree_packing_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


class PackingTest(FolderTest):
    def test_a_sieve_curve_is_met(self):
        for dimension in (2, 3):
            wanted = 2e-4 if dimension == 3 else 0.4
            radii = packing.sieve_radii(SIEVES, PASSING, wanted, dimension)
            volumes = packing.volumes(radii, dimension)
            largest = packing.volumes(np.array([2e-3]), dimension)[0]
            for sieve, share in zip(SIEVES, PASSING):
                self.assertLess(abs(volumes[2 * radii < sieve].sum() - share * wanted), largest)
            middle = volumes[(2 * radii > 2e-3) & (2 * radii < np.sqrt(8) * 1e-3)].sum()  # half of the upper class
            self.assertLess(abs(middle - 0.3 * wanted), 0.03 * wanted)
        np.testing.assert_array_equal(radii, packing.sieve_radii(SIEVES, PASSING, wanted))
        for sieves, passing in (([1, 2], [0, 0.5]), ([2, 1], [0, 1]), ([1], [0]), ([1, 2, 3], [0, 1.2, 1])):
            with self.assertRaisesRegex(scree.ScreeError, "a sieve curve"):
                packing.sieve_radii(sieves, passing, 1.0)

    def check_places(self, grains, low, high):
        for k in range(len(grains)):
            apart = np.linalg.norm(grains.positions[k + 1:] - grains.positions[k], axis=1)
            self.assertTrue((apart >= grains.radii[k + 1:] + grains.radii[k]).all())
        self.assertTrue((grains.positions - grains.radii[:, None] >= low).all())
        self.assertTrue((grains.positions + grains.radii[:, None] <= high).all())

    def test_a_graded_sample_is_a_deck_s(self):
        low, high = [0.0] * 3, [0.02] * 3
        grains = packing.graded(SIEVES, PASSING, low, high, fraction=0.3)
        self.check_places(grains, low, high)
        self.assertLess(abs(grains.volume / 0.02**3 - 0.3), 0.01)
        for name in ("grains.csv", "grains.h5"):
            deck = box()
            deck.folder = self.folder
            deck.add("particles", name="grains", density=2650.0, **grains.write(self.folder / name))
            self.assertIn(f"particles      {len(grains)},", deck.check(PROGRAM))
        for corners, dimension in ((([0] * 3, [0.05] * 3), 3), (([0] * 2, [0.2] * 2), 2)):
            self.assertLess(abs(len(packing.graded(SIEVES, PASSING, *corners, count=1000)) / 1000 - 1), 0.05)
        with self.assertRaisesRegex(scree.ScreeError, "either fraction or count"):
            packing.graded(SIEVES, PASSING, low, high)
        discs = packing.graded([0.01, 0.02], [0, 1], [0, 0], [0.2, 0.2], fraction=0.4)
        self.check_places(discs, [0, 0], [0.2, 0.2])
        flat = box(2, 0.2)
        flat.add("particles", density=2650.0, **discs.write(self.folder / "discs.csv"))
        flat.check(PROGRAM)
        for count, dimension, share in ((200, 3, 0.28), (200, 2, 0.48)):
            radius = (share / count / packing.volumes(np.ones(1), dimension)[0]) ** (1 / dimension)
            self.assertEqual(len(packing.place([radius] * count, [0] * dimension, [1] * dimension)), count)
        with self.assertRaisesRegex(scree.ScreeError, r"positions for \d+ of \d+ particles, which fill 0\.\d+ of"):
            packing.place([0.1] * 100, [0, 0, 0], [1, 1, 1], tries=200)
        with self.assertRaisesRegex(scree.ScreeError, "smaller than the largest"):
            packing.place([0.1], [0, 0], [0.1, 1])

    def test_layers(self):
        curves = ((SIEVES, PASSING), ([1e-3, 2e-3], [0, 1]))
        below, above = packing.layers([0, 0, 0], [0.02] * 3, [0.008, 0.012], curves, 0.2)
        self.check_places(below, [0, 0, 0], [0.02, 0.02, 0.008])
        self.check_places(above, [0, 0, 0.008], [0.02, 0.02, 0.02])
        self.assertLess(above.radii.max(), 1e-3)
        self.assertEqual(len(below + above), len(below) + len(above))

    def test_what_a_run_has_left_begins_another(self):
        deck = box(2, 1.0)
        deck["gravity"] = [0.0, -9.81]
        deck["time"] = {"end": 0.02, "step": 1e-3, "control": "fixed"}
        deck["contact.mixing"] = "geometric"
        deck["contact.pairs"] = [{"materials": [name, name], "stiffness": 1e4} for name in ("sand", "ore")]
        deck["materials"] = [{"name": "sand", "density": 2650.0}, {"name": "ore", "density": 4000.0}]
        deck["output.fields"] = ["radius", "velocity", "material"]
        for k, name in enumerate(("ore", "sand")):
            deck.add("particles", name=name, kind="row", origin=[0.1, 0.3 + 0.3 * k], spacing=[0.2, 0.0], count=3,
                     radius=0.05, material=name)
        run = deck.run(self.folder / "first", quiet=True, scree=PROGRAM)
        tables = packing.settled(run, self.folder / "settled")
        self.assertEqual([table["material"] for table in tables], ["sand", "ore"])
        later = deck.copy()
        later["particles"] = tables
        again = later.run(self.folder / "second", quiet=True, scree=PROGRAM)
        last, first = run.snapshots[-1].particles, again.snapshots[0].particles
        for name in ("position", "velocity", "radius", "material"):
            np.testing.assert_array_equal(first[name], last[name][[3, 4, 5, 0, 1, 2]], name)
        np.testing.assert_array_equal(again.history["energy/kinetic"][0], run.history["energy/kinetic"][-1])
        with h5py.File(self.folder / "settled/settled_ore.h5") as file:
            self.assertEqual(sorted(file), ["radius", "vx", "vy", "x", "y"])
        for fields, said in ((["velocity", "material"], "no radius"), (["radius", "velocity"], "no material")):
            deck["output.fields"] = fields
            run = deck.run(self.folder / "first", "--overwrite", quiet=True, scree=PROGRAM)
            with self.assertRaisesRegex(scree.ScreeError, said):
                packing.settled(run, self.folder)


    def test_spins_go_along(self):
        """Of grains that roll, by fields of the snapshots or else by the checkpoint at the end, in 2D and 3D."""
        for dimension, fields in ((2, ["radius", "velocity"]), (3, ["radius", "velocity"]),
                                  (3, ["radius", "velocity", "angular_velocity", "mass"])):
            deck = box(dimension, 1.0)
            deck["gravity"] = [0.0] * (dimension - 1) + [-9.81]
            deck["time"] = {"end": 0.02, "step": 1e-3, "control": "fixed"}
            deck["contact.pairs"] = [{"stiffness": 1e4, "friction": 0.5}]
            deck["output"] = {"fields": fields, "snapshot_interval": 0.01}
            spin = [7.0] if dimension == 2 else [1.0, 2.0, 3.0]
            deck.add("particles", name="grains", kind="row", origin=[0.2] * dimension, count=3, mass=0.1,
                     spacing=[0.15] + [0.0] * (dimension - 1), radius=0.05, angular_velocity=spin, inertia_factor=0.3)
            run = deck.run(self.folder / f"first_{dimension}", "--overwrite", quiet=True, scree=PROGRAM)
            later = deck.copy()
            later["particles"] = packing.settled(run, self.folder / "settled")
            self.assertEqual(later["particles"][0]["inertia_factor"], 0.3)
            later["output.fields"] = ["angular_velocity"]
            again = later.run(self.folder / "second", "--overwrite", quiet=True, scree=PROGRAM)
            found = again.snapshots[0].particles["angular_velocity"].values
            np.testing.assert_array_equal(found, [[0.0, 0.0, 7.0] if dimension == 2 else spin] * 3)
            np.testing.assert_array_equal(again.history["rotation/kinetic"][0], run.history["rotation/kinetic"][-1])
            if "mass" not in fields:
                with self.assertWarnsRegex(scree.ScreeWarning, "spins are lost"):
                    packing.settled(run, self.folder / "settled", 1)


    def test_the_command(self):
        deck = box(2, 1.0)
        deck["gravity"] = [0.0, -9.81]
        deck["time"] = {"end": 0.02, "step": 1e-3, "control": "fixed"}
        deck["contact.pairs"] = [{"stiffness": 1e4, "friction": 0.5}]
        deck.add("particles", name="grains", kind="row", origin=[0.2, 0.2], count=3, mass=0.1, spacing=[0.15, 0.0],
                 radius=0.05, angular_velocity=[7.0])
        deck.run(self.folder / "first", quiet=True, scree=PROGRAM)
        with contextlib.redirect_stdout(io.StringIO()) as said:
            self.assertEqual(main(["settle", str(self.folder / "first")]), 0)
        tables = scree.Deck.read(said.getvalue().strip())
        self.assertEqual(tables.folder, self.folder / "first/settled")
        self.assertEqual(tables["particles.0.file"], "settled_default.h5")
        del deck["particles"]
        (tables.folder / "deck.toml").write_text(f"{deck}\n{tables}", encoding="utf-8")
        again = scree.Deck.read(tables.folder / "deck.toml").run(self.folder / "second", quiet=True, scree=PROGRAM)
        np.testing.assert_array_equal(again.history["rotation/kinetic"][0],
                                      scree.open(self.folder / "first").history["rotation/kinetic"][-1])


class ClumpTest(FolderTest):
    def test_spheres_apart_are_exact(self):
        body = clumps.clump("pair", [[0, 0, 0], [3, 0, 0]], [1, 1], density=2.0, position=[0, 0, 0])
        mass = 2.0 * 4 / 3 * np.pi
        np.testing.assert_allclose((body["mass"], *body["center_of_mass"]), (2 * mass, 1.5, 0, 0), rtol=ROUND_OFF)
        along, across = 2 * 0.4 * mass, 2 * (0.4 + 1.5**2) * mass
        np.testing.assert_allclose(body["inertia_tensor"], [along, across, across, 0, 0, 0], rtol=ROUND_OFF, atol=1e-12)
        disc = clumps.clump("disc", [[1, 2]], [0.5], mass=3.0, position=[0, 0])
        np.testing.assert_allclose((disc["mass"], disc["inertia"]), (3.0, 3.0 * 0.125), rtol=ROUND_OFF)

    def test_what_two_cover_counts_once(self):
        """Two unit spheres at distance 1 share a lens of 5 pi / 12, unit discs 2 pi / 3 - sqrt(3) / 2."""
        for turn in ([1.0, 0, 0], [0, 0.6, 0.8]):
            body = clumps.clump("pair", [[0, 0, 0], turn], [1, 1], density=1.0, position=[0, 0, 0])
            np.testing.assert_allclose(body["mass"], (8 / 3 - 5 / 12) * np.pi, rtol=1e-4)
            np.testing.assert_allclose(body["center_of_mass"], np.array(turn) / 2, atol=1e-4)
        turned = np.linalg.eigvalsh(clumps.moments(np.array([[0.0, 0, 0], [0, 0.6, 0.8]]), np.ones(2))[2])
        straight = np.linalg.eigvalsh(clumps.moments(np.array([[0.0, 0, 0], [1, 0, 0]]), np.ones(2))[2])
        np.testing.assert_allclose(turned, straight, rtol=2e-4)
        inside = clumps.clump("one", [[0, 0, 0], [0.1, 0, 0]], [1, 0.5], density=1.0, position=[0, 0, 0])
        ball = 4 / 3 * np.pi
        np.testing.assert_allclose(inside["inertia_tensor"], [0.4 * ball] * 3 + [0] * 3, rtol=2e-4, atol=1e-10)
        flat = clumps.clump("pair", [[0, 0], [1, 0]], [1, 1], density=1.0, position=[0, 0])
        np.testing.assert_allclose(flat["mass"], 2 * np.pi - (2 * np.pi / 3 - np.sqrt(3) / 2), rtol=1e-6)

    def test_bodies_of_a_deck(self):
        deck = box(3, 1.0)
        for k, x in enumerate((0.2, 0.5)):
            deck.add("bodies", **clumps.clump(f"grain_{k}", [[0, 0, 0], [0.05, 0, 0.02]], [0.05, 0.04], density=2650.0,
                                              position=[x, 0.5, 0.5], rotation_axis=[0, 1, 0], rotation_angle=1.0))
        self.assertIn("bodies         2 with 4 shapes", deck.check(PROGRAM))
        flat = box(2, 1.0)
        flat.add("bodies", **clumps.clump("grain", [[0, 0], [0.05, 0]], [0.05, 0.04], mass=1.0, position=[0.5, 0.5]))
        flat.check(PROGRAM)
        for arguments, said in ((([[0, 0]], [1, 2]), "a radius above 0 for each"),
                                (([[0, 0]], [-1]), "a radius above 0"), (([0, 0], [1, 1]), "points of 2 or 3")):
            with self.assertRaisesRegex(scree.ScreeError, said):
                clumps.clump("x", *arguments, density=1.0, position=[0, 0])
        with self.assertRaisesRegex(scree.ScreeError, "a density or a mass"):
            clumps.clump("x", [[0, 0]], [1], position=[0, 0])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
