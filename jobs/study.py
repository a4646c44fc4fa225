#!/usr/bin/env python3
"""A parameter study from the list of its runs to the table of its results: the throughput of a conveyor.

From the root of the built repository, on a machine with SLURM:

    .venv/bin/python jobs/study.py write study.txt                          # one line per run: friction and speed
    sbatch --array=1-6 jobs/array.sbatch study.txt results/study
    .venv/bin/python jobs/study.py table study.txt results/study study.csv   # may be repeated during the runs

Without SLURM, two runs at a time (replaces the second line):

    .venv/bin/python jobs/study.py run study.txt results/study --at-once 2

For another study, copy this file and edit DECK, KEYS and MEASURES. The copy may be anywhere in the repository, or
anywhere at all if the package is installed (pip install ./postprocess).
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
    sys.exit(f"error: {HERE}: {error}. Run it with the repository's .venv/bin/python from inside the repository, or "
             "install the package: pip install REPOSITORY/postprocess")

DECK = "input/examples/conveyor.toml"
KEYS = {
    "contact.pairs.0.friction": [0.1, 0.3, 0.5],
    "walls.belt.surface_velocity": [[0.5, 0.0, 0.0], [1.0, 0.0, 0.0]],
}
MEASURES = {
    "escaped": lambda run: run.history["step/particles_escaped"][-1],  # particles that the belt has carried out
    "pull [N]": lambda run: np.mean(run.history["contacts/belt/fx"]),  # on the belt
    "work [J]": lambda run: run.history["energy/driver_work"][-1],
}


def write(arguments):
    common = {key: [value] for key, _, value in (setting.partition("=") for setting in arguments.set)}
    count = scree.sweep.write_list(arguments.list, DECK, KEYS | common)
    print(f"{arguments.list}: {count} runs")
    return 0


def run(arguments):
    failed = scree.sweep.run_local(arguments.list, arguments.results, at_once=arguments.at_once)
    for element, message in failed.items():
        print(f"{element}: {message}", file=sys.stderr)
    return 1 if failed else 0


def table(arguments):
    found = scree.sweep.table(arguments.list, arguments.results, MEASURES)
    found.to_csv(arguments.csv)
    print(found.to_string())
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for function, text in ((write, "write the list of runs"), (run, "run the list on this machine"),
                           (table, "tabulate the results as CSV")):
        command = commands.add_parser(function.__name__, help=text)
        command.add_argument("list", metavar="LIST", help="file with one line per run")
        command.set_defaults(function=function)
        if function is write:
            command.add_argument("--set", nargs="+", default=[], metavar="KEY=VALUE", help="settings of all runs")
        else:
            command.add_argument("results", metavar="RESULTS", help="folder of the results")
        if function is run:
            command.add_argument("--at-once", type=int, default=1, metavar="N", help="number of simultaneous runs")
        elif function is table:
            command.add_argument("csv", metavar="CSV")
    arguments = parser.parse_args()
    try:
        return arguments.function(arguments)
    except (scree.ScreeError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
