"""Messages and costs of decks with many, odd or very small things. Usage: as test_cli.py, with h5py"""

import math
import pathlib
import resource
import unittest

import h5py
import numpy as np

from test_cli import BAD_INPUT, DONE, CommandLineTest

HEAD = """gravity = [0.0, 0.0, -9.81]

[space]
dimension = 3
min = [-1e6, -1e6, -1e6]
max = [1e6, 1e6, 1e6]
leaving = "ballistic"

[time]
end = 1e-3
step = 1e-4
control = "fixed"
"""
PAIR = "[[contact.pairs]]\nstiffness = 1e4\n"
GROUP = '[[particles]]\nkind = "list"\npositions = [[{}.0, 0.0, 0.0]]\nradius = 0.1\nmass = 1.0\n'
BODY = """[[bodies]]
name = "{}"
kind = "spatial"
position = [{}, 0.0, 0.0]
mass = 1.0
inertia_tensor = [0.01, 0.01, 0.01, 0.0, 0.0, 0.0]
"""


def groups(count):
    return HEAD + PAIR + "".join(GROUP.format(i) for i in range(count))


def materials(count):
    deck = HEAD + '[contact]\nmixing = "geometric"\n'
    for i in range(count):
        deck += f'[[materials]]\nname = "m{i}"\n[[contact.pairs]]\nmaterials = ["m{i}", "m{i}"]\nstiffness = 1e4\n'
        deck += GROUP.format(i) + f'material = "m{i}"\n'
    return deck


class CostTest(CommandLineTest):
    """Of N times as many tables, far less than N^2 times the time: no limit in seconds, which a busy machine breaks."""

    def seconds(self, deck):
        path = self.write("many.toml", deck)
        times = []
        for _ in range(2):
            before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
            self.expect(DONE, "check", path)
            times.append(resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before)
        return min(times)

    def test_groups_of_particles(self):
        few, many = self.seconds(groups(1500)), self.seconds(groups(9000))
        self.assertLess(many, 14 * few)  # 6 times as many; squared: 36

    def test_materials_whose_pairs_are_mixed(self):
        few, many = self.seconds(materials(40)), self.seconds(materials(160))
        self.assertLess(many, 40 * few)  # 4 times as many, 16 times the pairs; their square: 256


class NameTest(CommandLineTest):
    """A name that means two things is refused, and the message says which two."""

    def trouble(self, deck):
        return self.expect(BAD_INPUT, "check", self.write("names.toml", HEAD + PAIR + deck)).stderr

    def test_what_the_history_records_contacts_of(self):
        mesh = '[output]\nhistory_contacts = ["a.0"]\n[[meshes]]\nname = "0"\nkind = "box"\nsize = [0.1, 0.1, 0.1]\n'
        wall = '[[walls]]\nname = "{}"\npoint = [0.0, 0.0, -5.0]\nnormal = [0.0, 0.0, 1.0]\n'
        with_mesh = BODY.format("a", 0.0) + 'meshes = [{ mesh = "0" }]\n'
        both = self.trouble(mesh + with_mesh + BODY.format("a.0", 1.0))
        self.assertIn('"a.0" is the name of mesh "0" of body "a" and of body "a.0"; it must be that of one', both)
        both = self.trouble(mesh + with_mesh + wall.format("a.0"))
        self.assertIn('"a.0" is the name of mesh "0" of body "a" and of wall "a.0"', both)
        both = self.trouble('[output]\nhistory_contacts = ["b"]\n' + wall.format("b") + BODY.format("b", 0.0)
                            + "count = 2\nspacing = [0.5, 0.0, 0.0]\n")
        self.assertIn('"b" is the name of row of bodies "b" and of wall "b"', both)

    def test_a_group_that_has_the_number_of_one_without_a_name(self):
        text = self.trouble(GROUP.format(0) + GROUP.format(1) + 'name = "0"\n')
        self.assertIn('particles.0.name = "0": is the number of a group without a name', text)


class WarningTest(CommandLineTest):
    def test_of_one_kind_ten_are_shown_and_the_others_counted(self):
        deck = HEAD + PAIR + "".join(f'[[meshes]]\nname = "m{i}"\nkind = "box"\nsize = [0.1, 0.1, 0.1]\n'
                                     for i in range(25)) + GROUP.format(0)
        lines = self.expect(DONE, "check", self.write("meshes.toml", deck)).stderr.splitlines()
        unused = [line for line in lines if "no wall, body or solid uses it" in line]
        self.assertEqual(len(unused), 11)
        self.assertIn('warning: 15 more warnings like this one: mesh "m0": no wall, body or solid uses it', unused[-1])


class DeckKindTest(CommandLineTest):
    def test_files_that_are_no_decks(self):
        for name, begins, said in (("a.h5", b"\x89HDF\r\n\x1a\n\0\0", "is an HDF5 file; a deck is text in TOML; a run"),
                                   ("a.urdf", b'<?xml version="1.0"?>\n<robot name="r">', ": scree-post urdf "),
                                   ("a.toml", b"PK\x03\x04", "is a ZIP archive"),
                                   ("a.stl", b"solid a\n", "meshes.file"),
                                   ("b.toml", b"a = 1\0", "is a binary file")):
            path = pathlib.Path(self.folder) / name
            path.write_bytes(begins)
            text = self.expect(BAD_INPUT, "check", path).stderr
            self.assertIn(said, text)
            self.assertEqual(len(text.splitlines()), 1)


