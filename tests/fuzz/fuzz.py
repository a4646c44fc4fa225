#!/usr/bin/env python3
"""Mutated decks, particle files and --set words, and damaged checkpoints: does the program end as it should?

    .venv/bin/python tests/fuzz/fuzz.py --scree build/release/scree [--seconds 60 | --count N] [--seed S]

Decks are those of input/ and of tests/fuzz/decks, which have every table. Each case is checked, and run for a few steps
where it is accepted; damaged checkpoints are restarted from. Counted are crashes, hangs, wrong exit codes, refusals
that do not say where, and messages that are not one printable line; the exit code is 1 unless all are zero. Cases
follow from --seed and their number: `--only NUMBER --keep DIR` makes one again and leaves it in DIR.
"""

import argparse
import collections
import concurrent.futures
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import threading
import time

import cases
import judge

SHOWN = 5  # findings of each kind that are printed in full


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scree", required=True, type=pathlib.Path)
    parser.add_argument("--seed", default="1")
    parser.add_argument("--seconds", type=float, default=60, help="of making cases (default: 60)")
    parser.add_argument("--count", type=int, help="number of cases, in place of --seconds")
    parser.add_argument("--only", type=int, help="number of the one case that is made")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the cases with findings")
    parser.add_argument("--kinds", nargs="+", choices=cases.KINDS, default=cases.KINDS, help="of cases (default: all)")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--memory", type=float, default=4, help="address space of the program [GB] (default: 4)")
    return parser.parse_args()


def make_checkpoints(program, maker, folder):
    """One of each own deck: restarts from it are what damaged ones are compared with."""
    for deck in cases.OWN:
        place = folder / deck.stem
        place.mkdir()
        for name, data in {**maker.files, "deck.toml": deck.read_bytes()}.items():
            (place / name).write_bytes(data)
        for words in ([], ["--restart", "kept.h5"]):
            ended = program.execute(place, ["run", "deck.toml", "--output", "out", *words])
            if ended.code != judge.DONE:
                sys.exit(f"fuzz.py: {deck} does not run: {ended.errors.decode()}")
            if not words:
                shutil.move(place / "out" / "checkpoint.h5", place / "kept.h5")
                shutil.rmtree(place / "out")
        maker.add_checkpoint(deck, (place / "kept.h5").read_bytes(), judge.read_hash(place))


class Tally:
    def __init__(self):
        self.lock = threading.Lock()
        self.made, self.accepted = collections.Counter(), collections.Counter()
        self.findings = {kind: [] for kind in judge.TROUBLES}
        self.slowest, self.largest = (0.0, 0), (0, 0)

    def add(self, number, case, verdict):
        kinds = case.kinds if case.kinds[0] in ("checkpoint", "particle_file") else ("deck", *case.kinds)
        with self.lock:
            for kind in set(kinds[1:]):
                self.made[f"{kinds[0]}: {kind}"] += 1
                self.accepted[f"{kinds[0]}: {kind}"] += verdict.accepted
            for trouble, what in verdict.troubles:
                self.findings[trouble].append((number, " ".join(case.kinds), what))
            self.slowest = max(self.slowest, (verdict.cpu, number))
            self.largest = max(self.largest, (verdict.memory, number))

    def print(self, count):
        print(f"{'mutation':44} {'cases':>7} {'accepted':>9}")
        for kind in sorted(self.made):
            print(f"{kind:44} {self.made[kind]:7} {self.accepted[kind]:9}")
        for trouble, found in self.findings.items():
            for number, kinds, what in found[:SHOWN]:
                print(f"{trouble}: case {number} ({kinds}): {what}")
        print(f"slowest check or restart {self.slowest[0]:.1f} s of CPU (case {self.slowest[1]}), "
              f"largest {self.largest[0] / 1e6:.0f} MB (case {self.largest[1]})")
        print(f"{count} cases: " + ", ".join(f"{len(found)} {trouble}" for trouble, found in self.findings.items()))


def main():
    arguments = parse_arguments()
    scree = arguments.scree.resolve()
    program = judge.Program(scree, int(arguments.memory * 2**30))
    manual = subprocess.run([str(scree), "keys"], env=program.environment, capture_output=True, text=True,
                            check=True).stdout
    maker, tally = cases.Maker(arguments.seed, manual, arguments.kinds), Tally()

    with tempfile.TemporaryDirectory(prefix="scree_fuzz_", ignore_cleanup_errors=True) as temporary:
        root = pathlib.Path(temporary)
        make_checkpoints(program, maker, root)

        def one(number):
            folder = root / f"case_{number}"
            folder.mkdir()
            case = maker.make(number)
            verdict = judge.judge(program, case, folder)
            tally.add(number, case, verdict)
            if arguments.keep and (verdict.troubles or arguments.only is not None):
                (folder / "case.json").write_text(json.dumps(
                    {"kinds": case.kinds, "words": case.words, "restart": case.restart, "troubles": verdict.troubles}))
                shutil.copytree(folder, arguments.keep / folder.name, dirs_exist_ok=True,
                                ignore=shutil.ignore_patterns("ompi.*"))
            shutil.rmtree(folder, ignore_errors=True)  # MPI may still be removing its own

        count = run_cases(one, arguments)
    tally.print(count)
    return 1 if any(tally.findings.values()) else 0


def run_cases(one, arguments):
    """Their number."""
    if arguments.only is not None:
        one(arguments.only)
        return 1
    until = time.monotonic() + arguments.seconds
    lock = threading.Lock()
    done = 0

    def work():
        nonlocal done
        while arguments.count or time.monotonic() < until:
            with lock:
                if arguments.count and done == arguments.count:
                    return
                number, done = done, done + 1
            one(number)

    with concurrent.futures.ThreadPoolExecutor(arguments.workers) as pool:
        for future in [pool.submit(work) for _ in range(arguments.workers)]:
            future.result()
    return done


if __name__ == "__main__":
    sys.exit(main())
