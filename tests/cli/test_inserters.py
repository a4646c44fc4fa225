"""Particles that are born and removed during a run. Usage: SCREE=path/to/scree python3 test_inserters.py"""

import itertools
import json
import pathlib
import sys
import unittest

import numpy as np
from test_cli import BAD_INPUT, DONE, FAILED, CommandLineTest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import results  # noqa: E402

# Few particles meet on their way from the inserter to the outlet, so that long steps are enough.
RAIN = """gravity = [0, 0, -9.81]
[space]
dimension = 3
min = [0, 0, 0]
max = [1, 1, 1]
[time]
end = 10
step = 2e-3
control = "fixed"
[integrator]
particles = "velocity-verlet"
[output]
history_interval = 2
fields = ["radius", "velocity", "mass", "material", "group"]
[[contact.pairs]]
stiffness = 0.1
[[particles]]
name = "first"
kind = "list"
positions = [[0.5, 0.5, 0.6], [0.2, 0.2, 0.7]]
radius = 0.002
density = 1000
[[inserters]]
name = "rain"
kind = "box"
min = [0, 0, 0.5]
max = [1, 1, 1]
number_rate = 700
end = 10
radius = 0.002
density = 1000
[[outlets]]
name = "bottom"
kind = "plane"
point = [0, 0, 0.2]
normal = [0, 0, -1]
"""
# Two positions are tried for each of 100 spheres: some of them wait, and have time to be born until the end.
CROWD = """gravity = [0, 0, -9.81]
[space]
dimension = 3
min = [0, 0, 0]
max = [1, 1, 1]
x_min = "periodic"
x_max = "periodic"
leaving = "remove"
[time]
end = 0.6
step = 1e-3
control = "fixed"
[integrator]
particles = "velocity-verlet"
[output]
history_interval = 0.01
checkpoint_interval = 0.1
[[contact.pairs]]
stiffness = 300.0
restitution = 0.5
[[inserters]]
name = "rain"
kind = "box"
min = [0.925, 0.3, 0.5]
max = [1.075, 0.45, 0.65]
number_rate = 200
end = 0.5
radius = { kind = "uniform", min = 0.01, max = 0.02 }
density = 1000
tries = 2
interval = 0.02
[[outlets]]
name = "bottom"
kind = "box"
min = [0, 0, 0]
max = [1, 1, 0.2]
"""
# Nothing moves and nothing is removed, so that all particles are where they were born.
STILL = """[space]
dimension = 2
min = [0, 0]
max = [1, 1]
x_min = "periodic"
x_max = "periodic"
[time]
end = 0.5
step = 1e-2
control = "fixed"
[[materials]]
name = "light"
density = 500
[[materials]]
name = "heavy"
density = 2000
[[contact.pairs]]
stiffness = 0.1
materials = ["light", "light"]
[[contact.pairs]]
stiffness = 0.1
materials = ["light", "heavy"]
[[contact.pairs]]
stiffness = 0.1
materials = ["heavy", "heavy"]
[output]
history_interval = 0.1
snapshot_interval = 0.1
history_particles = [0, 40, 400]
fields = ["radius", "material"]
[[inserters]]
name = "discs"
kind = "box"
min = [0.7, 0.2]
max = [1.3, 0.8]
number_rate = 160
interval = 0.05
gap = 0.004
shares_by = "number"
mixture = [
  { material = "light", radius = { kind = "uniform", min = 0.01, max = 0.02 }, share = 3 },
  { material = "heavy", radius = 0.01, share = 2 },
]
"""
STREAM = """gravity = [0, -9.81]
[space]
dimension = 2
min = [0, -3]
max = [4, 1]
[time]
end = 0.5
step = 1e-3
control = "fixed"
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 10.0
[output]
fields = ["radius", "velocity"]
[[bodies]]
name = "nozzle"
position = [0.2, 0.9]
velocity = [2.0, 0.0]
mass = 1.0
inertia = 1.0
[[inserters]]
name = "stream"
kind = "face"
center = [0.2, 0.8]
width = 0.1
velocity = [1.0, 0.0]
number_rate = 100
radius = 0.001
density = 1000
"""


class InsertersTest(CommandLineTest):
    def run_text(self, code, text, output, *settings, launcher=(), words=()):
        given = [word for setting in settings for word in ("--set", setting)]
        deck = self.write("births.toml", text)
        return self.expect(code, "run", deck, "--output", self.folder / output, "--overwrite", *given, *words,
                           launcher=launcher)

    def last(self, output):
        return results.rows(self.folder / output)[-1]

    def hash_of(self, output):
        return json.loads((self.folder / output / "run_record.json").read_text())["run"]["state_hash"]

    def snapshot(self, output, number=-1):
        """Time and fields of one snapshot."""
        return list(results.snapshots(self.folder / output))[number]

    def ids(self, output):
        """Of the last snapshot."""
        return list(results.opened(self.folder / output).snapshots)[-1].particles["global_id"].values


