"""rank_tables.py and scaling_model.py on numbers whose answer is known, and gpu_ranks.sh on CPU ranks, at small sizes.
Usage: BUILD=build/release python3 test_scaling.py"""

import csv
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

import rank_runs
import rank_tables
import scaling_model

HERE = pathlib.Path(__file__).resolve().parent
LIMIT = 300  # [s]
NETWORK = scaling_model.Network(8, 5e-6, 40e9)
TERMS = {"fixed": 20e-6, "per_particle": 150e-12, "per_message": 3e-6, "per_byte": 1 / 60e9, "per_level": 8e-6}
CHAIN = [(20, 2.5e-5), (1000, 1.1e-3), (10000, 1.6e-2)]
PER_FACE = 370.0


def known_model(**changes):
    values = {"terms": TERMS, "per_face": PER_FACE, "uneven": 1.0, "solve": [(b, 2 * s) for b, s in CHAIN],
              "coupling": 30e-6, "coupling_per_rank": 2e-6, "hidden": True, "network": NETWORK, **changes}
    return scaling_model.Model(**values)


def run_of(model, particles, ranks, bodies=0, noise=1.0):
    """What bed would write if steps took what the model says."""
    n = particles / ranks
    faces, messages = scaling_model.faces_and_messages(ranks)
    seconds = noise * model.step(n, ranks, bodies)
    kind = dict.fromkeys(rank_runs.KIND, "x") | {"backend": "cuda", "dimension": "3"}
    whole = {"bodies": bodies, "contacts": 0.7 * bodies, "ranks": ranks, "particles": particles, "list_builds": 1,
             "steps": 1000.0, "seconds_per_step": seconds, "fastest": seconds, "slowest": seconds, "mean": seconds}
    rank = dict.fromkeys(rank_runs.OF_RANK, 0) | {"owned": n, "receivers": messages, "device_bytes": 500.0 * n,
                                                  "halo_bytes": PER_FACE * faces * math.sqrt(n),
                                                  "mbs_correct": model.serial(bodies)}
    return rank_runs.Run(kind, whole, [rank | {"rank": r} for r in range(ranks)])


def runs_of(model, noise=lambda: 1.0):
    bare = [run_of(model, n * p, p, 0, noise()) for p in (1, 2, 4, 8) for n in (1e6, 4e6, 8e6, 16e6 / p)]
    with_bodies = [run_of(model, 8e6, p, 20, noise()) for p in (1, 2, 4, 8)]
    return bare + [run_of(model, 8e6, p, 0, noise()) for p in (1, 2, 4, 8)] + with_bodies


def write_csv(path, runs):
    names = [*rank_runs.KIND, *rank_runs.WHOLE, *rank_runs.OF_RANK]
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, names)
        writer.writeheader()
        for run in runs:
            for rank in run.of_rank:
                row = run.kind | run.whole | rank
                writer.writerow({name: int(row[name]) if rank_runs.WHOLE.get(name, rank_runs.OF_RANK.get(name)) is int
                                 else row[name] for name in names})


def chain_csv(path):
    path.write_text("commit,bodies,seconds_per_step,iterations,seconds_per_iteration\n" +
                    "".join(f"x,{b},{4 * s},4,{s}\n" for b, s in CHAIN))


class KeptTest(unittest.TestCase):
    """What the repository keeps of runs on GPUs is what its picture and its table of the model are of."""

    def test_the_kept_runs_give_the_kept_model(self):
        rows = scaling_model.measured.read(scaling_model.TABLE)
        runs, chain = rank_runs.kept(rows)
        self.assertEqual({run.ranks for run in runs}, {1, 2})
        self.assertEqual({run.bodies for run in runs}, {0, rank_runs.KEPT_BODIES})
        self.assertEqual([bodies for bodies, _ in chain], [20, 1000, 10000])
        model = scaling_model.fit(runs, chain, 2, NETWORK)
        self.assertLess(model.error, 0.15)
        table = {row["key"]: float(row["value"]) for row in rows
                 if row["key"].startswith("scaling_model/") and row["value"]}
        self.assertAlmostEqual(table["scaling_model/a message"], 1e6 * model.terms["per_message"], delta=0.01)
        self.assertAlmostEqual(table["scaling_model/exchange with a rank"], 1e6 * model.coupling_per_rank, delta=0.01)
        rate = table["scaling_model/1e+09 particles, 20 bodies/rate"]
        best = int(table["scaling_model/1e+09 particles, 20 bodies/fastest"])
        self.assertAlmostEqual(1 / model.step(1e9 / best, best, 20) / rate, 1, delta=1e-3)


