"""Calibration: what is measured, on states with known values; the search, on known functions; the commands, on tiny
decks.

    SCREE=build/release/scree python3 tests/postprocess/test_calibration.py

Needs postprocess/requirements.txt."""

import contextlib
import csv
import io
import os
import pathlib
import re
import sys
import tempfile
import threading
import tomllib
import types
import unittest
import unittest.mock

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

import scree
from scree.calibration import materials, runs, scaling, search, surface, tests
from scree.cli import INTERRUPTED, main
from scree.commands.calibrate import parameter, setting, target
from scree.schema import problems

PROGRAM = os.environ["SCREE"]
DECKS = ROOT / "input/calibration"
SAND = ROOT / "input/materials/sand.toml"
DONE, NOT_MET, WRONG = 0, 1, 2
DEGREE, ONE_PERCENT = 1.0, 0.01


def grains_below(slope, rng, depth=5.0, length=20.0):
    """A jittered lattice of spheres of diameter 1 between x = 0 and `length` and below a plane of this slope through
    the middle at z = 12."""
    x, y, z = np.meshgrid(np.arange(-2, length + 2, 0.95), np.arange(0, depth, 0.95), np.arange(0, 26, 0.95),
                          indexing="ij")
    positions = np.column_stack([x.ravel(), y.ravel(), z.ravel()]) + rng.uniform(-0.3, 0.3, (x.size, 3))
    inside = positions[:, 2] < 12 + slope * (positions[:, 0] - length / 2)
    return positions[inside], np.full(inside.sum(), 0.5)


class SurfaceTest(unittest.TestCase):
    def test_angle_of_a_known_plane(self):
        rng = np.random.default_rng(5)
        for angle in (-35, 0, 10, 25, 40):
            slope = np.tan(np.radians(angle))
            found = surface.find([grains_below(slope, rng) for _ in range(3)], 2.0, 18.0)
            self.assertAlmostEqual(found.angle, abs(angle), delta=DEGREE)
            self.assertEqual(np.sign(found.slope), np.sign(round(angle, -1)) if angle else np.sign(found.slope))
            self.assertLess(found.deviation, 0.3)

    def test_height_is_that_of_the_grains(self):
        found = surface.find([grains_below(0.0, np.random.default_rng(2))], 2.0, 18.0)
        self.assertAlmostEqual(found.start, 12.0, delta=0.5)

    def test_single_grains_in_the_air_do_not_count(self):
        positions, radii = grains_below(0.3, np.random.default_rng(3))
        airborne = np.vstack([positions, [[10.0, 2.0, 25.0], [11.0, 2.0, 24.0]]])
        with_them = surface.find([(airborne, np.full(len(airborne), 0.5))], 2.0, 18.0)
        self.assertAlmostEqual(with_them.angle, surface.find([(positions, radii)], 2.0, 18.0).angle, delta=0.3)

    def test_nothing_has_no_surface(self):
        self.assertIsNone(surface.find([(np.zeros((0, 3)), np.zeros(0))], 0.0, 1.0))
        self.assertIsNone(surface.find([(np.array([[50.0, 0, 0]]), np.array([0.5]))], 0.0, 10.0))

    def test_points_fill_a_ball_evenly(self):
        points = surface.points_in_a_ball()
        self.assertLess(np.linalg.norm(points.mean(axis=0)), 0.05)
        self.assertAlmostEqual((points**2).sum(axis=1).mean(), 3 / 5, delta=0.02)