class AmountsTest(InsertersTest):
    def test_700_per_second_are_7000_at_any_step_and_all_are_accounted_for(self):
        masses = []
        for step in ("2e-3", "3.3e-3"):
            self.run_text(DONE, RAIN, "out", f"time.step={step}")
            row, (_, fields) = self.last("out"), self.snapshot("out")
            self.assertEqual(row["inserters/rain/born"], 7000)
            self.assertEqual(row["step/particles"], 2 + 7000 - row["outlets/bottom/removed"])
            self.assertEqual(row["step/particles"], len(fields["mass"]))
            self.assertGreater(row["outlets/bottom/removed"], 6000)
            mass = fields["mass"][0]
            self.assertAlmostEqual(row["step/born_mass"] / mass, 7000, delta=1e-9)
            self.assertAlmostEqual(row["outlets/bottom/mass"] / mass, row["outlets/bottom/removed"], delta=1e-9)
            self.assertLess(abs(row["energy/balance_error"]), 1e-4 * row["energy/carried_in"])
            masses.append(row["step/born_mass"])
        self.assertEqual(*masses)

    def test_every_measure_ends_at_its_total(self):
        rate = "number_rate = 700\nend = 10\n"
        mass = 4 / 3 * np.pi * 0.002**3 * 1000
        for measure, born in (("number = 25", 25), ("number = 25\nend = 0.4", 25),
                              ("number = 25\nnumber_rate = 100", 25), ("mass_total = 1e-3", int(1e-3 / mass)),
                              ("mass_rate = 2e-3\nend = 0.4", int(8e-4 / mass)),
                              ("solid_fraction = 1e-6", int(0.5e-6 / (mass / 1000))),
                              ("number_rate = 100\nrate_times = [0.1, 0.2, 0.4]\nrate_factors = [0, 1, 0.5]", 20)):
            with self.subTest(measure=measure):
                self.run_text(DONE, RAIN.replace(rate, measure + "\n"), "out", "time.end=0.5")
                self.assertEqual(self.last("out")["inserters/rain/born"], born)

    def test_shares_are_exact_after_any_number_of_births(self):
        self.run_text(DONE, STILL, "out")
        counts = []
        for _, fields in results.snapshots(self.folder / "out"):
            light = np.count_nonzero(fields["material"] == 0)
            counts.append(len(fields["material"]))
            self.assertLess(abs(light - 0.6 * counts[-1]), 1)
        self.assertEqual(counts, [0, 16, 32, 48, 64, 80])

    def test_a_run_may_begin_without_any_particle(self):
        self.run_text(DONE, STILL, "out")
        rows = results.rows(self.folder / "out")
        self.assertTrue(np.isnan(rows[0]["particles/0/x"]))
        self.assertEqual([row["particles/0/x"] for row in rows[1:]], [rows[-1]["particles/0/x"]] * 5)
        self.assertTrue(np.isnan(rows[2]["particles/40/x"]) and np.isfinite(rows[3]["particles/40/x"]))
        self.assertTrue(np.isnan(rows[-1]["particles/400/x"]))
        self.assertIn("done", self.expect(DONE, "status", self.folder / "out").stdout)


class PositionsTest(InsertersTest):
    def test_particles_do_not_overlap_at_birth(self):
        self.run_text(DONE, STILL, "out", "inserters.discs.number_rate=400")
        self.assertEqual(self.last("out")["step/contacts"], 0)
        _, fields = self.snapshot("out")
        positions, radii = fields["position"], fields["radius"]
        self.assertGreater(len(radii), 150)
        self.assertTrue(np.any(positions[:, 0] < 0.3) and np.any(positions[:, 0] > 0.7))
        for i, j in itertools.combinations(range(len(radii)), 2):
            d = positions[i] - positions[j]
            d[0] -= round(d[0])
            self.assertGreaterEqual(np.hypot(d[0], d[1]), radii[i] + radii[j] + 0.004 - 1e-12)

    def test_a_stream_does_not_depend_on_steps_and_intervals(self):
        found = []
        for more in ("time.step=1e-3", "time.step=3.333e-4", "inserters.stream.interval=0.05"):
            self.run_text(DONE, STREAM, "out", more)
            found.append((self.ids("out"), self.snapshot("out")[1]))
        ids, expected = found[0]
        self.assertEqual(len(ids), 50)
        for other_ids, fields in found[1:]:
            np.testing.assert_array_equal(other_ids, ids)
            np.testing.assert_array_equal(fields["radius"], expected["radius"])
            # Free fall is exact in any steps. The place in the face is another random number where others are blocked.
            np.testing.assert_allclose(fields["position"], expected["position"], atol=1e-9)
            np.testing.assert_allclose(fields["velocity"], expected["velocity"], atol=1e-9)

    def test_distances_in_a_stream_are_those_of_its_rate_whether_its_face_moves_or_not(self):
        for carrier in ((), ('inserters.stream.on="nozzle"',)):
            for step in ("1e-3", "3.333e-4"):
                with self.subTest(carrier=carrier, step=step):
                    self.run_text(DONE, STREAM, "out", f"time.step={step}", *carrier, "gravity=[0.0,0.0]",
                                  "inserters.stream.interval=0.05")
                    x = np.sort(self.snapshot("out")[1]["position"][:, 0])
                    np.testing.assert_allclose(np.diff(x), 0.01, atol=1e-9)


