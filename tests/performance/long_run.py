#!/usr/bin/env python3
"""A long run of the drum with lifters and its motor: does the time per step, the memory or the energy balance drift,
and does a run that is stopped in its middle and restarted on another number of ranks end in the same state?
Usage: long_run.py SCREE [--backend cuda] [--particles 100000] [--steps 1000000] [--ranks 1] [--restart-ranks 2]
The first run takes all steps on --ranks ranks; the second one takes half of them there and the rest on
--restart-ranks ranks. A line per tenth of the first run; ends with an error where the two states differ."""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import tomllib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import measured  # noqa: E402

DECK = pathlib.Path(__file__).resolve().parents[2] / "input/examples/drum_lifters.toml"
# Of the deck: 800 grains with radii of 3.5 to 5 mm, 132 facets. The step below resolves contacts of this stiffness.
COUNT, SMALLEST, LARGEST, STIFFNESS, SEGMENTS = 800, 0.0035, 0.005, 2e4, 132
LARGEST_STEP = 1.8e-6 * (0.000325 / SMALLEST) ** -1.5 * (2000 / STIFFNESS) ** 0.5
TENTHS = 10


def settings(particles, steps):
    """The deck's settings for that many smaller particles, and the end of the run [s]."""
    scale = (COUNT / particles) ** (1 / 3)
    stiffness = STIFFNESS * scale
    step = LARGEST_STEP * scale ** 1.5 * (STIFFNESS / stiffness) ** 0.5
    end = steps * step
    values = {"particles.grains.count": particles, "particles.grains.radius.min": SMALLEST * scale,
              "particles.grains.radius.max": LARGEST * scale, "contact.pairs.0.stiffness": stiffness,
              "contact.pairs.1.stiffness": stiffness, "time.step": step, "time.end": end,
              "meshes.drum.segments": int(SEGMENTS / scale), "output.snapshot_interval": end,
              "output.history_interval": end / 100}
    return [word for key, value in values.items() for word in ("--set", f"{key}={value!r}")], end


def resident_bytes(process):
    """Of a process and its children [B]; processes that end meanwhile count as nothing."""
    try:
        children = pathlib.Path(f"/proc/{process}/task/{process}/children").read_text().split()
        pages = int(pathlib.Path(f"/proc/{process}/statm").read_text().split()[1])
    except OSError:
        return 0
    return pages * os.sysconf("SC_PAGE_SIZE") + sum(resident_bytes(child) for child in children)


def progress(folder):
    try:
        return tomllib.loads((folder / "status.toml").read_text())
    except (OSError, tomllib.TOMLDecodeError):
        return {}


def number_in(status, key):
    """A number anywhere in the status file."""
    for name, value in status.items():
        if name == key and not isinstance(value, dict):
            return value
        if isinstance(value, dict) and (found := number_in(value, key)) is not None:
            return found
    return None


def run(scree, ranks, words, folder, steps=None):
    """Runs to the end. With `steps`, prints a line per tenth of them."""
    launch = ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
    process = subprocess.Popen([*launch, scree, "run", *words, "--output", str(folder)], stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True)
    tenth, before = 1, (0, 0.0)
    while process.poll() is None:
        time.sleep(0.2)
        status = progress(folder)
        done, wall = number_in(status, "steps"), number_in(status, "wall_seconds")
        if steps and done and done >= tenth * steps / TENTHS and done > before[0]:
            error, exchanged = number_in(status, "balance_error"), number_in(status, "exchanged")
            print(f"  step {done:9d}: {1e6 * (wall - before[1]) / (done - before[0]):7.1f} us per step, "
                  f"{resident_bytes(process.pid) / 1e6:7.0f} MB of host memory, energy balance "
                  f"{abs(error or 0) / (exchanged or 1):.1e} of the energy exchanged", flush=True)
            before, tenth = (done, wall), int(done * TENTHS / steps) + 1
    if process.returncode:
        sys.exit(f"error: {scree} ended with {process.returncode}: {process.stderr.read().strip()[-800:]}")
    return json.loads((folder / "run_record.json").read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scree")
    parser.add_argument("--backend", default="cpu", choices=("cpu", "cuda"))
    parser.add_argument("--particles", type=int, default=100000)
    parser.add_argument("--steps", type=int, default=1000000)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--restart-ranks", type=int, default=2)
    arguments = parser.parse_args()
    words, end = settings(arguments.particles, arguments.steps)
    words = [str(DECK), "--backend", arguments.backend, *words]
    name = f"long_run/{arguments.backend}, {arguments.particles} particles, {arguments.steps} steps"
    with tempfile.TemporaryDirectory() as scratch:
        whole, parts = pathlib.Path(scratch) / "whole", pathlib.Path(scratch) / "parts"
        record = run(arguments.scree, arguments.ranks, words, whole, arguments.steps)
        print(f"  device memory at the end: {record['cost']['device_memory_kib'] / 1024:.0f} MiB")
        measured.note(f"{name}: step", 1e6 * record["cost"]["loop_seconds"] / arguments.steps, "us", record=record)
        run(arguments.scree, arguments.ranks, [*words, "--set", f"time.end={end / 2!r}"], parts)
        last = run(arguments.scree, arguments.restart_ranks,
                   [*words, "--restart", str(parts / "checkpoint_end.h5")], parts)
        hashes = [of["run"]["state_hash"] for of in (record, last)]
        print(f"  state {hashes[0]}; restarted on {arguments.restart_ranks} ranks in its middle: {hashes[1]}")
    if hashes[0] != hashes[1]:
        sys.exit("error: the restarted run ends in another state")


if __name__ == "__main__":
    main()