class ScalingTest(unittest.TestCase):
    def test_units(self):
        factors = scaling.Factors(2.0, 3.0, 5.0)
        for unit, factor in (("m", 2), ("kg m^2", 20), ("m/s", 2 / 3), ("N", 10 / 9), ("Pa", 5 / 18), ("N s/m", 5 / 3),
                             ("kg/m^3", 5 / 8), ("rad/s", 1 / 3), ("Hz", 1 / 3), ("1", 1), ("N/m/s", 5 / 27)):
            self.assertAlmostEqual(factors.of(unit), factor, msg=unit)
        with self.assertRaisesRegex(scree.ScreeError, "N/m\\^n cannot be scaled"):
            factors.of("N/m^n")

    def test_every_deck_keeps_its_values_with_factors_of_1_and_stays_right_with_others(self):
        for path in sorted(DECKS.glob("*.toml")):
            tables = tomllib.loads(path.read_text())
            self.assertEqual(scaling.scaled_deck(tables, scaling.Factors(1.0, 1.0, 1.0)), tables)
            self.assertEqual(problems(scaling.scaled_deck(tables, scaling.Factors(3.0, 2.0, 0.5))), [])

    def test_functions_of_time_have_the_unit_of_their_key(self):
        gate = scaling.scaled_deck(tomllib.loads((DECKS / "angle_of_repose.toml").read_text()),
                                   scaling.Factors(4.0, 2.0, 64.0))
        motion = gate["walls"][0]["motions"][0]
        self.assertEqual(motion["direction"], [1.0, 0.0, 0.0])
        self.assertAlmostEqual(motion["displacement"]["rate"], 0.3)  # m/s
        self.assertAlmostEqual(motion["displacement"]["start"], 0.4)  # s
        shear = scaling.scaled_deck(tomllib.loads((DECKS / "direct_shear.toml").read_text()),
                                    scaling.Factors(4.0, 2.0, 64.0))
        self.assertAlmostEqual(shear["drivers"][0]["motion"]["rate"], 0.08)  # of a displacement
        self.assertAlmostEqual(shear["joint_springs"][0]["damping"], 153.6)  # N s/m
        self.assertAlmostEqual(shear["bodies"][0]["shapes"][0]["radius"], 0.004)
        self.assertEqual(shear["bodies"][0]["shapes"][0]["size"], [12, 8, 1])
        drum = scaling.scaled_deck(tomllib.loads((DECKS / "rotating_drum.toml").read_text()),
                                   scaling.Factors(4.0, 2.0, 64.0))
        self.assertAlmostEqual(drum["walls"][0]["motions"][0]["angle"]["rate"], 1.0)  # rad/s: the same Froude number


class MaterialsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="scree_calibration_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_grains_of_every_materials_file(self):
        for path in sorted((ROOT / "input/materials").glob("*.toml")):
            grains = materials.read(path)
            for name, test in tests.TESTS.items():
                stresses = tests.stresses_of(test, grains) or [None]
                base = scree.Deck.read(DECKS / f"{test.deck}.toml")
                deck = tests.deck_for(test, base, grains, 3, stresses[-1])
                self.assertEqual(deck.problems(), [], f"{path}, {name}")
                self.assertEqual(deck["particles.grains.seed"], 3)
                if test.stress:
                    self.assertAlmostEqual(test.stress(deck.to_dict()) / stresses[-1], 1.0)
                laws = {tuple(each["materials"]): each for each in deck.to_dict()["contact"]["pairs"]}
                self.assertEqual(laws["grain", "grain"]["friction"], grains.pair["friction"])
                self.assertEqual(laws["grain", "rough"].get("work_of_adhesion"), grains.pair.get("work_of_adhesion"))
                self.assertNotIn("friction", laws.get(("grain", "smooth"), {}))

    def test_radius_of_the_mean_volume(self):
        rng = np.random.default_rng(1)
        for radius, sample in (({"kind": "uniform", "min": 0.5, "max": 1.5}, rng.uniform(0.5, 1.5, 400000)),
                               ({"kind": "normal", "mean": 1.0, "sd": 0.1, "min": 0.1, "max": 2.0},
                                rng.normal(1.0, 0.1, 400000)),
                               ({"kind": "table", "values": [1.0, 2.0], "weights": [3, 1]}, [1.0, 1.0, 1.0, 2.0]),
                               ({"kind": "table", "by": "mass", "values": [1.0, 2.0]}, [1.0] * 8 + [2.0]),
                               ({"kind": "lognormal", "by": "number", "median": 1.0, "geometric_sd": 1.2, "min": 0.1,
                                 "max": 10.0}, np.exp(rng.normal(0.0, np.log(1.2), 400000))),
                               ({"kind": "lognormal", "by": "mass", "median": 1.0, "geometric_sd": 1.2, "min": 0.1,
                                 "max": 10.0}, np.exp(rng.normal(-3 * np.log(1.2) ** 2, np.log(1.2), 400000))),
                               ({"kind": "rosin_rammler", "by": "number", "scale": 1.0, "exponent": 3.0, "min": 0.001,
                                 "max": 10.0}, rng.weibull(3.0, 400000))):
            expected = np.mean(np.array(sample) ** 3) ** (1 / 3)
            self.assertAlmostEqual(materials.mean_radius(radius, "deck") / expected, 1.0, delta=ONE_PERCENT)
        self.assertEqual(materials.mean_radius(0.25, "deck"), 0.25)

    def test_softer(self):
        grains = materials.read(ROOT / "input/materials/powder.toml")
        soft = materials.softened(grains, 0.01)
        self.assertAlmostEqual(soft.material["young_modulus"], 0.01 * grains.material["young_modulus"])
        self.assertEqual(soft.pair["work_of_adhesion"], grains.pair["work_of_adhesion"])  # the same pull-off force
        plastic = materials.Grains("soil", grains.material, grains.pair | {"plasticity_ratio": 0.5}, 0.001, 1.0)
        self.assertAlmostEqual(materials.softened(plastic, 0.001).pair["work_of_adhesion"],
                               0.1 * grains.pair["work_of_adhesion"])
        self.assertEqual(soft.pair["friction"], grains.pair["friction"])

    def test_values_of_a_search(self):
        grains = materials.read(SAND, {"friction": 0.7, "materials.sand.density": 2000.0})
        self.assertEqual((grains.pair["friction"], grains.density), (0.7, 2000.0))

    def test_files_without_grains(self):
        text = SAND.read_text()
        for old, new, message in (("dimension = 3", "dimension = 2", "three dimensions"),
                                  ('material = "sand"', 'material = "mud"', "particles.0.material: must name"),
                                  ("density = 2650.0", "", "materials.sand.density: must be a number above 0"),
                                  ('materials = ["sand", "sand"]', 'materials = ["sand", "mud"]', 'none is of "sand"')):
            path = self.folder / "other.toml"
            path.write_text(text.replace(old, new))
            with self.assertRaisesRegex(scree.ScreeError, message):
                materials.read(path)


