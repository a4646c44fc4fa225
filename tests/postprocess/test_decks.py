"""Decks as dictionaries: made, changed, written, checked and run.

    SCREE=build/release/scree python3 tests/postprocess/test_decks.py

Needs postprocess/requirements.txt."""

import os
import pathlib
import re
import sys
import tempfile
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

import scree
from scree import program

PROGRAM = os.environ["SCREE"]
DECK = ROOT / "input/paper/net_9.toml"
QUICK = {"time.end": 0.01, "time.step": 1e-3}


def box():
    """Made from nothing: a lid that falls onto spheres in a box."""
    deck = scree.Deck(title="box", gravity=[0, 0, -9.81])
    deck["space"] = {"dimension": 3, "min": np.zeros(3), "max": (1.0, 1.0, 1.0), "z_min": "wall"}
    deck["time.end"] = np.float64(0.01)
    deck.add("contact.pairs", stiffness=1e5, damping=1.0)
    deck.add("particles", name="block", kind="lattice", origin=[0.1] * 3, spacing=[0.2] * 3, size=[4, 4, np.int64(2)],
             radius={"kind": "uniform", "min": 0.04, "max": 0.05}, density=1000.0)
    deck.add("bodies", name="lid", kind="spatial", mass=2, inertia_tensor=[1, 1, 1, 0, 0, 0], position=[0.5, 0.5, 0.8])
    deck.add("bodies.lid.shapes", radius=0.1)
    deck.add("bodies.lid.shapes", radius=0.05, offset=[0, 0, 0.1])
    return deck


class FolderTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="scree_decks_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


class DictionaryTest(FolderTest):
    def test_paths_are_those_of_set(self):
        deck = scree.Deck.read(DECK)
        self.assertEqual((deck["time.end"], deck["contact.pairs.0.damping"], deck["bodies.net.count"]), (1.0, 10.0, 20))
        self.assertIs(type(deck["time.end"]), float)
        self.assertEqual((deck["joints.right_pin"], deck["joints.1.type"]), (deck["joints"][1], "revolute"))
        self.assertEqual(deck["bodies.net.shapes.0.radius"], 0.05)
        self.assertTrue("space.leaving" in deck and "space.z_min" not in deck and "bodies.none" not in deck)
        self.assertIn("particles", list(deck))
        for path, said in (("time.ends", "there are end, step, control"), ("nothing.at.all", "nothing does not exist"),
                           ("joints.pin.type", "no element is named pin; there are left_pin, right_pin"),
                           ("joints.2", "there are 2 elements, counted from 0"),
                           ("space.min.0", "space.min has no keys of its own")):
            with self.assertRaisesRegex(scree.ScreeError, said):
                deck[path]
            self.assertIsNone(deck.get(path))

    def test_changes_keep_the_text_around_them(self):
        deck = scree.Deck.read(DECK)
        self.assertEqual(str(deck), DECK.read_text())
        deck["time.end"] = 2
        deck["bodies.net.shapes.0.radius"] = 0.04
        deck["joints.right_pin"]["type"] = "fixed"
        deck["space.min"][0] = -4.0
        wanted = DECK.read_text().replace("end = 1.0", "end = 2").replace("min = [-3.0, -3.0]", "min = [-4.0, -3.0]") \
            .replace('shapes = [{ radius = 0.05 }]', 'shapes = [{ radius = 0.04 }]').split('name = "right_pin"')
        self.assertEqual(str(deck), wanted[0] + 'name = "right_pin"' + wanted[1].replace("revolute", "fixed"))
        del deck["joints.left_pin"]
        del deck["output.history_particles"]
        self.assertEqual((len(deck["joints"]), "history_particles" in deck["output"]), (1, False))
        deck["velocities"] = "consistent"  # at the top, before the tables
        deck["joints.right_pin"] = {"name": "other", "type": "revolute", "bodies": ["ground", "net.1"]}
        deck["contact.skin"] = 0.1
        again = scree.Deck.parse(str(deck))
        found = again["velocities"], again["joints.0.name"], again["contact.skin"]
        self.assertEqual(found, ("consistent", "other", 0.1))
        self.assertEqual(again.to_dict(), deck.to_dict())

    def test_tables_that_stand_apart(self):
        deck = scree.Deck.parse("[contact]\nskin = 1.0\n[[bodies]]\nname = 'a'\n[[contact.pairs]]\nstiffness = 1.0\n"
                                "[time]\nend = 1.0\n[[bodies]]\nname = 'b'\nmass = 2.0  # kg\n")
        deck["contact.skin"] = 2.0
        deck["contact.pairs.0.stiffness"] = 3.0
        deck.add("contact.pairs", stiffness=4.0)
        deck["bodies.a.mass"] = deck["bodies"][1]["mass"]
        deck.add("bodies", **deck["bodies.b"])["name"] = "c"
        bodies = [{"name": name, "mass": 2.0} for name in "abc"]
        wanted = {"contact": {"skin": 2.0, "pairs": [{"stiffness": 3.0}, {"stiffness": 4.0}]}, "time": {"end": 1.0},
                  "bodies": bodies}
        self.assertEqual(deck.to_dict(), wanted)
        self.assertEqual(scree.Deck.parse(str(deck)).to_dict(), wanted)
        self.assertEqual(str(deck).count("kg"), 1)

    def test_a_copy_is_another_deck(self):
        deck = scree.Deck.read(DECK)
        other = deck.copy()
        other["time.end"] = 3.0
        other["bodies.net"]["mass"] = 7.0
        self.assertEqual((deck["time.end"], deck["bodies.net.mass"], other.folder), (1.0, 1.0, DECK.parent))

    def test_decks_made_from_nothing(self):
        deck = box()
        text = str(deck)
        for line in ("[[contact.pairs]]", "[[particles]]", "size = [4, 4, 2]", "max = [1.0, 1.0, 1.0]",
                     'radius = {kind = "uniform", min = 0.04, max = 0.05}'):
            self.assertIn(f"{line}\n", text)
        self.assertEqual(len(deck["bodies.lid.shapes"]), 2)
        self.assertIn("32, radius 0.04", deck.check(PROGRAM))
        self.assertEqual(repr(scree.Deck()), "<deck: an empty deck>")
        for wrong in (lambda: deck.update({"time.end": object()}), lambda: deck.add("space", a=1),
                      lambda: deck.update({"bodies.lid": 3}), lambda: scree.Deck.parse("a = [", "x.toml")):
            self.assertRaises(scree.ScreeError, wrong)
        with self.assertRaisesRegex(scree.ScreeError, "none.toml: cannot be read: No such file"):
            scree.Deck.read(self.folder / "none.toml")

    def test_files_are_found_from_wherever_the_deck_is(self):
        (self.folder / "a/b").mkdir(parents=True)
        (self.folder / "a/grains.csv").write_text("x,y,z\n0.5,0.5,0.5\n")
        (self.folder / "a/deck.toml").write_text(str(box()))
        deck = scree.Deck.read(self.folder / "a/deck.toml")
        del deck["particles.block"]
        deck.add("particles", name="read", kind="file", file="grains.csv", radius=0.01, mass=1.0)
        deck.add("particles", name="same", kind="file", file=str(self.folder / "a/grains.csv"), radius=0.01, mass=1.0,
                 velocity=[0, 0, 0])
        del deck["particles.same"]
        deck.write(self.folder / "a/b/moved.toml")
        moved = scree.Deck.read(self.folder / "a/b/moved.toml")
        self.assertEqual((moved["particles.read.file"], deck["particles.read.file"]), ("../grains.csv", "grains.csv"))
        self.assertIn("particles      1,", moved.check(PROGRAM))
        self.assertIn("particles      1,", deck.check(PROGRAM))