class KeysTest(CommandLineTest):
    def about(self, word):
        return self.expect(DONE, "keys", word).stdout

    def test_words_of_paths_meanings_and_synonyms(self):
        for word, keys in (("restitution", ["contact.pairs.restitution"]), ("hydraulic", ["[[cylinders]]"]),
                           ("Rayleigh", ["time.step"]), ("servo", ["[[motors]]", "motors.type"]),
                           ("time step", ["time.step"]), ("prismatic", ["joints.type"]), ("gears", ["[[couplers]]"])):
            lines = self.about(word).splitlines()
            for key in keys:
                self.assertIn(key, lines)

    def test_what_is_not_there_says_so_and_where_to_read_on(self):
        for word in ("inserter", "inflow", "clump", "CFD", "temperature"):
            text = self.about(word)
            self.assertIn(f"{word}: not supported: ", text)
            self.assertIn("input/limits.md", text)
        self.assertIn("[[bodies.shapes]]", self.about("clump").splitlines())
        text = self.expect(BAD_INPUT, "keys", "qwertz").stderr
        self.assertIn("keys qwertz: no key is about this", text)
        self.assertIn("input/limits.md", text)

    def test_not_beside_another_form_of_the_manual(self):
        self.expect(BAD_INPUT, "keys", "step", "--markdown")


# A driven rod on a pin, and a second one on two pins in one place, which share their load. l, m, t: units.
def sharing(l, m, t):
    def at(x, y):
        return f"[{x * l!r}, {y * l!r}]"
    deck = f"""velocities = "consistent"
gravity = {at(0.0, -9.81 / t ** 2)}

[integrator]
redundant = "minimum-norm"

[space]
dimension = 2
min = {at(-2.0, -2.0)}
max = {at(2.0, 2.0)}

[time]
end = {t!r}
control = "fixed"
step = {0.01 * t!r}

[output]
history_interval = {0.1 * t!r}
history_bodies = ["b", "c"]

[[bodies]]
name = "b"
position = {at(0.3, 0.04)}
velocity = {at(-0.46 / t, -0.02 / t)}
angular_velocity = {0.4 / t!r}
mass = {0.3 * m!r}
inertia = {0.003 * m * l * l!r}

[[bodies]]
name = "c"
position = {at(0.5, 0.04)}
mass = {0.2 * m!r}
inertia = {0.003 * m * l * l!r}

[[drivers]]
name = "d"
joint = "j"
motion = {{ kind = "sine", amplitude = 0.2, frequency = {5.0 / t!r} }}
"""
    for name, one, two, point in (("j", "ground", "b", at(0.31, 0.07)), ("k", "b", "c", at(0.4, 0.04)),
                                  ("k2", "b", "c", at(0.4, 0.04))):
        deck += f'\n[[joints]]\nname = "{name}"\ntype = "revolute"\nbodies = ["{one}", "{two}"]\npoint = {point}\n'
    return deck


class UnitsTest(CommandLineTest):
    """Shared reactions do not know in which units a deck is: of powers of two the results are the same numbers."""

    def history(self, deck):
        path, out = self.write("units.toml", deck), pathlib.Path(self.folder) / "out"
        self.expect(DONE, "run", path, "--output", out, "--overwrite")
        columns = {}
        with h5py.File(out / "history.h5") as file:
            for group in ("bodies", "reactions"):
                for name, part in file[group].items():
                    columns |= {f"{group}/{name}/{key}": values[:] for key, values in part.items()}
        return columns

    def test_from_kilometres_to_nanometres(self):
        metres = self.history(sharing(1.0, 1.0, 1.0))
        self.assertGreater(len(metres), 8)
        for power in (10, -20, -30):
            other = self.history(sharing(2.0 ** power, 2.0 ** (3 * power), 2.0 ** (power // 2)))
            for name, values in metres.items():
                largest = np.argmax(np.abs(values))
                if abs(values[largest]) < 1e-9:
                    continue
                unit = 2.0 ** round(math.log2(abs(other[name][largest] / values[largest])))
                error = np.max(np.abs(other[name] / unit - values)) / abs(values[largest])
                self.assertLess(error, 1e-11, f"{name} in units of 2^{power}")


class SpinTest(CommandLineTest):
    def test_the_history_of_a_particle_has_its_spin(self):
        deck = HEAD + PAIR.replace("1e4", "1e4\nfriction = 0.5") + GROUP.format(0)
        deck += "angular_velocity = [1.0, 2.0, 3.0]\n"
        deck += GROUP.format(4) + "[output]\nhistory_particles = [1, 0]\n"
        out = pathlib.Path(self.folder) / "out"
        self.expect(DONE, "run", self.write("spin.toml", deck), "--output", out)
        with h5py.File(out / "history.h5") as file:
            for number, spin in ((0, (1.0, 2.0, 3.0)), (1, (0.0, 0.0, 0.0))):
                for axis, rate in zip("xyz", spin):
                    np.testing.assert_array_equal(file[f"particles/{number}/w{axis}"][:], rate)
        still = self.write("still.toml", deck.replace("\nfriction = 0.5", "").replace("angular_velocity", "velocity"))
        self.expect(DONE, "run", still, "--output", out, "--overwrite")
        with h5py.File(out / "history.h5") as file:
            self.assertNotIn("wx", file["particles/0"])


if __name__ == "__main__":
    unittest.main()
