from __future__ import annotations

import argparse
import csv
import os
import pathlib
import sys
import threading
import tomllib
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from scree.commands.arguments import count, positive
from scree.errors import ScreeError

if TYPE_CHECKING:
    from scree.calibration.materials import Grains
    from scree.calibration.runs import Measured, Plan
    from scree.calibration.search import Found, Parameter, Point, Target

TESTS = {"repose": "angle of a slope that remains on a ledge", "drum": "dynamic angle in a rotating drum",
         "shear": "friction angles and cohesion in direct shear",
         "uniaxial": "unconfined yield strength of a cohesive material"}
MET, NOT_MET = 0, 1  # exit codes
STEADY = 1.0  # largest change of a slope over the last fifth of a run [degrees]
FIRST = {"repose": "angle", "drum": "angle", "shear": "residual_angle", "uniaxial": "strength"}  # quantity of a target


def describe(parser: argparse.ArgumentParser) -> None:
    kinds = parser.add_subparsers(required=True, dest="kind", metavar="TEST")
    for name, text in TESTS.items():
        test = kinds.add_parser(name, help=text)
        add_common(test)
        test.add_argument("--deck", type=pathlib.Path, metavar="DECK",
                          help="a changed copy of the test's deck, with the same names")
        if name in ("shear", "uniaxial"):
            add_stresses(test)
    search = kinds.add_parser("search", help="two parameters that give wished values")
    add_common(search)
    add_stresses(search)
    search.add_argument("--vary", nargs="+", action="extend", required=True, metavar="KEY=LOW:HIGH",
                        help="a key of the contact of the grains with themselves, as friction=0.2:0.8, or the path of "
                             "a key of MATERIALS; two of them")
    search.add_argument("--target", nargs="+", action="extend", required=True, metavar="TEST=VALUE",
                        help="wished value, as repose=30, drum=35, shear=28 or shear.peak_angle=35; one or two of them")
    search.add_argument("--rounds", type=count, default=4,
                        help="largest number of sets after the first nine (default 4)")


def add_common(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("materials", type=pathlib.Path, metavar="MATERIALS",
                        help="deck with the grains in its first [[particles]], as those of input/materials")
    parser.add_argument("--seeds", type=count, default=3, help="number of random packings (default 3)")
    parser.add_argument("--set", nargs="+", action="extend", default=[], metavar="KEY=VALUE",
                        help="keys of the test's deck, as for scree run")
    parser.add_argument("--soften", type=positive, default=1.0, metavar="FACTOR",
                        help="factor on the moduli or stiffnesses, for longer steps; pull-off forces stay the same")
    parser.add_argument("--at-once", type=count, default=1, help="runs at a time (default 1)")
    parser.add_argument("--backend", choices=("auto", "cpu", "cuda"), default="auto")
    parser.add_argument("--program", type=pathlib.Path, metavar="SCREE",
                        help="default: $SCREE, scree on the PATH, or that of this repository")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FOLDER",
                        help="default results/calibrate/TEST_MATERIALS; finished runs in it are not repeated")


def add_stresses(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--stresses", type=positive, nargs="+", default=[], metavar="STRESS",
                        help="normal or consolidation stresses [Pa]; default: 50, 100 and 200 (uniaxial: 25, 50 and "
                             "100) times density of a grain x g x diameter")


def split(word: str, form: str) -> tuple[str, str]:
    key, sign, value = word.partition("=")
    if not (key and sign and value):
        raise ScreeError(f"{word}: must have the form {form}")
    return key, value


def setting(word: str) -> tuple[str, Any]:
    key, value = split(word, "KEY=VALUE")
    try:
        return key, tomllib.loads(f"value = {value}")["value"]
    except tomllib.TOMLDecodeError:
        return key, value