class CheckTest(FolderTest):
    def test_problems_in_the_words_of_the_program(self):
        deck = box()
        self.assertEqual(deck.problems(), [])
        deck.name = "box.toml"
        changes = {"bodies.lid.mass": -1, "bodies.lid.inertia": 1.0, "bodies.lid.masss": 1, "time.control": "foo",
                   "space.min": "x", "walls": 3, "bodies.lid.shapes.1.radius": "x", "particles.block.radius.min": -1}
        for path, value in changes.items():
            deck[path] = value
        del deck["particles.block.size"]
        deck.add("drivers", name="a", joint="b", motion={"kind": "ramp", "rat": 1.0})
        found = deck.problems()
        for line in ("bodies.lid.mass = -1: must be a number above 0 [kg]",
                     'bodies.lid.inertia = 1.0: not used with kind = "spatial"',
                     'bodies.lid.masss = 1: unknown key; did you mean "mass"?',
                     'bodies.lid.shapes.1.radius = "x": must be a number above 0 [m]',
                     'drivers.a.motion.rat = 1.0: unknown key; did you mean "rate"?',
                     'drivers.a.motion.rate: missing; with kind = "ramp" it must be a number [the quantity\'s unit/s]',
                     'particles.block.radius.min = -1: must be a number above 0 [the quantity\'s unit]',
                     'particles.block.size: missing; with kind = "lattice" it must be a list of integers of at least 1',
                     'space.min = "x": must be 2 or 3 numbers [m] in brackets',
                     'time.control = "foo": must be one of "fixed", "adaptive"',
                     "walls = 3: must be a list of tables"):
            self.assertIn(line, found)
        self.assertEqual(len(found), 11)
        with self.assertRaisesRegex(scree.ScreeError, r"box.toml: bodies.lid.mass = -1: must be a number above 0 \["):
            deck.check(PROGRAM)

    def test_the_program_is_asked_where_the_schema_finds_something_too(self):
        deck = box()
        deck.name = "box.toml"
        deck["time.end"], deck["bodies.lid.mass"] = -1, -2
        with self.assertRaises(scree.ScreeError) as caught:
            deck.check(PROGRAM)
        first, *others = str(caught.exception).splitlines()
        self.assertRegex(first, r"^box.toml:\d+:\d+: time.end = -1: must be a number above 0 \[s\]$")
        self.assertEqual(others, ["box.toml: bodies.lid.mass = -2: must be a number above 0 [kg]"])

    def test_messages_are_of_the_file_that_was_written(self):
        deck, path = scree.Deck.read(DECK), self.folder / "fast.toml"
        deck.add("meshes", name="gone", kind="file", file="gone.stl")
        deck["time.end"] = -1
        deck.write(path)
        with self.assertRaises(scree.ScreeError) as caught:
            deck.check(PROGRAM)
        found = re.fullmatch(rf"{path}:(\d+):(\d+): time.end = -1: must be .*", str(caught.exception).splitlines()[0])
        line = path.read_text().splitlines()[int(found[1]) - 1]
        self.assertEqual(line[int(found[2]) - 1 :].split()[0], "-1")
        deck["time.end"] = 1.0
        with self.assertRaisesRegex(scree.ScreeError, rf"^{path}:\d+:\d+: "):
            deck.check(PROGRAM)
        with self.assertRaisesRegex(scree.ScreeError, rf"^{path}:\d+:\d+: "):
            deck.run(self.folder / "run", quiet=True, scree=PROGRAM)
        deck["time.end"] = -1
        self.assertEqual(path.read_text(), str(scree.Deck.read(path)))
        self.assertIn(f"{path}: time.end = -1", "\n".join(f"{deck.name}: {line}" for line in deck.problems()))

    def test_what_the_program_tells_too_is_told_once(self):
        for path, value in ("gravity", [0, 0, "down"]), ("space", None), ("particles.block.size", None):
            with self.subTest(path):
                deck = box()
                if value is None:
                    del deck[path]
                else:
                    deck[path] = value
                with self.assertRaisesRegex(scree.ScreeError, f"^.*{path}.*$"):
                    deck.check(PROGRAM)

    def test_a_number_where_a_table_may_stand(self):
        deck = scree.Deck.read(DECK)
        deck["particles.block.radius"] = -1
        self.assertEqual(deck.problems(),
                         ["particles.block.radius = -1: must be a number above 0 [m], or a table with a kind"])

    def test_what_only_the_program_knows(self):
        deck = scree.Deck.read(DECK)
        deck["joints.left_pin.bodies"] = ["ground", "net.20"]
        self.assertEqual(deck.problems(), [])
        with self.assertRaisesRegex(scree.ScreeError, rf"^{DECK}:\d+:\d+: joints.left_pin.bodies = "):
            deck.check(PROGRAM)

    def test_the_decks_of_this_repository_fit_the_schema(self):
        paths = sorted((ROOT / "input").rglob("*.toml"))
        self.assertGreater(len(paths), 20)
        for path in paths:
            if "materials" not in path.parts:
                self.assertEqual(scree.Deck.read(path).problems(), [], path)


