"""The package's reading of results: of finished runs, of ones that went on from a checkpoint, and of one that goes on.

    SCREE=build/release/scree python3 tests/postprocess/test_results.py DRUM_LIFTERS

takes the folder of that run's results. Needs postprocess/requirements.txt."""

import csv
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

import scree
from scree import files

PROGRAM, DRUM = os.environ["SCREE"], pathlib.Path(sys.argv[1]).resolve()
DECK = ROOT / "input/paper/net_9.toml"
SETTINGS = ("time.end=0.03", "time.step=1e-3", "output.history_interval=1e-3", "output.snapshot_interval=0.01")
LIMIT = 60  # [s] for any one run


def run(output, *settings, words=(), cwd=None):
    """Later settings win."""
    chosen = [word for setting in (*SETTINGS, *settings) for word in ("--set", setting)]
    subprocess.run([PROGRAM, "run", DECK, "--output", output, *chosen, *words], cwd=cwd, check=True, timeout=LIMIT,
                   stdout=subprocess.DEVNULL)


# As a run does it: the copy without the name gets new numbers, and then the name. An exchange takes less time than 200
# numbers do to be read.
WRITER = """
import ctypes, os, sys, h5py
path, hidden = sys.argv[1], sys.argv[1] + ".copy"
exchange = ctypes.CDLL(None, use_errno=True).renameat2
files = {}
for name in (path, hidden):
    with h5py.File(name, "w", libver="latest") as file:
        for k in range(200):
            file[str(k)] = 0
handles = [os.open(name, os.O_RDWR) for name in (path, hidden)]
with h5py.File(path, "r") as file:
    places = [file[str(k)].id.get_offset() for k in range(200)]
print("begins", flush=True)
number = 0
while True:
    number += 1
    for place in places:
        os.pwrite(handles[number % 2], number.to_bytes(8, "little"), place)
    if exchange(-100, path.encode(), -100, hidden.encode(), 2) != 0:
        raise OSError(ctypes.get_errno())
"""


class FolderTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="scree_results_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


