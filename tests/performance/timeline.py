#!/usr/bin/env python3
"""The kernels of a few steps of a run in the order of their launches, with the duration of each: a table in Markdown.
Usage: timeline.py [--skip 4000] [--count 60] PROGRAM run DECK [--restart CHECKPOINT] ...
Needs ncu of the CUDA toolkit and a GPU. --skip, --count: launches before the first and number of launches of the table.
Nsight Compute runs one kernel after the other, so that the table shows what each takes alone; `scree run --trace` shows
what runs at the same time, and when the host waits."""

import argparse
import csv
import pathlib
import re
import subprocess
import sys
import tempfile

TIME, GRID, REGISTERS = "gpu__time_duration.sum", "launch__grid_size", "launch__registers_per_thread"


def short(kernel):
    """The name of a kernel, or of the item that for_each applies, without the laws."""
    if found := re.search(r"for_each_kernel<.*?(\w+Item)\b", kernel):
        return found[1]
    return re.search(r"(\w+)\s*(<|\()", kernel.replace("<unnamed>::", "").split("scree::", 1)[-1])[1]


def read_launches(path):
    """[(kernel, us, blocks, registers)] in the order of the launches."""
    rows = list(csv.reader(line for line in path.read_text().splitlines() if line.startswith('"')))
    if len(rows) < 3:
        raise SystemExit(f"error: {path}: no launches; a smaller --skip, or a longer run")
    of = {name: rows[0].index(name) for name in ("Kernel Name", TIME, GRID, REGISTERS)}

    def value(row, name):
        return float(row[of[name]].replace(",", ""))
    scale = {"ns": 1e-3, "nsecond": 1e-3, "us": 1, "usecond": 1}[rows[1][of[TIME]]]
    return [(short(row[of["Kernel Name"]]), scale * value(row, TIME), int(value(row, GRID)),
             int(value(row, REGISTERS))) for row in rows[2:]]


def table(launches):
    lines = ["| kernel | us | blocks | registers |", "|---|---|---|---|"]
    lines += [f"| {name} | {time:.1f} | {blocks} | {registers} |" for name, time, blocks, registers in launches]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--skip", type=int, default=4000)
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("command", nargs=argparse.REMAINDER, help="a program and its arguments")
    arguments = parser.parse_args()
    if not arguments.command:
        parser.error("the program is missing")
    with tempfile.TemporaryDirectory() as scratch:
        log = pathlib.Path(scratch) / "launches.csv"
        done = subprocess.run(
            ["ncu", "--clock-control", "none", "--cache-control", "none", "--metrics", f"{TIME},{GRID},{REGISTERS}",
             "--launch-skip", str(arguments.skip), "--launch-count", str(arguments.count), "--page", "raw", "--csv",
             "--log-file", str(log), *arguments.command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if done.returncode:
            sys.exit(f"error: ncu ended with {done.returncode}: {done.stderr.strip()[-500:]}")
        print(table(read_launches(log)))


if __name__ == "__main__":
    main()