class RunTest(FolderTest):
    def quick(self):
        deck = scree.Deck.read(DECK)
        deck.update(QUICK)
        return deck

    def test_a_run_and_its_results(self):
        deck = self.quick()
        run = deck.run(self.folder / "out", quiet=True, scree=PROGRAM)
        self.assertEqual((run.status, run.deck["time"]["end"], run.history["step/steps"][-1]), ("done", 0.01, 10))
        self.assertEqual(scree.Deck.read(self.folder / "out/deck.toml").to_dict(), deck.to_dict())
        several = deck.run(self.folder / "two", ranks=2, launcher="mpirun --oversubscribe", quiet=True, scree=PROGRAM)
        self.assertEqual(several.record["run"]["ranks"], 2)
        self.assertEqual(several.record["run"]["state_hash"], run.record["run"]["state_hash"])

    def test_what_is_refused_leaves_the_folder_as_it_was(self):
        deck, out = self.quick(), self.folder / "out"
        deck.run(out, quiet=True, scree=PROGRAM)
        before = (out / "deck.toml").read_text()
        deck["time.step"] = 5e-4
        with self.assertRaisesRegex(scree.ScreeError, "out: contains results of an earlier run: "):
            deck.run(out, quiet=True, scree=PROGRAM)
        deck["bodies.net.mass"] = -1
        with self.assertRaisesRegex(scree.ScreeError, rf"^{DECK}:\d+:\d+: bodies.net.mass = -1: must be a number"):
            deck.run(self.folder / "bad", quiet=True, scree=PROGRAM)
        self.assertEqual((out / "deck.toml").read_text(), before)
        self.assertFalse((self.folder / "bad/deck.toml").exists())
        deck["bodies.net.mass"] = 1.0
        self.assertEqual(deck.run(out, "--overwrite", quiet=True, scree=PROGRAM).history["step/steps"][-1], 20)

    def test_a_program_that_is_not_there(self):
        with self.assertRaisesRegex(scree.ScreeError, "none: no such program"):
            self.quick().run(self.folder / "out", scree=self.folder / "none")
        self.assertEqual(program.message("a\nerror: b\nerror: b\n--- mpirun"), "b")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
