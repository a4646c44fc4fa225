"""What `scree check` says of files is what a run writes, and small runs write small files. Usage: as test_cli.py"""

import pathlib
import re
import unittest

from test_cli import DECK, DONE, GAS, CommandLineTest

INPUT = pathlib.Path(__file__).resolve().parents[2] / "input"
UNITS = {"kB": 1e3, "MB": 1e6, "GB": 1e9, "TB": 1e12}
ROW = """
[space]
dimension = 2
min = [0.0, 0.0]
max = [20001.0, 10.0]
[time]
end = 1e-4
step = 2e-5
control = "fixed"
[[contact.pairs]]
stiffness = 1e5
[[bodies]]
name = "row"
count = 5000
position = [1.0, 5.0]
spacing = [2.0, 0.0]
mass = 1.0
inertia = 0.1
shapes = [{ radius = 0.5 }]
[output]
history_bodies = ["row"]
"""
LATTICE = """
[space]
dimension = 2
min = [0.0, 0.0]
max = [201.0, 100.0]
[time]
end = 1e-4
step = 1e-4
control = "fixed"
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e5
[[particles]]
name = "grains"
kind = "lattice"
origin = [0.5, 0.5]
spacing = [1.0, 1.0]
size = [{columns}, 83]
radius = 0.4
mass = 1.0
"""


def named(report, pattern):
    """The first size behind the pattern [B]."""
    value, unit = re.search(pattern + r"(\S+) ([kMGT]B)", report).groups()
    return float(value) * UNITS[unit]


class DiskTest(CommandLineTest):
    def sizes(self, deck, *settings):
        """Of the checkpoint, the history, and the snapshots with their texts [B]; what check says of them."""
        words = [word for setting in settings for word in ("--set", setting)]
        report = self.expect(DONE, "check", deck, *words).stdout
        self.expect(DONE, "run", deck, "--output", "out", "--overwrite", "--backend", "cpu", *words)
        of = {path.name: path.stat().st_size for path in (self.folder / "out").iterdir()}
        snapshots = sum(size for name, size in of.items() if name.endswith((".vtkhdf", ".xdmf")))
        said = (named(report, r"\ncheckpoints .*?, about "), named(report, r"\nhistory .* columns, about "),
                named(report, r"\nsnapshots .*?, "))
        return (of["checkpoint_end.h5"], of["history.h5"], snapshots), said, report

    def assert_as_said(self, deck, *settings):
        found, said, _ = self.sizes(deck, *settings)
        for what, size, estimate in zip(("checkpoint", "history", "snapshots"), found, said):
            self.assertAlmostEqual(estimate / size, 1, delta=0.2, msg=f"{deck} {settings}: {what} of {size} B")
        return found

    def test_files_are_as_large_as_check_says(self):
        gas = self.write("gas.toml", GAS)
        for deck, settings in (
                (self.deck, ()), (self.deck, ("output.history_interval=0.1", "output.snapshot_interval=0.001")),
                (gas, ("time.end=0.02",)), (gas, ("time.end=0.02", "output.snapshot_interval=0.001")),
                (self.write("lattice.toml", LATTICE.format(columns=200)), ()),
                (INPUT / "examples/pendulum.toml", ()), (INPUT / "examples/heavy_top.toml", ("time.end=0.1",)),
                (INPUT / "paper/net_400.toml", ("time.end=0.02",)),
                (INPUT / "examples/screw_lift.toml", ("time.end=2e-4",)),
                (INPUT / "examples/engine_mount.toml", ("time.end=0.1",)),
                (INPUT / "examples/drum.toml", ("time.end=0.01", "output.snapshot_interval=0.001"))):
            with self.subTest(deck=deck.name, settings=settings):
                self.assert_as_said(deck, *settings)

    def test_small_runs_write_small_files(self):
        checkpoint, history, snapshots = self.assert_as_said(INPUT / "examples/pendulum.toml", "time.end=0.01")
        self.assertLess(checkpoint, 60e3)
        self.assertLess(history, 60e3)
        self.assertLess(snapshots, 200e3)

    def test_rows_just_past_a_chunk_do_not_double_a_file(self):
        for compressed in ("output.compression=0", "output.compression=1"):
            sizes = [self.sizes(self.write("lattice.toml", LATTICE.format(columns=columns)), compressed)[0]
                     for columns in (98, 99)]  # 8,134 and 8,217 particles
            self.assertLess(sizes[1][0], 1.05 * sizes[0][0])

    def test_history_of_many_bodies(self):
        found = self.assert_as_said(self.write("row.toml", ROW))
        self.assertLess(found[1], 40e6)  # six rows of 40,000 columns

    def test_contacts_that_are_remembered_make_a_range(self):
        frictional = GAS.replace("stiffness = 1e6", "stiffness = 1e6\nfriction = 0.5").replace("hht", "velocity-verlet")
        frictional = self.write("friction.toml", frictional)
        found, said, report = self.sizes(frictional, "time.end=0.02", "output.contacts=true")
        dense = named(report, r"\ncheckpoints .* each; ")
        self.assertTrue(0.8 * said[0] <= found[0] <= 1.2 * dense)
        with_contacts = said[2] + named(report, r"\nsnapshots .*contacts add ")
        self.assertTrue(0.8 * said[2] <= found[2] <= 1.2 * with_contacts)

    def test_what_does_not_fit_is_said_with_what_to_change(self):
        for settings, remedy in (
                (("output.snapshot_interval=4e-5", "time.end=4e4", "output.history_interval=1"),
                 "a longer output.snapshot_interval, fewer of output.fields"),
                (("output.history_interval=4e-5", "time.end=4e4"), "a longer output.history_interval")):
            words = [word for setting in settings for word in ("--set", setting)]
            with self.subTest(settings=settings):
                result = self.expect(DONE, "check", self.deck, *words, "--set", "output.history_bodies=[]")
                warning = re.search(r"warning: (the results need about \S+ TB of disk space .*)\n", result.stderr)[1]
                self.assertIn("are free in results/deck: snapshots ", warning)
                self.assertIn(f"remedy: {remedy}", warning)
        self.assertNotIn("of disk", self.expect(DONE, "check", self.deck).stderr)
        self.assertIn("disk           about ", self.expect(DONE, "check", self.deck).stdout)


if __name__ == "__main__":
    unittest.main()
