"""jobs.py on the CPU, a few steps of each job.
Usage: BUILD=build/release python3 test_jobs.py"""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import job_cases
import jobs

HERE = pathlib.Path(__file__).resolve().parent
BUILD = pathlib.Path(os.environ.get("BUILD", "build/release")).resolve()
LIMIT = 600  # [s]


class Jobs(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def call(self, *words):
        """The exit code, the rows of the table as {column: cell}, and all that was printed."""
        done = subprocess.run([sys.executable, HERE / "jobs.py", BUILD / "scree", "--backend", "cpu", *map(str, words)],
                              text=True, capture_output=True, timeout=LIMIT,
                              env=os.environ | {"SCREE_MEASURED": str(self.folder / "measured")})
        lines = [line.strip("| ").split(" | ") for line in done.stdout.splitlines() if line.startswith("| ")]
        rows = [dict(zip(jobs.COLUMNS, line, strict=True)) for line in lines[1:]]
        return done.returncode, rows, done.stdout + done.stderr

    def test_every_job(self):
        code, rows, text = self.call("--quick", "--time-limit", 500, "--bed", BUILD / "tests/performance/bed")
        self.assertEqual(code, 0, text)
        names = [row["job"] for row in rows]
        self.assertEqual([name for name in names if "bed" not in name and "net" not in name],
                         [job.name for job in job_cases.quick_jobs()])
        for name in "bed 1e4, friction", "frictionless bed 1e4", "net of 20 1e4":
            self.assertIn(name, names)
        for row in rows:
            self.assertGreater(float(row["us per step"]), 0)
            self.assertGreater(float(row["of bed"]), 0)
        floors = {row["job"]: row for row in rows if row["job"].startswith("floor")}
        # A mesh at rest has the bits of the plane that it covers, and moving ones others.
        self.assertEqual(floors["floor, plane"]["state"], floors["floor, mesh at rest"]["state"])
        self.assertEqual(len({row["state"] for row in floors.values()}), 3)
        noted = {row["key"] for path in (self.folder / "measured").iterdir() for row in jobs.measured.read(path)}
        for name in names:
            self.assertIn(f"jobs/cpu/{name}/step", noted)
        self.assertIn("jobs/cpu/excavator 5e3, digging/mbs_correct", noted)

    def test_programs_and_ranks_by_turns(self):
        code, rows, text = self.call("--quick", "--only", "excavator 5e3, digging", "--ranks", 1, 2, "--old",
                                     BUILD / "scree", "--keep", self.folder)
        self.assertEqual(code, 0, text)
        self.assertEqual([(row["program"], row["ranks"]) for row in rows],
                         [("new", "1"), ("1", "1"), ("new", "2"), ("1", "2")])
        self.assertEqual(len({row["state"] for row in rows}), 1)
        self.assertIn("all states agree", text)
        self.assertEqual(len(list(self.folder.glob("*/checkpoint_end.h5"))), 1)

    def test_timelines(self):
        code, _, text = self.call("--quick", "--only", "excavator 5e3, digging", "--ranks", 2, "--trace", self.folder)
        self.assertEqual(code, 0, text)
        done = subprocess.run([sys.executable, HERE / "trace_table.py", *self.folder.glob("*.json")], text=True,
                              capture_output=True, timeout=LIMIT, check=True)
        rows = [line.strip("| ").split(" | ") for line in done.stdout.splitlines()[2:]]
        self.assertEqual({(row[0], row[1]) for row in rows},
                         {("excavator_5e3_digging_2_ranks", rank) for rank in ("0", "1")})
        calls = {row[2]: float(row[5]) for row in rows if row[1] == "0"}
        self.assertEqual((calls["contact_force"], calls["between"]), (1, 0))
        self.assertGreaterEqual(calls["mbs_correct"], 2)
        for row in rows:
            self.assertGreaterEqual(float(row[3]), float(row[4]))

    def test_runs_that_take_too_long_stop(self):
        for ranks in 1, 2:
            for limit in 4, 16, 64:  # the start may take longer beside other work
                code, rows, text = self.call("--only", "excavator 5e3, to 2 s", "--sizes", 5000, "--ranks", ranks,
                                             "--time-limit", limit)
                if rows:
                    break
            self.assertEqual(code, 0, text)
            self.assertEqual([row["state"] for row in rows], ["stopped"], text)
            self.assertGreater(int(rows[0]["steps"]), 0)

    def test_a_settling_that_was_stopped_goes_on(self):
        words = ("--only", "excavator 5e3, digging", "--sizes", 5000, "--time-limit", 1, "--settle", 1.5, "--keep",
                 self.folder)
        for _ in range(2):
            code, rows, text = self.call(*words)
            self.assertEqual((code, rows), (1, []), text)
            self.assertIn("stopped after 1.5 s, before it begins at 0.45 s", text)
        (record,) = self.folder.glob("*/run_record.json")
        self.assertEqual(len(jobs.json.loads(record.read_text())["starts"]), 2)

    def test_what_the_budget_leaves_is_named(self):
        code, rows, text = self.call("--quick", "--only", "drum", "--budget", 0)
        self.assertEqual((code, rows), (1, []))
        self.assertIn("not timed: drum 800, 1 ranks: the time of --budget is over", text)

    def test_sizes(self):
        chosen = {job.name for job in jobs.chosen(jobs.parse(["scree", "--sizes", "1e6"]))}
        self.assertEqual(chosen, {"excavator 1e6, digging", "excavator 1e6, falling", "drum 1e6", "wheel 1e6",
                                  "screw 1e6"})
        (named,) = jobs.chosen(jobs.parse(["scree", "--only", "excavator 1e6, to 1.5 s"]))
        self.assertEqual(named.settings["particles.bed.radius.min"], 0.00205)
        self.assertEqual(jobs.bed_sizes(jobs.parse(["scree", "--only", "drum", "--sizes", "1e6"]), [named]), [1000000])


if __name__ == "__main__":
    unittest.main()