class Columns(dict):
    """A history."""
    @property
    def time(self):
        return self["time"]


class MeasureTest(unittest.TestCase):
    def test_lines_through_three_stresses(self):
        values = [{"normal": each, "peak": 20 + 0.8 * each, "residual": 0.5 * each} for each in (100.0, 200.0, 400.0)]
        found = tests.combine_shear(values)
        for name, expected in (("peak_angle", np.degrees(np.arctan(0.8))), ("peak_cohesion", 20.0),
                               ("residual_angle", np.degrees(np.arctan(0.5))), ("residual_cohesion", 0.0)):
            self.assertAlmostEqual(found[name], expected, places=6)
        self.assertAlmostEqual(tests.combine_shear(values[:1])["residual_angle"], np.degrees(np.arctan(0.5)))

    def run_of(self, deck, columns, radius=0.001):
        """What the measurements read of a run."""
        state = types.SimpleNamespace(particles={"radius": np.full(3, radius)})
        return types.SimpleNamespace(deck=tomllib.loads((DECKS / f"{deck}.toml").read_text()), folder="run",
                                     history=Columns(columns), snapshots=[state])

    def test_peak_and_residual_shear_stress(self):
        time = np.linspace(0, 0.5, 1001)
        moved = np.maximum(0, 0.04 * (time - 0.15))
        share = moved / moved[-1]
        stress = 1000 * (1 - np.exp(-50 * share)) + 300 * np.exp(-(((share - 0.2) / 0.05) ** 2))
        area = 0.024 * 0.016
        found = tests.measure_shear(self.run_of("direct_shear", {
            "time": time, "coordinates/rail/displacement": moved, "contacts/upper/fx": -stress * area,
            "contacts/upper/fz": np.full(1001, 2000 * area)}))
        for name, expected in (("normal", 2000.0), ("peak", 1300.0), ("residual", 1000.0)):
            self.assertAlmostEqual(found[name] / expected, 1.0, delta=ONE_PERCENT)

    def test_strength_of_a_column(self):
        time, area = np.linspace(0, 0.6, 601), 0.014**2
        compression = np.maximum(0, time - 0.28)  # of a column of 25 mm, 32 % at the end
        stress = np.where(time <= 0.15, 2500.0, np.maximum(0, 700 - 1e5 * (compression - 0.08) ** 2))
        stress = np.where(compression > 0.25, 5000.0, stress)  # on the rubble
        found = tests.measure_column(self.run_of("uniaxial", {
            "time": time, "contacts/platen/fz": stress * area,
            "coordinates/guide/displacement": -0.025 - 0.025 * compression}))
        self.assertAlmostEqual(found["consolidation"], 2500.0, delta=1.0)
        self.assertAlmostEqual(found["strength"], 700.0, delta=5.0)
        self.assertEqual(found["failed"], 1.0)
        both = tests.combine_column([found, {"consolidation": 5000.0, "strength": 1000.0}])
        self.assertEqual(both["strength"], 1000.0)
        self.assertAlmostEqual(both["strength_ratio"], 0.5 * (0.28 + 0.2), delta=0.01)


