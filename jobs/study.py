#!/usr/bin/env python3
"""A parameter study from the list of its runs to the table of its results: how fast a conveyor carries grains away.

From the root of the built repository, on a machine with SLURM:

    .venv/bin/python jobs/study.py write study.txt                          # a line for each run: friction and speed
    sbatch --array=1-6 jobs/array.sbatch study.txt results/study
    .venv/bin/python jobs/study.py table study.txt results/study study.csv   # again and again while they go on

Without SLURM, two at a time, in place of the second line:

    .venv/bin/python jobs/study.py run study.txt results/study --at-once 2

A study of another deck is a copy of this file with other words in capitals: anywhere in the repository, or anywhere at
all where the package is installed (pip install ./postprocess).
"""

import argparse
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve()
PACKAGES = [above / "postprocess" for above in HERE.parents if (above / "postprocess/scree/__init__.py").exists()]
sys.path[:0] = map(str, PACKAGES[:1])

try:
    import numpy as np

    import scree
except ModuleNotFoundError as error:
    sys.exit(f"error: {HERE}: {error}. Start it by the repository's .venv/bin/python from a place in it, or install "
             "the package: pip install REPOSITORY/postprocess")

DECK = "input/examples/conveyor.toml"
KEYS = {
    "contact.pairs.0.friction": [0.1, 0.3, 0.5],
    "walls.belt.surface_velocity": [[0.5, 0.0, 0.0], [1.0, 0.0, 0.0]],
}
MEASURES = {
    "left": lambda run: run.history["step/left"][-1],  # particles that the belt has carried out
    "pull [N]": lambda run: np.mean(run.history["contacts/belt/fx"]),  # on the belt
    "work [J]": lambda run: run.history["energy/driver_work"][-1],
}


def write(words):
    same = {key: [value] for key, _, value in (setting.partition("=") for setting in words.set)}
    count = scree.sweep.write_list(words.list, DECK, KEYS | same)
    print(f"{words.list}: {count} runs")
    return 0


def run(words):
    failed = scree.sweep.run_local(words.list, words.results, at_once=words.at_once)
    for element, message in failed.items():
        print(f"{element}: {message}", file=sys.stderr)
    return 1 if failed else 0


def table(words):
    found = scree.sweep.table(words.list, words.results, MEASURES)
    found.to_csv(words.csv)
    print(found.to_string())
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for function, text in ((write, "the list of runs"), (run, "them on this machine"), (table, "their table, a CSV")):
        command = commands.add_parser(function.__name__, help=text)
        command.add_argument("list", metavar="LIST", help="file with a line for each run")
        command.set_defaults(function=function)
        if function is write:
            command.add_argument("--set", nargs="+", default=[], metavar="KEY=VALUE", help="the same in all runs")
        else:
            command.add_argument("results", metavar="RESULTS", help="folder of their results")
        if function is run:
            command.add_argument("--at-once", type=int, default=1, metavar="N")
        elif function is table:
            command.add_argument("csv", metavar="CSV")
    words = parser.parse_args()
    try:
        return words.function(words)
    except (scree.ScreeError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