class ReadingTest(FolderTest):
    @classmethod
    def setUpClass(cls):
        kept = tempfile.TemporaryDirectory(prefix="scree_results_")
        cls.addClassCleanup(kept.cleanup)
        cls.results = pathlib.Path(kept.name) / "net"
        run(cls.results)

    def test_what_the_history_holds(self):
        found = scree.open(self.results)
        energy = found.history["energy/kinetic"]
        with h5py.File(self.results / "history.h5") as file:
            np.testing.assert_array_equal(energy, file["energy/kinetic"][:])
            self.assertEqual(len(found.history), len(files.datasets(file)))
        self.assertEqual((energy.unit, energy.shape, found.history.rows), ("J", (31,), 31))
        self.assertEqual(energy.description, "kinetic energy of particles and bodies")
        np.testing.assert_allclose(found.history.time, np.linspace(0, 0.03, 31), atol=1e-12)
        for error in (KeyError, scree.ScreeError):
            with self.assertRaisesRegex(error, "^no column energy/kinetik"):
                found.history["energy/kinetik"]
            with self.assertRaisesRegex(error, "^no column energy/kinetik"):
                found.history.read("energy/total", "energy/kinetik")
        with self.assertRaisesRegex(scree.ScreeError, r"no column energy/x\*"):
            found.history.names("energy/x*")

    def test_the_csv_has_the_same_numbers(self):
        run(self.folder / "out", "output.history_csv=true")
        names, *rows = csv.reader((self.folder / "out/history.csv").read_text().splitlines())
        history = scree.open(self.folder / "out").history
        self.assertEqual(sorted(names), sorted(f"{name} [{column.unit}]" for name, column in history.items()))
        for name, values in zip(names, zip(*rows)):
            np.testing.assert_array_equal(history[name.split(" [")[0]], [float(value) for value in values])

    def test_a_quantity_is_an_array(self):
        energy = scree.open(self.results).history["energy/kinetic"]
        self.assertIsInstance(energy / 2, np.ndarray)
        self.assertIsInstance(energy[1:], np.ndarray)
        self.assertEqual(np.max(energy), energy.values.max())
        self.assertEqual((2 * energy - energy)[-1], energy[-1])
        self.assertIn("31 values in J", repr(energy))
        for name in ("max", "min", "mean", "sum", "std", "argmax", "argmin", "tolist"):
            self.assertEqual(getattr(energy, name)(), getattr(energy.values, name)())
        positions = scree.open(self.results).snapshots[-1].particles["position"]
        self.assertEqual((positions.T.shape, positions.mean(axis=0).shape), ((3, len(positions)), (3,)))
        self.assertEqual((energy.astype(np.float32).dtype, energy.ndim, energy.size), (np.float32, 1, 31))
        self.assertFalse(np.shares_memory(energy.copy(), energy.values))

    def test_a_table_of_the_history(self):
        frame = scree.open(self.results).to_dataframe("energy/*", "step/time")
        self.assertEqual((len(frame), frame.index.name, "step/time" in frame), (31, "time [s]", False))
        self.assertEqual(frame.attrs["units"]["energy/total"], "J")
        self.assertTrue(all(name.startswith("energy/") for name in frame))

    def test_what_a_snapshot_holds(self):
        found = scree.open(self.results)
        snapshot = found.snapshots[-1]
        self.assertEqual((len(found.snapshots), snapshot.kinds), (4, ("particles", "bodies", "links")))
        self.assertEqual(snapshot.time, found.snapshots.at(1.0).time)
        self.assertEqual(found.snapshots.at(0.011).number, 1)
        velocity = snapshot.particles["velocity"]
        self.assertEqual((velocity.shape, velocity.unit), ((9, 3), "m/s"))
        self.assertEqual([s.number for s in found.snapshots[1:3]], [1, 2])
        self.assertEqual(found.body_names[snapshot.bodies["body"][-1]], "net.19")
        self.assertEqual([found.link_names[k] for k in snapshot.links["link"]][:3], ["left_pin", "right_pin", "cord.0"])
        self.assertEqual((len(snapshot.links["force"]), len(snapshot.links["position"])), (21, 42))
        self.assertEqual((found.group_names, found.material_names), (["block"], ["default"]))
        np.testing.assert_array_equal(snapshot.particles["group"], np.zeros(9))
        # Twenty discs, then twenty centres of mass, where the discs are.
        kind, place = snapshot.bodies["kind"].values, snapshot.bodies["position"].values
        np.testing.assert_array_equal(kind, np.repeat([0, 1], 20))
        np.testing.assert_array_equal(place[kind == 1], place[kind == 0])
        with self.assertRaisesRegex(scree.ScreeError, "no surfaces.vtkhdf"):
            snapshot.surfaces
        for error in (KeyError, scree.ScreeError):
            with self.assertRaisesRegex(error, "^no field mass; there are position, "):
                snapshot.particles["mass"]
        table = snapshot.particles.to_dataframe()
        np.testing.assert_array_equal(table["velocity_y"], velocity[:, 1])
        np.testing.assert_array_equal(table["x"], snapshot.particles["position"][:, 0])
        self.assertEqual(table.attrs["units"]["velocity_y"], "m/s")

    def test_contacts_name_their_walls(self):
        deck = scree.Deck.read(ROOT / "input/examples/conveyor.toml")
        deck["time.end"], deck["output.contacts"] = 1e-4, True
        deck["particles.grains.size"] = [2, 1, 1]
        deck["space.z_min"], deck["space.x_min"] = "wall", "wall"
        found = deck.run(self.folder / "belt", quiet=True)
        names = [wall["name"] for wall in found.deck["walls"]]
        self.assertEqual(found.wall_names, [*names, "x_min", "y_min", "y_max", "z_min"])
        contacts = found.snapshots[-1].contacts
        self.assertEqual(len(contacts["position"]), 2 * contacts.count)

    def test_meshes_of_pyvista(self):
        snapshot = scree.open(DRUM).snapshots[-1]
        blocks = snapshot.to_pyvista()
        self.assertEqual(blocks.keys(), ["particles", "bodies", "surfaces", "links"])
        self.assertEqual((blocks["links"].n_lines, blocks["links"].cell_data["torque"].shape), (1, (1,)))
        drum, grains = blocks["surfaces"], blocks["particles"]
        self.assertEqual((drum.n_cells, grains.n_points), (len(snapshot.surfaces.triangles), snapshot.particles.count))
        np.testing.assert_array_equal(drum.cell_data["pressure"], snapshot.surfaces["pressure"])
        np.testing.assert_array_equal(drum.points, snapshot.surfaces["position"])
        np.testing.assert_array_equal(grains.point_data["radius"], snapshot.particles["radius"])
        self.assertEqual(drum.field_data["time"][0], snapshot.time)
        ball = grains.extract_points([0], include_cells=True)
        self.assertEqual(ball.n_cells, 1)  # each point is a vertex
        table = snapshot.surfaces.to_dataframe()
        self.assertEqual(len(table), drum.n_cells)
        self.assertTrue({"pressure", "shear_x", "body"} <= set(table))
        np.testing.assert_allclose(table[["x", "y", "z"]], drum.cell_centers().points, atol=1e-12)
        self.assertEqual(table.attrs["units"]["x"], "m")

    def test_times_in_the_reader_of_pyvista(self):
        for folder, kind in ((self.results, "particles"), (self.results, "bodies"), (DRUM, "surfaces")):
            snapshots, reader = scree.open(folder).snapshots, scree.reader(folder / f"{kind}.vtkhdf")
            self.assertEqual(reader.time_values, list(snapshots.times))
            for snapshot in (snapshots[-1], snapshots[1], snapshots[0]):
                reader.set_active_time_value(snapshot.time)
                mesh = reader.read()
                self.assertEqual(reader.active_time_value, snapshot.time)
                np.testing.assert_array_equal(mesh.points, getattr(snapshot, kind)["position"])
            reader.set_active_time_point(1)
            self.assertEqual(reader.active_time_value, snapshots.times[1])
        np.testing.assert_array_equal(mesh.cell_data["pressure"], snapshot.surfaces["pressure"])
        with self.assertRaisesRegex(scree.ScreeError, "no snapshot at 7 s; the nearest is at "):
            reader.set_active_time_value(7)

    def test_what_is_no_run(self):
        for folder, text in ((self.folder / "none", "no such folder"), (self.folder, "holds no results of a run")):
            with self.assertRaisesRegex(scree.ScreeError, text):
                scree.open(folder)
        (self.folder / "history.h5").write_bytes(b"no HDF5")
        with self.assertRaisesRegex(scree.ScreeError, "history.h5: cannot be read"):
            scree.open(self.folder)

    def test_of_a_run_before_its_first_snapshot(self):
        shutil.copy(self.results / "history.h5", self.folder)
        found = scree.open(self.folder)
        self.assertEqual((len(found.snapshots), found.series("particles"), found.status),
                         (0, None, "ended without a record: killed?"))
        with self.assertRaisesRegex(scree.ScreeError, "no snapshots"):
            found.snapshots.at(0)
        with self.assertRaisesRegex(scree.ScreeError, "there is no deck yet"):
            found.deck
        shutil.copy(self.results / "checkpoint_end.h5", self.folder)
        self.assertEqual(scree.open(self.folder).deck["title"], scree.open(self.results).deck["title"])


