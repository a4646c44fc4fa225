"""Contacts, and joints and force elements, as lines in snapshots (output.contacts, output.links).
Usage: SCREE=path/to/scree python3 test_lines.py"""

import json
import pathlib
import sys
import unittest

import numpy as np
from test_cli import DONE, IO_FAILED, CommandLineTest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from results import scree  # noqa: E402

RANKS = pathlib.Path(__file__).resolve().parents[1] / "ranks"
PENDULUM = RANKS.parents[1] / "input/examples/pendulum.toml"
CONTACTS = ("--set", "output.contacts=true")
IMPLICIT = [word for setting in ("integrator.particles=hht", "time.control=fixed", "integrator.substeps=1",
                                 "time.end=0.04", "output.snapshot_interval=0.02") for word in ("--set", setting)]


def per_particle(snapshot):
    """Number of contacts and their force, of each particle, by the lines alone."""
    ids, lines = snapshot.particles["global_id"][:], snapshot.contacts
    number, force = np.zeros(len(ids), int), np.zeros((len(ids), 3))
    for of, sign in (("first", 1), ("second", -1)):
        rows = lines[of][:] >= 0
        at = np.searchsorted(ids, lines[of][rows])
        np.add.at(number, at, 1)
        np.add.at(force, at, sign * lines["force"][rows])
    return number, force


class LinesTest(CommandLineTest):
    def run_lines(self, deck, output, *words):
        self.expect(DONE, "run", deck, "--output", self.folder / output, *words)
        return scree.open(self.folder / output)

    def check_targets(self, run, snapshot):
        """That lines on walls and bodies add up to what the history has of them; returns how many are touched."""
        lines, touched = snapshot.contacts, 0
        row = int(np.flatnonzero(run.history.time == snapshot.time)[0])
        # Of the sides of the space no target is one here.
        walls = [wall["name"] for wall in run.deck.get("walls", [])]
        for kind, names in (("wall", walls), ("body", run.body_names)):
            for number, name in enumerate(names):
                if f"contacts/{name}/fx" not in run.history:
                    continue
                rows, starts = lines[kind][:] == number, (lines["first_body"][:] == number) & (kind == "body")
                scale = np.abs(lines["force"][:]).max(initial=0)
                told = [run.history[f"contacts/{name}/f{axis}"][row] for axis in "xyz"]
                found = lines["force"][starts].sum(axis=0) - lines["force"][rows].sum(axis=0)
                np.testing.assert_allclose(found, told, rtol=1e-12, atol=1e-14 * scale)
                self.assertEqual(np.count_nonzero(rows) + np.count_nonzero(starts),
                                 run.history[f"contacts/{name}/contacts"][row])
                touched += bool(rows.any())
        return touched

    def test_contacts_of_powder_that_sticks_to_walls_meshes_and_bodies(self):
        run = self.run_lines(RANKS / "sticky_meshes.toml", "out", *CONTACTS)
        touched, kinds, apart = 0, set(), 0
        for snapshot in run.snapshots:
            lines = snapshot.contacts
            number, _ = per_particle(snapshot)
            np.testing.assert_array_equal(number, snapshot.particles["contacts"])
            ends = lines["position"][:].reshape(-1, 2, 3)
            # None crosses the box. Contacts of grains of at most 1e-4 m, and of bodies' shapes of 2e-4 m.
            lengths, of_bodies = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1), lines["first_body"][:] >= 0
            self.assertLess(lengths[~of_bodies].max(initial=0), 2.2e-4)
            self.assertLess(lengths[of_bodies].max(initial=0), 4.2e-4)
            self.assertTrue((ends[:, 0, 0] >= 0).all() and (ends[:, 0, 0] < 2e-3).all())
            touched += self.check_targets(run, snapshot)
            kinds |= set(lines["kind"][:])
            apart += np.count_nonzero((lines["overlap"][:] < 0) & (lines["normal_force"][:] < 0))
        self.assertGreater(touched, 5)
        self.assertEqual(kinds, {0, 1, 2})
        self.assertGreater(apart, 0)  # held by adhesion

    def test_forces_of_contacts_add_up_to_those_of_particles(self):
        deck = RANKS / "frictional_bodies.toml"
        run = self.run_lines(deck, "out", *IMPLICIT, *CONTACTS)
        for snapshot in run.snapshots[1:]:
            number, force = per_particle(snapshot)
            np.testing.assert_array_equal(number, snapshot.particles["contacts"])
            np.testing.assert_allclose(force, snapshot.particles["force"], rtol=1e-10, atol=1e-10)
            lines = snapshot.contacts
            self.assertGreater(lines["slip"][:].max(), 0)
            self.assertGreater(lines["tangential_force"][:].max(), 0)
            frame = lines.to_dataframe()
            self.assertEqual((len(frame), frame.attrs["units"]["slip"]), (len(lines["first"]), "m"))
            drawn = snapshot.to_pyvista()["contacts"]
            np.testing.assert_array_equal(drawn.cell_data["overlap"], lines["overlap"])
            self.assertEqual(drawn.n_lines, len(frame))
        plain = self.run_lines(deck, "plain", *IMPLICIT)
        self.assertEqual(plain.record["run"]["state_hash"], run.record["run"]["state_hash"])
        self.assertEqual(plain.snapshots[0].kinds, ("particles", "bodies", "links"))

    def test_links_have_the_reactions_of_the_history(self):
        run = self.run_lines(PENDULUM, "out", "--set", "time.end=0.1")
        self.assertEqual(run.link_names, ["pivot"])
        for snapshot in run.snapshots:
            row = int(np.flatnonzero(run.history.time == snapshot.time)[0])
            told = [run.history[f"reactions/pivot/f{axis}"][row] for axis in "xy"]
            np.testing.assert_array_equal(snapshot.links["reaction"][0][:2], told)
            self.assertAlmostEqual(snapshot.links["force"][0], np.hypot(*told), delta=1e-14)
        self.assertFalse((self.folder / "out/contacts.vtkhdf").exists())
        without = self.run_lines(PENDULUM, "without", "--set", "time.end=0.1", "--set", "output.links=false")
        self.assertFalse((self.folder / "without/links.vtkhdf").exists())
        self.assertEqual(without.record["run"]["state_hash"], run.record["run"]["state_hash"])

    def test_a_restart_with_other_lines_wants_another_folder(self):
        self.run_deck(DONE, "out", "--set", "time.end=0.02", *CONTACTS)
        before = {path.name: path.read_bytes() for path in (self.folder / "out").glob("*.vtkhdf")}
        restart = ("--restart", self.folder / "out/checkpoint_end.h5", "--set", "time.end=0.04")
        for words, key in (((), "contacts"), ((*CONTACTS, "--set", "output.links=false"), "links")):
            message = self.run_deck(IO_FAILED, "out", *restart, *words).stderr
            for word in (f"{key}.vtkhdf", f"set output.{key} = true", "another folder"):
                self.assertIn(word, message)
            self.assertEqual({name: (self.folder / "out" / name).read_bytes() for name in before}, before)
        self.run_deck(DONE, "out", *restart, *CONTACTS)
        snapshots = json.loads((self.folder / "out/run_record.json").read_text())["counts"]["snapshots"]
        self.assertEqual(len(scree.open(self.folder / "out").series("contacts")), snapshots)


if __name__ == "__main__":
    unittest.main()
