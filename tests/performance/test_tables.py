"""profile_table.py on launches whose table is known, and output_cost.py on the CPU, at a small size.
Usage: BUILD=build/release python3 test_tables.py"""

import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import profile_table

HERE = pathlib.Path(__file__).resolve().parent
LIMIT = 300  # [s]
STEP = "void scree::<unnamed>::step_kernel<(bool)1, scree::Laws>(scree::Request, double *)"
SORT = "void cub::CUB_200500::detail::radix_sort::OnesweepKernel<int, unsigned int>(int *)"


def write_launches(path, launches, metrics=profile_table.METRICS):
    """As Nsight Compute writes them: its own lines, names, units, rows. launches: [(kernel, {metric: text})]."""
    units = {profile_table.TIME: "ns"} | dict.fromkeys((profile_table.READ, profile_table.WRITE), "byte")
    with open(path, "w", newline="") as file:
        file.write("==PROF== Connected to process 1\n")
        writer = csv.writer(file, quoting=csv.QUOTE_ALL)
        writer.writerow(["ID", "Kernel Name", *metrics])
        writer.writerow(["", "", *(units.get(name, "%") for name in metrics)])
        for number, (kernel, values) in enumerate(launches):
            writer.writerow([number, kernel, *(values.get(name, "1") for name in metrics)])
        file.write("==PROF== Disconnected from process 1\n")


def launch(nanoseconds, megabytes, **stalls):
    """Warps take 20 cycles for an instruction; stalls: cycles of them."""
    values = dict.fromkeys(profile_table.STALLS.values(), "0") | {
        profile_table.TIME: f"{nanoseconds:,}", profile_table.READ: f"{750_000 * megabytes:,}",
        profile_table.WRITE: f"{250_000 * megabytes:,}", profile_table.LATENCY: "20"}
    return values | {profile_table.STALLS[name.replace("_", " ")]: str(cycles) for name, cycles in stalls.items()}


class Tables(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def rows(self, path):
        """{kernel: {column: cell}}"""
        done = subprocess.run([sys.executable, HERE / "profile_table.py", "--copy-bandwidth", "4000", path], text=True,
                              capture_output=True, timeout=LIMIT,
                              env=os.environ | {"SCREE_MEASURED": str(self.folder / "measured")})
        self.assertEqual(done.returncode, 0, done.stderr)
        cells = [line.strip("| ").split(" | ") for line in done.stdout.splitlines() if line.startswith("| ")]
        return {row[0]: dict(zip(cells[0], row, strict=True)) for row in cells[1:]}

    def test_kernels(self):
        path = self.folder / "case.csv"
        occupancy = profile_table.MEANS["occupancy [%]"]
        write_launches(path, [
            (STEP, launch(100_000, 200, long_scoreboard=12, lg_throttle=2, wait=1.9) | {occupancy: "40"}),
            (SORT, launch(100_000, 400)),
            (STEP, launch(300_000, 600, long_scoreboard=8, lg_throttle=6, wait=1.9) | {occupancy: "60"})])
        rows = self.rows(path)
        self.assertEqual(list(rows), ["`step_kernel<(bool)1, Laws>`", "`OnesweepKernel<int, unsigned int>`"])
        step, sort = rows.values()
        self.assertEqual((step["calls"], step["time [us]"], step["of all time [%]"]), ("2", "200.0", "80.0"))
        self.assertEqual((step["MB per call"], step["GB/s"], step["of copy [%]"]), ("400.00", "2000", "50"))
        self.assertEqual(step["occupancy [%]"], "55")
        self.assertEqual(step["stalls [%]"], "long scoreboard 45, lg throttle 25")
        self.assertEqual((sort["of copy [%]"], sort["stalls [%]"]), ("100", "-"))
        (file,) = (self.folder / "measured").iterdir()
        noted = {row["key"]: row["value"] + row["unit"] for row in profile_table.measured.read(file)}
        self.assertEqual([noted[f"profile/case, step_kernel/{name}"] for name in ("time", "of copy", "waits")],
                         ["200us", "50%", "45%"])

    def test_metrics_that_are_not_there(self):
        path = self.folder / "case.csv"
        hits = profile_table.MEANS["L1 hits [%]"]
        write_launches(path, [(STEP, launch(1000, 1) | {hits: "n/a"}), (STEP, launch(3000, 1) | {hits: "70"}),
                              (SORT, launch(1000, 1) | {hits: "n/a"})],
                       [*profile_table.NEEDED, hits])
        step, sort = self.rows(path).values()
        self.assertEqual((step["L1 hits [%]"], sort["L1 hits [%]"]), ("70", "-"))
        self.assertEqual((step["registers"], step["stalls [%]"]), ("-", "-"))

    def test_a_file_without_launches_is_named(self):
        path = self.folder / "case.csv"
        for text, message in (("==ERROR== Failed\n", "no table of launches"), (None, "fewer than profile.sh skips")):
            if text is None:
                write_launches(path, [])
            else:
                path.write_text(text)
            with self.assertRaisesRegex(SystemExit, f"{path}: .*{message}"):
                profile_table.table(path, 4000)

    def test_what_output_costs(self):
        command = [sys.executable, HERE / "output_cost.py", f"{os.environ['BUILD']}/scree", "--backend", "cpu",
                   "--particles", "1000"]
        done = subprocess.run([*command, "--steps", "60", "--snapshots", "2"], text=True, capture_output=True,
                              timeout=LIMIT)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = [line.strip("| ").split(" | ") for line in done.stdout.splitlines()[2:]]
        self.assertEqual([row[:3] for row in rows], [[name, "1,000", "60"] for name in (
            "no output", "snapshot every 20 steps", "a checkpoint")])
        self.assertEqual([row[4] for row in rows[1:]], ["2 snapshots", "1 checkpoint"])
        for row in rows:
            self.assertGreater(float(row[3]), 0)
        bad = subprocess.run([*command, "--steps", "61", "--snapshots", "2"], text=True, capture_output=True,
                             timeout=LIMIT)
        self.assertEqual(bad.returncode, 2)
        self.assertIn("--steps 61 --snapshots 2", bad.stderr)


if __name__ == "__main__":
    unittest.main()