class FitTest(unittest.TestCase):
    def test_exact_times_give_the_terms_back(self):
        known = known_model()
        model = scaling_model.fit(runs_of(known), CHAIN, 2, NETWORK)
        for name, value in TERMS.items():
            self.assertAlmostEqual(model.terms[name] / value, 1, 6, name)
        self.assertAlmostEqual(model.per_face / PER_FACE, 1, 9)
        self.assertLess(model.error, 1e-9)
        for bodies, seconds in known.solve:
            self.assertAlmostEqual(model.serial(bodies) / seconds, 1, 9)

    def test_what_bodies_cost_is_found_beside_the_solve(self):
        for hidden in (True, False):
            known = known_model(hidden=hidden)
            runs = runs_of(known)
            for run in runs:
                run.kind["backend"] = "cuda" if hidden else "cpu"
            model = scaling_model.fit(runs, CHAIN, 2, NETWORK)
            self.assertEqual(model.hidden, hidden)
            self.assertAlmostEqual(model.step(8e6, 8, 20) / known.step(8e6, 8, 20), 1, 4)
            self.assertAlmostEqual(model.coupling / known.coupling, 1, 4)
            self.assertAlmostEqual(model.coupling_per_rank / known.coupling_per_rank, 1, 4)

    def test_noisy_times_give_the_same_steps(self):
        known, numbers = known_model(), random.Random(3)
        model = scaling_model.fit(runs_of(known, lambda: numbers.uniform(0.99, 1.01)), CHAIN, 2, NETWORK)
        self.assertTrue(all(value >= 0 for value in model.terms.values()))
        self.assertLess(model.error, 0.02)
        for n, ranks in ((8e6, 1), (8e6, 8), (2e6, 8), (16e6, 2)):
            self.assertAlmostEqual(model.particles(n, ranks) / known.particles(n, ranks), 1, delta=0.02)

    def test_no_term_is_negative(self):
        # Steps that become shorter with messages and ranks: no term may say so.
        known = known_model(terms=TERMS | {"per_message": -1e-6, "per_level": -5e-6})
        model = scaling_model.fit([r for r in runs_of(known) if r.bodies == 0], CHAIN, 2, NETWORK)
        self.assertTrue(all(value >= 0 for value in model.terms.values()))
        self.assertIsNone(model.coupling_error)

    def test_the_limit_is_where_rank_0_takes_as_long(self):
        only_particles = dict.fromkeys(scaling_model.TERMS, 0.0) | {"per_particle": 1e-10}
        model = known_model(terms=only_particles, per_face=0.0, solve=[(20, 1e-5), (1000, 1e-3), (10000, 1e-2)],
                            coupling=0.0, coupling_per_rank=0.0,
                            network=scaling_model.Network(10**6, 1e-9, 1e18))
        self.assertEqual(model.limit(1000, lambda p: 0.999e9 / p), 100)
        self.assertEqual(model.limit(10000, lambda p: 0.999e9 / p), 10)
        self.assertIsNone(model.limit(20, lambda p: 1e9 / p))
        self.assertIsNone(model.limit(1000, lambda p: 2e7))
        self.assertEqual(model.limit(1000, lambda p: 1e6), 1)
        self.assertIsNone(model.limit(0, lambda p: 1.0))
        # What rank 0 takes for the exchange counts, too: 4e-3 p = 0.0999 / p at p = 5.
        model.coupling_per_rank = 4e-3
        self.assertEqual(model.limit(20, lambda p: 0.999e9 / p), 5)

    def test_the_most_steps_per_second_are_where_ranks_begin_to_cost_more_than_they_save(self):
        only_particles = dict.fromkeys(scaling_model.TERMS, 0.0) | {"per_particle": 1e-10}
        model = known_model(terms=only_particles, per_face=0.0, solve=[(20, 1e-9), (1000, 1e-9)], coupling=0.0,
                            coupling_per_rank=1e-5, network=scaling_model.Network(10**6, 1e-9, 1e18))
        # 0.1 / p + 1e-5 p is least at p = 100, and there both parts are alike.
        self.assertEqual(model.fastest(20, 1e9), 100)
        self.assertEqual(model.limit(20, lambda p: 1e9 / p), 100)
        self.assertEqual(model.fastest(0, 1e9), 1000)
        # A solve that takes longer than the particles' step gains nothing from more ranks.
        model.solve = [(20, 1e-2), (1000, 1e-2)]
        self.assertEqual(model.fastest(20, 1e9), 10)
        text = "\n".join(scaling_model.limits(model, 8e6, [1e9]))
        self.assertIn("20 bodies, 1,000 million particles in all: the limit from 10 rank(s) on (100 million "
                      "particles per rank); most steps per second, 99.01, on 10 rank(s) (100 million particles per "
                      "rank)", text)

    def test_boxes_of_a_square(self):
        faces_and_messages = {p: scaling_model.faces_and_messages(p) for p in (1, 2, 4, 8, 16, 1000)}
        self.assertEqual(faces_and_messages, {1: (0, 0), 2: (1, 1), 4: (2, 3), 8: (3, 5), 16: (4, 8), 1000: (4, 8)})


class FilesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="scree_scaling_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def model(self, *options):
        return subprocess.run([sys.executable, HERE / "scaling_model.py", self.folder / "ranks.csv", "--chain",
                               self.folder / "chain.csv", "--out", self.folder / "out", *options], text=True,
                              capture_output=True, timeout=LIMIT)

    def test_program(self):
        write_csv(self.folder / "ranks.csv", runs_of(known_model()))
        chain_csv(self.folder / "chain.csv")
        done = self.model()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("| per particle | 0.15 ns |", done.stdout)
        self.assertGreater((self.folder / "out/scaling_model.png").stat().st_size, 10000)
        with open(self.folder / "out/scaling_model.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        at = {(r["kind"], r["particles"], int(r["bodies"]), int(r["ranks"])): r for r in rows}
        self.assertAlmostEqual(float(at["weak", "8000000.0", 0, 1]["efficiency"]), 1)
        self.assertAlmostEqual(float(at["weak", "8000000.0", 10000, 8]["seconds_per_step"]) /
                               known_model().step(8e6, 8, 10000), 1, 3)
        self.assertEqual(at["strong", "64000000.0", 0, 1000]["within"], "False")

    def test_bad_input_is_named(self):
        chain_csv(self.folder / "chain.csv")
        runs = runs_of(known_model())

        def message(*options):
            done = self.model(*options)
            self.assertEqual(done.returncode, 1, done.stderr)
            return done.stderr

        self.assertIn("ranks.csv: No such file", message())
        write_csv(self.folder / "ranks.csv", runs[:1])
        self.assertIn("at least two sizes and two numbers of ranks", message())
        write_csv(self.folder / "ranks.csv", runs)
        self.assertIn("--backend cpu: allowed: cuda", message("--backend", "cpu"))
        text = (self.folder / "ranks.csv").read_text().splitlines()
        (self.folder / "ranks.csv").write_text("\n".join(text[:-1]))
        self.assertIn("ends within a run of 8 ranks", message())
        (self.folder / "ranks.csv").write_text(text[1] + "\n" + text[2])
        self.assertIn("ranks.csv:2: 'bodies'; must be a row of bed --csv", message())
        write_csv(self.folder / "ranks.csv", runs)
        (self.folder / "chain.csv").write_text("bodies\n3\n")
        self.assertIn("must be written by chain_scaling", message())

    def test_tables_have_the_efficiencies(self):
        model = known_model(terms=dict.fromkeys(scaling_model.TERMS, 0.0) | {"per_particle": 1e-9}, per_face=0.0)
        runs = [run_of(model, n, p, 0, 1 + 0.25 * (p > 1)) for n, p in ((1e6, 1), (2e6, 2), (1e6, 2))]
        write_csv(self.folder / "ranks.csv", runs)
        found = {kind: [(run.ranks, run.particles, efficiency) for run, efficiency in group]
                 for (kind, _), group in rank_tables.scalings(rank_runs.read_runs([self.folder / "ranks.csv"])).items()}
        self.assertEqual(found, {"Weak": [(1, 1000000, 1.0), (2, 2000000, 0.8)],
                                 "Strong": [(1, 1000000, 1.0), (2, 1000000, 0.8)]})
        text = rank_tables.report(runs)
        self.assertIn("| 500 |", text)  # memory per particle [B]

    def test_bodies_are_compared_with_the_hole_and_the_plain_bed(self):
        model = known_model()
        steps = {(0, 1e6): 2e-4, (0, 999000): 1.25e-4, (20, 999000): 2.5e-4}
        runs = [run_of(model, n, 1, bodies) for bodies, n in steps]
        for run in runs:
            run.whole["seconds_per_step"] = steps[run.bodies, run.particles]
        (row,) = rank_tables.bodies(runs)
        self.assertEqual(row[2:6], ["20", "14.0", "0.25", "1000"])
        self.assertEqual(row[7:], ["0.125", "1000", "100.0 %", "0.2", "1000", "25.0 %"])
        self.assertEqual(rank_tables.bodies(runs[1:]), [])

    def test_script(self):
        small = {"BACKEND": "cpu", "RANKS": "1 2", "WEAK": "10000", "STRONG": "20000", "BODIES": "10000",
                 "BODY_STEPS": "1000", "IMPLICIT": "10000", "MOVING": "500",
                 "SAMPLES": "--repeats 1 --seconds 0", "PYTHON": sys.executable,
                 "MODEL": "--weak 1e4 --strong 1e6"}
        parts = ["weak", "strong", "bodies", "implicit", "moving", "chain", "tables", "model"]
        done = subprocess.run([HERE / "gpu_ranks.sh", os.environ["BUILD"], self.folder / "out", *parts], text=True,
                              env=dict(os.environ, **small), capture_output=True, timeout=LIMIT)
        logs = "\n".join(path.read_text() for path in self.folder.glob("out/*.txt"))
        self.assertEqual(done.returncode, 0, done.stderr + logs)
        runs = rank_runs.read_runs([self.folder / "out/ranks.csv"])
        # On two ranks the beds of weak and strong are the same: the later one counts. Of bodies there are the plain bed
        # and the one with a hole.
        self.assertEqual(sorted((r.bodies, r.ranks) for r in runs), [(0, 1)] * 4 + [(0, 2)] * 3 + [(20, 1), (20, 2)])
        contacts = [run.contacts for run in runs if run.bodies > 0]
        self.assertGreater(contacts[0], 0)
        self.assertEqual(contacts[0], contacts[1])
        for run in runs:
            self.assertEqual(sum(run.of_all("owned")), run.particles)
            self.assertGreater(run.of_rank[-1]["contact_force"], 0)
            self.assertEqual(run.of_all("receivers"), [run.ranks - 1] * run.ranks)
        tables = (self.folder / "out/tables.md").read_text()
        for heading in ("Weak scaling, 10,000", "Strong scaling, 20,000", "What bodies cost", "integrator hht"):
            self.assertIn(heading, tables)
        moving = [line.split(" | ") for line in (self.folder / "out/moving.txt").read_text().splitlines()
                  if line.startswith("| 1 |") or line.startswith("| 2 |")]
        self.assertEqual(len(moving), 2)
        self.assertEqual(moving[0][-1], moving[1][-1])  # the state
        self.assertGreater(int(moving[1][5]), 0)  # changed their rank
        self.assertIn("from runs on 1, 2 ranks, beyond them extrapolated",
                      (self.folder / "out/scaling_model.md").read_text())

    def test_script_names_what_fails(self):
        done = subprocess.run([HERE / "gpu_ranks.sh", os.environ["BUILD"], self.folder / "out", "weak"], text=True,
                              env=dict(os.environ, BACKEND="cpu", RANKS="1", WEAK="1"), capture_output=True,
                              timeout=LIMIT)
        self.assertEqual(done.returncode, 1)
        self.assertIn("error: failed: 1 rank(s): --backend cpu --rebuild 0 --particles 1 --per-rank", done.stderr)


if __name__ == "__main__":
    unittest.main()