class BlockedTest(InsertersTest):
    def test_particles_that_wait_are_born_later(self):
        self.run_text(DONE, CROWD, "out")
        rows = results.rows(self.folder / "out")
        self.assertGreater(max(row["inserters/rain/waiting"] for row in rows), 5)
        self.assertEqual(rows[-1]["inserters/rain/born"] + rows[-1]["inserters/rain/waiting"], 100)
        left = rows[-1]["inserters/rain/born"] - rows[-1]["outlets/bottom/removed"]
        self.assertEqual(rows[-1]["step/particles"], left)

    def test_dropped_particles_are_counted(self):
        self.run_text(DONE, CROWD, "out", "inserters.rain.blocked=drop")
        row = self.last("out")
        self.assertGreater(row["inserters/rain/dropped"], 5)
        self.assertEqual(row["inserters/rain/born"] + row["inserters/rain/dropped"], 100)
        self.assertEqual(row["inserters/rain/waiting"], 0)

    def test_a_limit_ends_the_run_with_a_checkpoint_from_which_another_deck_goes_on(self):
        for method in ("velocity-verlet", "hht"):
            for limit in ("blocked=error", "most_waiting=3"):
                with self.subTest(method=method, limit=limit):
                    settings = f"integrator.particles={method}", f"inserters.rain.{limit}"
                    message = self.run_text(FAILED, CROWD, "out", *settings).stderr
                    self.assertIn('inserter "rain" found no free position for', message)
                    self.assertIn("in 2 tries each", message)
                    checkpoint = self.folder / "out/checkpoint_failed.h5"
                    self.run_text(DONE, CROWD, "other", settings[0], "inserters.rain.tries=100",
                                  words=("--restart", checkpoint, "--allow-changes"))
                    row = self.last("other")
                    self.assertEqual(row["inserters/rain/born"] + row["inserters/rain/waiting"], 100)


class RestartTest(InsertersTest):
    def test_a_restart_in_the_middle_of_births_gives_the_same_bits(self):
        for method in ("velocity-verlet", "hht"):
            with self.subTest(method=method):
                given = (f"integrator.particles={method}",)
                self.run_text(DONE, CROWD, "whole", *given)
                self.run_text(DONE, CROWD, "half", *given, "time.end=0.31")
                self.assertGreater(self.last("half")["inserters/rain/waiting"], 0)
                restart = ("--restart", self.folder / "half/checkpoint_end.h5")
                self.run_text(DONE, CROWD, "rest", *given, words=restart)
                self.assertEqual(self.hash_of("rest"), self.hash_of("whole"))

    def test_adaptive_steps(self):
        given = "integrator.particles=hht", "time.control=adaptive"
        self.run_text(DONE, CROWD, "whole", *given)
        row = self.last("whole")
        self.assertEqual(row["inserters/rain/born"] + row["inserters/rain/waiting"], 100)
        self.run_text(DONE, CROWD, "half", *given, "time.end=0.3")
        restart = ("--restart", self.folder / "half/checkpoint.h5")
        self.run_text(DONE, CROWD, "rest", *given, words=restart)
        self.assertEqual(self.hash_of("rest"), self.hash_of("whole"))

    def test_ranks(self):
        self.run_text(DONE, CROWD, "out")
        for ranks in ("2", "4"):
            self.run_text(DONE, CROWD, "ranks", launcher=("mpirun", "--oversubscribe", "-n", ranks))
            self.assertEqual(self.hash_of("ranks"), self.hash_of("out"))

    def test_another_deck_goes_on_with_the_births(self):
        self.run_text(DONE, CROWD, "half", "time.end=0.31")
        restart = ("--restart", self.folder / "half/checkpoint_end.h5")
        refused = self.run_text(BAD_INPUT, CROWD, "rest", "inserters.rain.number_rate=100", words=restart).stderr
        self.assertIn("inserters.rain.number_rate: 200.0 -> 100.0", refused)
        for change in ("contact.pairs.0.stiffness=250.0", "inserters.rain.tries=50"):
            with self.subTest(change=change):
                self.run_text(DONE, CROWD, "rest", change, words=(*restart, "--allow-changes"))
                row = self.last("rest")
                self.assertEqual(row["inserters/rain/born"] + row["inserters/rain/waiting"], 100)


if __name__ == "__main__":
    unittest.main()
