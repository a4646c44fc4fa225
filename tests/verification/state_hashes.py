"""State hashes and histories of the cases that tests/ranks and same_bits.sh compare, one line each, to lay beside those
of another version of the program: a change that is meant to keep every bit keeps every line.
Usage: python3 state_hashes.py SCREE [SCREE ...] [--jobs N] [--motion]; with several programs the lines that differ, and
exit code 1. Decks whose keys the first program does not know are not compared. --motion, which needs h5py: in place of
the hashes one of the numbers in the last checkpoint without those of the energy balance, for programs that measure the
balance otherwise."""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
os.environ.setdefault("SCREE", "")
sys.path.insert(0, str(HERE.parent / "ranks"))
from mpi_case import BAD_INPUT, DONE, EXPLICIT, INPUT  # noqa: E402
from test_ranks import CASES  # noqa: E402

TARGETS = "output.history_contacts=['net','net.9']"
SAME_BITS = {
    "5.1 net": ["paper/net", "time.end=1"],
    "5.2 valley, 1 ms": ["paper/valley", "time.end=1", "time.step=1e-3"],
    "5.2 valley, 0.1 ms": ["paper/valley", "time.end=0.8", "time.step=1e-4"],
    "5.3 N = 9": ["paper/net_9", "time.end=0.5", "time.step=1e-4"],
    "5.3 N = 400": ["paper/net_400", "time.end=0.7", "time.step=5e-4", TARGETS],
    "5.3 N = 400, explicit": ["paper/net_400", "time.end=0.7", "time.step=1e-4", *EXPLICIT, "integrator.substeps=10",
                              TARGETS],
    "heap": ["examples/heap_900", "time.end=0.125", "output.history_contacts=['x_min','y_min']"],
    "gas": ["examples/gas_periodic", "time.end=0.0625"],
}


def all_cases():
    yield from ((name, deck, overrides) for name, ((deck, *overrides), _) in CASES.items())
    for name, (deck, *overrides) in SAME_BITS.items():
        yield name, INPUT / f"{deck}.toml", [*overrides, "output.history_interval=1e-3"]


UNKNOWN = "its deck is refused"


def motion_hash(folder):
    import h5py  # of .venv

    numbers = {}
    with h5py.File(next(pathlib.Path(folder).glob("checkpoint*.h5"))) as file:
        file.visititems(lambda name, of: numbers.update({name: of[()]}) if isinstance(of, h5py.Dataset) else None)
    digest = hashlib.sha256()
    for name in sorted(numbers):
        if not re.search(r"^texts/|/balance/|drifting_|least_kinetic|most_kinetic", name):
            digest.update(name.encode() + numbers[name].tobytes())
    return digest.hexdigest()[:16]


def line_of(program, name, deck, overrides, motion):
    with tempfile.TemporaryDirectory(prefix="scree_hashes_") as folder:
        settings = [word for override in [*overrides, "output.history_csv=true"] for word in ("--set", override)]
        backend = os.environ.get("SCREE_TEST_BACKEND", "cpu")
        command = [program, "run", str(deck), "--backend", backend, "--output", folder, "--overwrite", *settings]
        process = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        code = process.returncode
        if code == BAD_INPUT:
            return f"{name:40} {UNKNOWN}"
        if code != DONE:
            raise SystemExit(f"{program}: {name}: exit code {code}: {process.stderr.strip()[-800:]}")
        record = json.loads((pathlib.Path(folder) / "run_record.json").read_text())
        bodies = " (bodies)" if "net" in str(deck) else ""
        if motion:
            return f"{name + bodies:40} {motion_hash(folder)}"
        history = hashlib.sha256((pathlib.Path(folder) / "history.csv").read_bytes()).hexdigest()
    return f"{name + bodies:40} {record['run']['state_hash']} {history[:16]}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", nargs="+")
    parser.add_argument("--motion", action="store_true")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        tables = [list(pool.map(lambda case: line_of(program, *case, arguments.motion), all_cases()))
                  for program in arguments.program]
    different = [f"{program}: {line}" for program, table in zip(arguments.program[1:], tables[1:])
                 for line, first in zip(table, tables[0]) if line != first and not first.endswith(UNKNOWN)]
    print(*tables[0], *different, sep="\n")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