class SearchTest(unittest.TestCase):
    def points_of(self, *functions, noise=0.0):
        rng = np.random.default_rng(7)
        self.count, self.told = 0, []

        def measure(shares):
            self.count += 1
            return search.Point(shares, tuple(each(*shares) + noise * rng.normal() for each in functions),
                                (noise,) * len(functions))
        return measure

    def angle(self, x, y):
        return 15 + 20 * (1 - np.exp(-3 * x)) + 8 * y

    def strength(self, x, y):
        return 20 + 5 * x + 25 * y * y

    def test_two_targets_pick_a_point(self):
        wished = 0.37, 0.62
        targets = [search.Target("repose", "angle", self.angle(*wished)),
                   search.Target("drum", "angle", self.strength(*wished))]
        found = search.search(targets, self.points_of(self.angle, self.strength), self.told.append, 4)
        self.assertEqual(self.told, found.points)
        self.assertTrue(found.met)
        self.assertLessEqual(self.count, 13)
        np.testing.assert_allclose(found.best.shares, wished, atol=0.06)
        self.assertEqual(found.curve, [])

    def test_one_target_leaves_a_curve(self):
        targets = [search.Target("repose", "angle", 32.0)]
        found = search.search(targets, self.points_of(self.angle, noise=0.4), self.told.append, 4)
        self.assertTrue(found.met)
        self.assertGreaterEqual(len(found.curve), 2)
        for shares in found.curve:
            self.assertAlmostEqual(self.angle(*shares), 32.0, delta=2.5)

    def test_a_set_that_meets_by_chance(self):
        by_chance = (0.0, 1.0)  # 25 in place of 23 degrees
        found = search.search([search.Target("repose", "angle", 25.0)], self.points_of(
            lambda x, y: 25.0 if (x, y) == by_chance else self.angle(x, y), noise=0.4), self.told.append, 4)
        self.assertTrue(found.met)
        self.assertNotEqual(found.best.shares, by_chance)
        self.assertAlmostEqual(self.angle(*found.best.shares), 25.0, delta=1.5)

    def test_a_set_with_a_wide_spread_does_not_meet(self):
        def measure(shares):
            wide = shares == (0.0, 1.0)  # a mean on the target, of runs that are far from it
            return search.Point(shares, (40.0 if wide else self.angle(*shares),), (6.0 if wide else 0.4,))

        found = search.search([search.Target("repose", "angle", 40.0)], measure, lambda point: None, 4)
        self.assertNotEqual(found.best.shares, (0.0, 1.0))
        self.assertAlmostEqual(self.angle(*found.best.shares), 40.0, delta=1.5)

    def test_a_target_out_of_reach(self):
        found = search.search([search.Target("repose", "angle", 60.0)], self.points_of(self.angle), self.told.append, 3)
        self.assertFalse(found.met)
        self.assertEqual(found.best.shares, (1.0, 1.0))

    def test_words(self):
        self.assertEqual(parameter("friction=0.2:0.8"), search.Parameter("friction", 0.2, 0.8))
        self.assertEqual(search.Parameter("friction", 0.2, 0.8).at(1 / 3), 0.4)
        self.assertEqual(target("shear=28"), search.Target("shear", "residual_angle", 28.0))
        self.assertEqual(target("shear.peak_angle=35").name, "shear.peak_angle")
        self.assertEqual(setting("time.end=0.5"), ("time.end", 0.5))
        self.assertEqual(setting("particles.grains.radius={kind='constant',value=1.0}")[1]["kind"], "constant")