class RestartTest(FolderTest):
    def whole(self):
        run("whole", cwd=self.folder)
        return scree.open(self.folder / "whole")

    def compare(self, joined, whole):
        self.assertEqual(joined.history.rows, whole.history.rows)
        for name in whole.history:
            np.testing.assert_array_equal(joined.history[name], whole.history[name], name)
        np.testing.assert_array_equal(joined.snapshots.times, whole.snapshots.times)
        for one, other in zip(joined.snapshots, whole.snapshots):
            for kind in whole.snapshots[0].kinds:
                for name, field in getattr(other, kind).items():
                    np.testing.assert_array_equal(getattr(one, kind)[name], field, f"{kind}/{name}")

    def test_in_the_same_folder_and_a_chain_of_others(self):
        """Paths in the record are relative to where the runs began, which is not where they are read from."""
        whole = self.whole()
        run("first", "time.end=0.01", cwd=self.folder)
        restart = ("--restart", "first/checkpoint_end.h5")
        shutil.copytree(self.folder / "first", self.folder / "same")
        run("same", words=("--restart", "same/checkpoint_end.h5"), cwd=self.folder)
        self.compare(scree.open(self.folder / "same"), whole)
        run("second", "time.end=0.02", words=restart, cwd=self.folder)
        run("third", words=("--restart", "second/checkpoint_end.h5"), cwd=self.folder)
        joined = scree.open(self.folder / "third")
        self.assertEqual([path.name for path in joined.folders], ["first", "second", "third"])
        self.compare(joined, whole)
        self.compare(scree.open(self.folder / "first", self.folder / "second", self.folder / "third"), whole)
        alone = scree.open(self.folder / "third", earlier=False)
        self.assertEqual((alone.history.rows, len(alone.snapshots)), (10, 1))
        self.assertEqual(alone.warnings, joined.warnings)
        run("third", "time.end=0.04", words=("--restart", "third/checkpoint_end.h5"), cwd=self.folder)
        with self.assertWarnsRegex(scree.ScreeWarning, r'third: begins at t = 0.021 s, .*open\("EARLIER", "third"\)'):
            within = scree.open(self.folder / "third")  # its record names itself
        self.assertIn("begins at t = 0.021 s", within.warnings[0])
        run("third", words=("--restart", "second/checkpoint_end.h5", "--overwrite"), cwd=self.folder)
        shutil.rmtree(self.folder / "second")
        with self.assertRaisesRegex(scree.ScreeError, "continued from second/checkpoint_end.h5, which is not found"):
            scree.open(self.folder / "third")

    def test_a_later_folder_takes_the_place_of_what_overlaps(self):
        whole = self.whole()
        run("first", "output.checkpoint_interval=0.01", "time.end=0.025", cwd=self.folder)
        run("later", words=("--restart", "first/checkpoint.h5"), cwd=self.folder)  # of 0.02 s
        later = scree.open(self.folder / "later", earlier=False)
        self.assertAlmostEqual(later.history.time[0], 0.021)
        self.compare(scree.open(self.folder / "later"), whole)


