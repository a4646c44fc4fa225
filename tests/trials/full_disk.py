"""Runs that meet a full disk, at many sizes of it, and what they leave. Usage:

    full_disk.py SCREE [--trials N] [--seed N] [--tmpfs] [--ranks N]

Each trial runs a deck of particles and bodies where files, or all of them together (--tmpfs, which needs root), may
take so many bytes, a size drawn at random. The run must end with exit code 4 and one message that names a file of it,
or be done where there was room. What it has left must be readable and the beginning of what a run without limit
writes, and nothing may stand beside it; a restart from its last checkpoint, with room, must end in the state and the
files of that run. Prints a line for each trial; exits with 1 where one fails.
"""
import argparse
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import results  # noqa: E402

DECK = pathlib.Path(__file__).resolve().parents[1] / "ranks" / "dam_break.toml"
SETTINGS = ("integrator.particles=velocity-verlet", "integrator.substeps=3", "time.end=0.06",
            "output.snapshot_interval=0.003", "output.history_interval=0.0006", "output.checkpoint_interval=0.012",
            "output.history_csv=true", "output.contacts=true")
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1", OMPI_MCA_mpi_yield_when_idle="1")
DONE, IO_FAILED = 0, 4
LIMIT = 300  # [s] for a run: past it, it hangs
SERIES = ("particles.vtkhdf", "bodies.vtkhdf", "contacts.vtkhdf", "history.h5")


class Failed(Exception):
    """What a trial has shown to be wrong."""


def require(condition, *what):
    if not condition:
        raise Failed(" ".join(map(str, what)))


def run(arguments, folder, *words, file_size=None):
    """One run into the folder; its exit code and what it said as errors."""
    # Under mpirun, which has no limit: the MPI library keeps files, too. A write past the limit fails.
    limited = ["bash", "-c", f"ulimit -f {file_size // 1024}; trap '' XFSZ; exec \"$@\"", "bash"] if file_size else []
    command = ["mpirun", "-n", str(arguments.ranks), *limited, arguments.scree, "run", str(DECK), "--backend", "cpu",
               "--output", str(folder), *words]
    for setting in SETTINGS:
        command += ["--set", setting]
    done = subprocess.run(command, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                          timeout=LIMIT)
    return done.returncode, done.stderr


def state_hash(folder):
    return json.loads((folder / "run_record.json").read_text())["run"]["state_hash"]


def count_snapshots(file, name):
    steps, points = file["VTKHDF/Steps"], file["VTKHDF/NumberOfPoints"]
    last = steps["PointOffsets"][-1] + points[steps["PartOffsets"][-1]]
    require(last == len(file["VTKHDF/Points"]), name, "has other points than its snapshots")
    require(steps.attrs["NSteps"] == len(steps["Values"]), name, "has another number of snapshots")
    return len(steps["Values"])


def check_beginning(folder, whole):
    """What there is of the series is a beginning of the whole ones. Returns how many snapshots there are."""
    snapshots = 0
    for name in SERIES:
        if not (folder / name).exists():
            continue
        have, all_of_it = results.datasets(folder / name), results.datasets(whole / name)
        require(have.keys() == all_of_it.keys(), name, "lacks datasets")
        for dataset, values in have.items():
            expected = all_of_it[dataset][:len(values)]
            same = numpy.array_equal(values, expected, equal_nan=values.dtype.kind == "f")  # names have none
            require(same, name, dataset, "is not what was written")
        if name == "history.h5":
            require(len({len(values) for values in have.values()}) == 1, name, "has columns of different length")
        else:
            snapshots = max(snapshots, results.files.read(folder / name, lambda file: count_snapshots(file, name)))
    for path in folder.glob("*.xdmf"):
        require(path.read_text().endswith("</Xdmf>\n"), path.name, "is cut off")
    return snapshots


def trial(arguments, whole, folder, size):
    """Returns what happened, in words."""
    code, errors = run(arguments, folder, file_size=None if arguments.tmpfs else size)
    require(code in (DONE, IO_FAILED), "exit code", code, errors)
    left = {path.name for path in folder.iterdir()}
    beside = {name for name in left if name.endswith((".tmp", ".spare", ".old", ".lock"))}
    require(not beside, "left behind:", *beside)
    snapshots = check_beginning(folder, whole)
    if code == DONE:
        require(state_hash(folder) == state_hash(whole), "done, but in another state")
        return "room enough"
    messages = [line for line in errors.splitlines() if line.startswith("error: ")]
    require(len(messages) == 1, len(messages), "messages:", errors)
    require(str(folder) in messages[0], "no file is named:", messages[0])
    if arguments.tmpfs:
        subprocess.run(["mount", "-o", "remount,size=256m", str(folder)], check=True)
    checkpoint = folder / "checkpoint.h5"
    continued = checkpoint.exists()
    words = ["--restart", str(checkpoint)] if continued else ["--overwrite"]
    again, errors = run(arguments, folder, *words)
    require(again == DONE, *words, "ends with exit code", again, errors)
    require(state_hash(folder) == state_hash(whole), *words, "ends in another state")
    require(check_beginning(folder, whole) == check_beginning(whole, whole), *words, "ends with other snapshots")
    named = messages[0].split(str(folder) + "/")[-1].split(":")[0]
    return f"ended at {named} with {snapshots} snapshots, " + ("continued" if continued else "begun again")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scree")
    parser.add_argument("--trials", type=int, default=100, help="(default 100)")
    parser.add_argument("--seed", type=int, default=1, help="(default 1)")
    parser.add_argument("--tmpfs", action="store_true", help="a small file system each, not a limit to each file")
    parser.add_argument("--ranks", type=int, default=1, help="(default 1)")
    arguments = parser.parse_args()
    if arguments.ranks > 1 and not arguments.tmpfs:
        parser.error("--ranks needs --tmpfs: ranks share memory through files, which a limit would meet first")
    draw = random.Random(arguments.seed)
    failed = 0
    with tempfile.TemporaryDirectory(prefix="scree_full_disk_") as name:
        whole = pathlib.Path(name) / "whole"
        code, errors = run(arguments, whole)
        if code != DONE:
            sys.exit(f"the run without limit ends with exit code {code}: {errors}")
        sizes = [path.stat().st_size for path in whole.iterdir()]
        most = 2.2 * sum(sizes) if arguments.tmpfs else 1.1 * max(sizes)
        for number in range(arguments.trials):
            size = int(draw.uniform(0, most) if number % 2 else most ** draw.uniform(0.5, 1))  # the small ones, too
            folder = pathlib.Path(name) / str(number)
            folder.mkdir()
            size = max(size, 4096)
            if arguments.tmpfs:
                subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "scree_full_disk", str(folder)],
                               check=True)
            try:
                print(f"{size} bytes: {trial(arguments, whole, folder, size)}", flush=True)
            except Failed as error:
                failed += 1
                print(f"{size} bytes: FAILED: {error}", flush=True)
            finally:
                if arguments.tmpfs:
                    subprocess.run(["umount", str(folder)], check=True)
                subprocess.run(["rm", "-rf", str(folder)], check=True)
    print(f"{arguments.trials} trials, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