class CommandTest(unittest.TestCase):
    QUICK = ["--soften", "1e-3", "--program", PROGRAM, "--backend", "cpu"]

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="scree_calibration_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def command(self, code, *words):
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            try:
                found = main(["calibrate", *map(str, words)])
            except SystemExit as stop:
                found = stop.code
        self.assertEqual(found, code, said.getvalue())
        return said.getvalue()

    def test_a_slope_with_its_spread(self):
        words = ["repose", SAND, "--seeds", "2", *self.QUICK, "-o", self.folder / "repose", "--set",
                 "particles.grains.count=250", "time.end=0.4"]
        said = self.command(DONE, *words)
        self.assertRegex(said, r"(?m)^angle: \d+(\.\d+)? \+- \d+(\.\d+)? degrees \(2 seeds\)$")
        with open(self.folder / "repose/measured.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["run"] for row in rows], ["seed_1", "seed_2"])
        self.assertTrue(all(0 <= float(row["angle"]) < 50 for row in rows), rows)
        self.assertGreater((self.folder / "repose/measured.png").stat().st_size, 10000)
        record = self.folder / "repose/seed_2/run_record.json"
        stamp = record.stat().st_mtime_ns
        self.assertEqual(self.command(DONE, *words), said)  # finished runs are not repeated
        self.assertEqual(record.stat().st_mtime_ns, stamp)

    def test_shear_at_two_stresses(self):
        said = self.command(DONE, "shear", SAND, "--seeds", "1", *self.QUICK, "-o", self.folder, "--stresses", "2000",
                            "4000", "--set", "particles.grains.count=150", "time.end=0.3")
        self.assertRegex(said, r"(?m)^residual angle: -?\d+(\.\d+)? degrees \(1 seed\)$")
        self.assertRegex(said, r"(?m)^ +1 +\d+ +\d+ +\d+$")
        self.assertTrue((self.folder / "seed_1/stress_2/run_record.json").exists())

    def test_drum_and_uniaxial_compression(self):
        said = self.command(DONE, "drum", SAND, "--seeds", "1", *self.QUICK, "-o", self.folder / "drum", "--set",
                            "time.end=0.1", "particles.grains.count=200")
        self.assertRegex(said, r"(?m)^angle: \d+")
        said = self.command(DONE, "uniaxial", ROOT / "input/materials/powder.toml", "--seeds", "1", "--soften", "1e-3",
                            "--program", PROGRAM, "--stresses", "100", "-o", self.folder / "uniaxial", "--set",
                            "particles.grains.count=60")
        self.assertRegex(said, r"(?m)^strength: \d+(\.\d+)? Pa \(1 seed\)$")

    def test_search(self):
        said = self.command(NOT_MET, "search", SAND, "--seeds", "1", *self.QUICK, "-o", self.folder, "--vary",
                            "friction=0.2:0.8", "rolling_friction=0:0.3", "--target", "drum=70", "--rounds", "1",
                            "--set", "time.end=0.04", "particles.grains.count=200")
        self.assertRegex(said, r"(?m)^friction = 0.2, rolling_friction = 0.0, drum.angle \d+")
        self.assertIn("nearest to drum.angle = 70", said)
        self.assertIn("the target is not met: measured values go from ", said)
        self.assertTrue((self.folder / "friction=0.5,rolling_friction=0.15/drum/seed_1/run_record.json").exists())
        with open(self.folder / "sets.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), len(set(re.findall(r"(?m)^friction = .*drum.angle .*$", said))))
        self.assertEqual(set(rows[0]), {"friction", "rolling_friction", "drum.angle", "drum.angle spread"})

    def test_nothing_begins_after_a_run_that_failed(self):
        plan = runs.Plan(pathlib.Path(PROGRAM), threading.Semaphore(1), backend="cpu")
        for name in ("first", "second"):
            with self.assertRaisesRegex(scree.ScreeError, "space: missing"):
                runs.run_deck(scree.Deck(title=name), self.folder / name, plan)
        self.assertEqual(len(plan.errors), 1)
        self.assertFalse((self.folder / "second").exists())

    def test_an_interrupted_search(self):
        with unittest.mock.patch("scree.commands.calibrate.run_search", side_effect=KeyboardInterrupt):
            self.assertEqual(self.command(INTERRUPTED, "search", SAND, "--vary", "x", "--target", "y"), "interrupted\n")

    def test_errors_are_one_line(self):
        sand = [SAND, "--program", PROGRAM, "-o", self.folder]
        vary = ["--vary", "friction=0.2:0.8"]
        for words, message in (
                (["repose", "none.toml"], "none.toml: cannot be read: "),
                (["repose", SAND, "--program", "none"], "none: no such program"),
                (["repose", *sand, "--set", "time.end"], "time.end: must have the form KEY=VALUE"),
                (["repose", *sand, "--set", "time.end=-1"], "time.end = -1: must be a number above 0"),
                (["search", *sand, *vary, "--target", "repose=30"],
                 "--vary: 1 keys; a search needs two different ones"),
                (["search", *sand, *vary, "rolling_friction=0.3", "--target", "repose=30"], "form KEY=LOW:HIGH"),
                (["search", *sand, *vary, "rolling_friction=0.3:0", "--target", "repose=30"], "LOW must be below HIGH"),
                (["search", *sand, *vary, "--target", "heap=30"],
                 "heap is no test; there are repose, drum, shear, uniaxial"),
                (["search", *sand, *vary, "--target", "drum.cohesion=30"], "drum has no cohesion; it has angle"),
                (["search", *sand, *vary, "fraction=0:1", "--target", "repose=30"], "fraction")):
            said = self.command(WRONG, *words)
            self.assertRegex(said, r"^(9 sets of [^\n]*\n)?error: [^\n]*\n$")
            self.assertIn(message, said)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