class GoingOnTest(FolderTest):
    def test_a_run_is_read_while_it_writes(self):
        """What is read on the way is a beginning of what is there at the end."""
        output = self.folder / "out"
        words = ("time.end=0.2", "time.step=1e-4", "output.snapshot_interval=1e-3")
        chosen = [word for setting in (*SETTINGS, *words) for word in ("--set", setting)]
        program = subprocess.Popen([PROGRAM, "run", DECK, "--output", output, *chosen], stdout=subprocess.DEVNULL)
        self.addCleanup(program.kill)
        deadline, seen = time.monotonic() + LIMIT, {}
        while program.poll() is None:
            self.assertLess(time.monotonic(), deadline)
            if (output / "particles.vtkhdf").exists():
                found = scree.open(output)
                if len(found.snapshots):
                    last = found.snapshots[-1]
                    seen[last.number] = (last.time, last.particles["position"].values, last.bodies["position"].values)
        self.assertEqual(program.returncode, 0)
        self.assertGreater(len(seen), 0)  # how many depends on what else the machine does
        found = scree.open(output)
        self.assertEqual((found.status, len(found.snapshots)), ("done", 201))
        for number, (when, *positions) in seen.items():
            snapshot = found.snapshots[number]
            self.assertEqual(snapshot.time, when)
            for kind, position in zip((snapshot.particles, snapshot.bodies), positions):
                np.testing.assert_array_equal(kind["position"], position)

    def test_a_view_stays_as_it_was_opened(self):
        output = self.folder / "out"
        run(output, "time.end=0.02")
        found = scree.open(output)
        run(output, words=("--restart", output / "checkpoint_end.h5"))
        self.assertEqual((found.history["energy/total"].shape, len(found.snapshots)), ((21,), 3))
        found.refresh()
        self.assertEqual((found.history["energy/total"].shape, len(found.snapshots)), ((31,), 4))

    def test_columns_that_are_not_of_one_length_end_with_the_shortest(self):
        with h5py.File(self.folder / "history.h5", "w") as file:
            for name, rows in (("step/time", 5), ("energy/total", 4)):
                file[name] = np.arange(float(rows))
                file[name].attrs["unit"], file[name].attrs["description"] = "1", name
        history = scree.open(self.folder).history
        self.assertEqual((history.rows, len(history.time), len(history["energy/total"])), (4, 4, 4))

    def test_a_file_that_is_replaced_is_read_again(self):
        path, calls = self.folder / "file.h5", []

        def write(value, to):
            with h5py.File(to, "w") as file:
                file["value"] = value

        def take(file):
            calls.append(1)
            if len(calls) == 1:
                write(2.0, self.folder / "other.h5")
                os.replace(self.folder / "other.h5", path)
            return file["value"][()]

        write(1.0, path)
        self.assertEqual((files.read(path, take), len(calls)), (2.0, 2))
        with self.assertRaisesRegex(scree.ScreeError, "none.h5: no such file"):
            files.read(self.folder / "none.h5", take)

    def test_a_file_that_is_written_faster_than_it_can_be_read(self):
        """What is taken is of one instant: all of the file's numbers are the same."""
        path = self.folder / "file.h5"
        writer = subprocess.Popen([sys.executable, "-c", WRITER, path], stdout=subprocess.PIPE)
        self.addCleanup(writer.stdout.close)
        self.addCleanup(writer.wait)
        self.addCleanup(writer.kill)
        writer.stdout.readline()  # it goes on
        found = []
        for _ in range(20):
            numbers = files.read(path, lambda file: [int(file[name][()]) for name in sorted(file)])
            self.assertEqual(len(set(numbers)), 1)
            found.append(numbers[0])
        self.assertIsNone(writer.poll())
        self.assertEqual(found, sorted(found))
        self.assertGreater(found[-1], found[0])

    def test_a_lock_says_that_a_run_goes_on(self):
        run(self.folder / "out")
        here = pathlib.Path("/proc/sys/kernel/hostname").read_text().strip()
        for host, process, status in ((here, os.getpid(), "running"), ("elsewhere", 1, "running"),
                                      (here, 2**22 + 1, "done")):
            (self.folder / "out/scree.lock").write_text(f"host {host}\nprocess {process}\n")
            self.assertEqual(scree.open(self.folder / "out").status, status)


