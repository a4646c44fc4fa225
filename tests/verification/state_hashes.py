"""State hashes and histories of the cases that tests/ranks and same_bits.sh compare, one line each, to lay beside those
of another version of the program: a change that is meant to keep every bit keeps every line.
Usage: python3 state_hashes.py SCREE [SCREE ...] [--jobs N]; with several programs the lines that differ, and
exit code 1. Decks whose keys the first program does not know are not compared."""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
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


def line_of(program, name, deck, overrides):
    with tempfile.TemporaryDirectory(prefix="scree_hashes_") as folder:
        settings = [word for override in [*overrides, "output.history_csv=true"] for word in ("--set", override)]
        backend = os.environ.get("SCREE_TEST_BACKEND", "cpu")
        command = [program, "run", str(deck), "--backend", backend, "--output", folder, "--overwrite", *settings]
        code = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode
        if code == BAD_INPUT:
            return f"{name:40} {UNKNOWN}"
        if code != DONE:
            raise SystemExit(f"{program}: {name}: exit code {code}")
        record = json.loads((pathlib.Path(folder) / "run_record.json").read_text())
        history = hashlib.sha256((pathlib.Path(folder) / "history.csv").read_bytes()).hexdigest()
    bodies = " (bodies)" if "net" in str(deck) else ""
    return f"{name + bodies:40} {record['run']['state_hash']} {history[:16]}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", nargs="+")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        tables = [list(pool.map(lambda case: line_of(program, *case), all_cases())) for program in arguments.program]
    different = [f"{program}: {line}" for program, table in zip(arguments.program[1:], tables[1:])
                 for line, first in zip(table, tables[0]) if line != first and not first.endswith(UNKNOWN)]
    print(*tables[0], *different, sep="\n")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