def number(text: str, word: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ScreeError(f"{word}: {text!r} is not a number") from None


def parameter(word: str) -> Parameter:
    from scree.calibration.search import Parameter

    key, span = split(word, "KEY=LOW:HIGH")
    low, sign, high = span.partition(":")
    if not sign:
        raise ScreeError(f"{word}: must have the form KEY=LOW:HIGH")
    found = Parameter(key, number(low, word), number(high, word))
    if not found.low < found.high:
        raise ScreeError(f"{word}: LOW must be below HIGH")
    return found


def target(word: str) -> Target:
    from scree.calibration.search import Target
    from scree.calibration.tests import TESTS as MEASURED

    name, value = split(word, "TEST=VALUE")
    test, _, quantity = name.partition(".")
    if test not in TESTS:
        raise ScreeError(f"{word}: {test} is no test; there are {', '.join(TESTS)}")
    quantity = quantity or FIRST[test]
    if quantity not in MEASURED[test].units:
        raise ScreeError(f"{word}: {test} has no {quantity}; it has {', '.join(MEASURED[test].units)}")
    return Target(test, quantity, number(value, word))


def plan_of(arguments: argparse.Namespace) -> Plan:
    from scree import program
    from scree.calibration.runs import Plan

    return Plan(program.required(arguments.program), threading.Semaphore(arguments.at_once), arguments.seeds,
                arguments.backend, tuple(getattr(arguments, "stresses", ())), tuple(map(setting, arguments.set)),
                getattr(arguments, "deck", None))


def folder_of(arguments: argparse.Namespace) -> pathlib.Path:
    found: pathlib.Path = arguments.output or pathlib.Path("results/calibrate") / (
        f"{arguments.kind}_{arguments.materials.stem}")
    return found


def shown(value: float) -> str:
    return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"


def with_spread(mean: float, spread: float, seeds: int) -> str:
    return f"{shown(mean)} +- {shown(spread)}" if seeds > 1 else shown(mean)


def write_values(path: pathlib.Path, measured: Measured) -> None:
    """One row per run."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file)
        names = list(measured.values[0][0])
        table.writerow(["seed", "run", *names])
        for seed, (runs, values) in enumerate(zip(measured.runs, measured.values), 1):
            table.writerows([seed, os.path.relpath(run.folder, path.parent), *each.values()]
                            for run, each in zip(runs, values))


def print_measured(name: str, measured: Measured) -> None:
    """Values of each run, if there are several per seed; the quantities; what they do not show."""
    from scree.calibration.tests import TESTS as MEASURED

    seeds = len(measured.quantities)
    if len(measured.values[0]) > 1:
        names = [each for each in measured.values[0][0] if each != "failed"]
        print("  ".join(["seed", *(f"{each:>14}" for each in names)]) + "  [Pa]")
        for seed, of_seed in enumerate(measured.values, 1):
            for each in of_seed:
                print("  ".join([f"{seed:4}", *(f"{shown(each[one]):>14}" for one in names)]))
    for quantity, unit in MEASURED[name].units.items():
        mean = with_spread(measured.mean(quantity), measured.spread(quantity), seeds)
        measure = "" if unit == "1" else f" {unit}"
        print(f"{quantity.replace('_', ' ')}: {mean}{measure} ({seeds} seed{'s' * (seeds > 1)})")
    if any(abs(each.get("change", 0.0)) > STEADY for of_seed in measured.values for each in of_seed):
        print("the slope still changes at the end of some runs; make them longer by --set time.end")
    if any(each.get("failed") == 0.0 for of_seed in measured.values for each in of_seed):
        print("some columns did not fail: their strength is above the printed value; apply more force by --set")


def print_warnings(measured: Measured) -> None:
    """Warnings of the runs, each once."""
    records = [run.record or {} for of_seed in measured.runs for run in of_seed]
    for each in dict.fromkeys(text for record in records for text in record.get("warnings", ())):
        print(f"warning: {each}", file=sys.stderr)


def run_test(arguments: argparse.Namespace, grains: Grains) -> int:
    from scree.calibration.plots import draw
    from scree.calibration.runs import measure

    folder = folder_of(arguments)
    measured = measure(arguments.kind, grains, plan_of(arguments), folder)
    print_warnings(measured)
    print_measured(arguments.kind, measured)
    write_values(folder / "measured.csv", measured)
    draw(arguments.kind, f"{arguments.materials.stem}: {TESTS[arguments.kind]}", measured, folder / "measured.png")
    print(f"runs, measured.csv and measured.png: {folder}")
    return MET


def print_point(parameters: Sequence[Parameter], targets: Sequence[Target], point: Point, seeds: int) -> None:
    words = [f"{each.key} = {each.at(share)}" for each, share in zip(parameters, point.shares)]
    words += [f"{each.name} {with_spread(mean, spread, seeds)}"
              for each, mean, spread in zip(targets, point.means, point.spreads)]
    print(", ".join(words), flush=True)


def write_points(path: pathlib.Path, parameters: Sequence[Parameter], targets: Sequence[Target],
                 points: Sequence[Point]) -> None:
    """One row per set, in the order of the runs."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file)
        names = [each.name for each in targets]
        table.writerow([*(each.key for each in parameters), *names, *(f"{name} spread" for name in names)])
        table.writerows([*(each.at(share) for each, share in zip(parameters, point.shares)), *point.means,
                         *point.spreads] for point in points)


def print_found(parameters: Sequence[Parameter], targets: Sequence[Target], found: Found, seeds: int) -> None:
    wished = ", ".join(f"{each.name} = {shown(each.value)} +- {shown(tolerance)}"
                       for each, tolerance in zip(targets, found.tolerances))
    print(f"{'meets' if found.met else 'nearest to'} {wished}:")
    print_point(parameters, targets, found.best, seeds)
    if not found.met:
        print("no set within the ranges of --vary meets the targets" if len(targets) > 1 else
              "the target is not met: measured values go from "
              f"{shown(min(each.means[0] for each in found.points))} to "
              f"{shown(max(each.means[0] for each in found.points))}")
    if len(targets) == 1 and found.curve:
        print("one target leaves a curve of sets; by the fitted polynomial these meet it, too:")
        for shares in found.curve:
            print("  " + ", ".join(f"{each.key} = {each.at(share)}" for each, share in zip(parameters, shares)))
        print("a second --target, of another test, picks one of them")


def run_search(arguments: argparse.Namespace) -> int:
    from scree.calibration import materials
    from scree.calibration.runs import measure
    from scree.calibration.search import Point, search

    parameters, targets = list(map(parameter, arguments.vary)), list(map(target, arguments.target))
    if len(parameters) != 2 or parameters[0].key == parameters[1].key:
        raise ScreeError(f"--vary: {len(parameters)} keys; a search needs two different ones")
    plan, folder = plan_of(arguments), folder_of(arguments)

    def point(shares: tuple[float, float]) -> Point:
        values = {each.key: each.at(share) for each, share in zip(parameters, shares)}
        grains = materials.softened(materials.read(arguments.materials, values), arguments.soften)
        own = folder / ",".join(f"{key}={value}" for key, value in values.items())
        measured = {test: measure(test, grains, plan, own / test) for test in {each.test: None for each in targets}}
        return Point(shares, tuple(measured[each.test].mean(each.quantity) for each in targets),
                     tuple(measured[each.test].spread(each.quantity) for each in targets))

    def tell(found: Point) -> None:
        print_point(parameters, targets, found, plan.seeds)

    print(f"9 sets of {' and '.join(each.key for each in parameters)}, then up to {arguments.rounds} more; "
          f"each is printed when its runs are done: {folder}", flush=True)
    found = search(targets, point, tell, arguments.rounds, arguments.at_once)
    print_found(parameters, targets, found, plan.seeds)
    write_points(folder / "sets.csv", parameters, targets, found.points)
    print(f"runs and sets.csv: {folder}")
    return MET if found.met else NOT_MET


def run(arguments: argparse.Namespace) -> int:
    """Angles and strengths of the grains of a materials file, or the parameters that give wished ones

    Puts the grains of MATERIALS into the deck of a test (input/calibration), runs it for several seeds and prints the
    measured values with their standard deviation. search varies two keys. The exit code is 1 if it meets no target.
    """
    from scree.calibration import materials

    if arguments.kind == "search":
        return run_search(arguments)
    return run_test(arguments, materials.softened(materials.read(arguments.materials), arguments.soften))