# Decks, each with a setting: together they have every kind of column.
REGION = 'output.history_regions=[{name="ball", kind="sphere", center=[0.0, 0.0, 0.0], radius=1.0}]'
RECORDED = (
    ("paper/net_9", ("output.history_bodies=['net.0']", "output.history_contacts=['net']")),
    ("examples/engine_mount", ()), ("examples/governor", ("output.history_coordinates=9",)),
    ("examples/slider_crank_3d", ("output.history_coordinates=9",)), ("examples/boom", ()), ("examples/press", ()),
    ("examples/rolling_resistance", ("output.history_particles=[0]", REGION)), ("examples/silo", ()),
    ("examples/box_of_spheres", ("integrator.particles=velocity-verlet", "contact.pairs.0.attraction=0.01")))


class PageTest(FolderTest):
    """postprocess/README.md has every column that a history may have, with its unit, and no others."""

    def patterns(self):
        """Of the page's table: (pattern of a path, units of its row)."""
        text = (ROOT / "postprocess/README.md").read_text().split("## What the history holds")[1]
        found = {}
        for row in re.findall(r"^\| (`\w+/.*)\|$", text, re.M):
            names, units, *_ = row.split(" | ")
            for name in re.findall(r"`(\w+/[^`]+)`", names):
                parts = [".+" if part.isupper() and len(part) > 1 else part for part in name.split("/")]
                parts[-1] = re.sub(r"C$", "[xyz]", parts[-1]) + ("(_rate)?" if "`_rate`" in names else "")
                found["/".join(parts)] = units
        return found

    def test_the_page_is_that_of_the_program(self):
        patterns, met = self.patterns(), set()
        for deck, settings in RECORDED:
            output = self.folder / deck.replace("/", "_")
            words = [word for setting in ("time.end=2e-3", *settings) for word in ("--set", setting)]
            subprocess.run([PROGRAM, "run", ROOT / f"input/{deck}.toml", "--output", output, *words], check=True,
                           timeout=LIMIT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            for name, column in scree.open(output).history.read().items():
                fitting = [pattern for pattern in patterns if re.fullmatch(pattern, name)]
                self.assertTrue(fitting, name)
                for units in (patterns[pattern] for pattern in fitting):
                    unit = "per s" if name.endswith("rate") and "per s" in units else column.unit
                    self.assertIn(unit, re.split(r", | or ", units), name)
                met.update(fitting)
        self.assertEqual(set(patterns) - met, set())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
