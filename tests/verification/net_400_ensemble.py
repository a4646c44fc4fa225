"""Case 5.3 with 400 particles against the reference ensemble: energies at 0.4, 0.5, 0.6, 0.7, 0.8 and 1.0 s.

    python3 tests/verification/net_400_ensemble.py SCREE [--runs N] [--step H] [--shift S] [--seed K]
    python3 tests/verification/net_400_ensemble.py SCREE --wrong

The case is chaotic: a change of 1e-10 grows by 1e6 up to 0.55 s and by 2e9 up to 1 s. So the reference is an ensemble,
48 runs whose free bodies and particles were moved at the start, at random, by up to 1e-6 m (tests/reference/README.md),
and this program makes its own of equal perturbations, for mean and spread belong to their size. Both are judged by the
reference's spread alone, so that a program that scatters passes no easier: the means must agree within three standard
errors of their difference, and the spread here may be no more than three times the reference's. Where that is not
known, it is at most the sum of those of what the quantity is made up of. Exit code 0 if all hold.

--wrong does the same, up to 0.5 s and with two runs each, with models that are wrong by a tenth in one parameter. Exit
code 0 if each of them fails.
"""

import argparse
import concurrent.futures
import math
import os
import pathlib
import random
import re
import statistics
import subprocess
import sys
import tempfile
import tomllib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import measured  # noqa: E402
import results  # noqa: E402

DECK = pathlib.Path(__file__).resolve().parents[2] / "input/paper/net_400.toml"
QUANTITIES = ("kinetic", "gravitational", "springs", "dissipated", "total")
REFERENCE_RUNS = 48
# {time [s]: (mean, standard deviation, half of the last digit given [J]) per quantity}; no deviation: not known.
REFERENCE = {
    0.4: ((2905.10, 0.17, 0.005), (1287.20, 0.003, 0.005), (75.844, 0.005, 5e-4), (60.231, 0.008, 5e-4),
          (4293.90, 0.008, 0.005)),
    0.5: ((3610, 22, 0.5), (-201.17, 1.23, 0.005), (668.9, 18.9, 0.05), (226.9, 4.7, 0.05), (4127.2, 4.7, 0.05)),
    0.6: ((3067, None, 0.5), (-1546, 12, 0.5), (1983, 39, 0.5), (729, 22, 0.5), (3625, 22, 0.5)),
    0.7: ((2789, None, 0.5), (-2376, 25, 0.5), (2570, 44, 0.5), (1284, 29, 0.5), (3070, 29, 0.5)),
    0.8: ((4067, None, 0.5), (-2688, 42, 0.5), (1257, 67, 0.5), (1660, 30, 0.5), (2694, 30, 0.5)),
    1.0: ((5599, None, 0.5), (-3121, 67, 0.5), (8.9, 3.4, 0.05), (1866, 32, 0.5), (2488, 32, 0.5)),
}
MOST_ERRORS = 3.0
MOST_SPREAD = 3.0  # times the reference's deviation: four runs of the same population have more once in 10,000
# Deliberate errors of a tenth: keys of write_deck's changes.
WRONG = ("cord stiffness", "cord damping", "contact stiffness", "contact damping")
WRONG_END = 0.5


def moved(generator, place, shift):
    return [repr(x + generator.uniform(-shift, shift)) for x in place]


def write_deck(folder, shift, seed, wrong):
    """Writes the deck with a table for every body, as a row's bodies cannot be moved one by one; returns its path."""
    deck = tomllib.loads(DECK.read_text())
    generator = random.Random(seed)
    net, cord, block = deck["bodies"][0], deck["spring_dampers"][0], deck["particles"][0]
    head = DECK.read_text().split("[[bodies]]")[0]
    if wrong is not None:
        part, key = wrong.split()
        table = cord if part == "cord" else deck["contact"]["pairs"][0]
        before, table[key] = table[key], 1.1 * table[key]
        head = head if part == "cord" else re.sub(rf"(?m)^{key} = \S+", f"{key} = {table[key]!r}", head)
        assert table[key] != before
    lines = [head]
    last = net["count"] - 1
    for k in range(net["count"]):
        place = [p + k * d for p, d in zip(net["position"], net["spacing"])]
        lines += ["[[bodies]]", f'name = "body{k}"', f"mass = {net['mass']}", f"inertia = {net['inertia']}",
                  f"shapes = [{{ radius = {net['shapes'][0]['radius']} }}]",
                  f"position = [{', '.join(moved(generator, place, 0 if k in (0, last) else shift))}]"]
    for name, body in (("left_pin", 0), ("right_pin", last)):
        lines += ["[[joints]]", f'name = "{name}"', 'type = "revolute"', f'bodies = ["ground", "body{body}"]']
    for k in range(last):
        lines += ["[[spring_dampers]]", f'name = "cord{k}"', f'bodies = ["body{k}", "body{k + 1}"]',
                  *(f"{key} = {cord[key]}" for key in ("stiffness", "damping", "free_length"))]
    columns, rows = block["size"]
    places = [[block["origin"][0] + i * block["spacing"][0], block["origin"][1] + j * block["spacing"][1]]
              for j in range(rows) for i in range(columns)]
    particles = pathlib.Path(folder) / "particles.csv"
    particles.write_text("x,y\n" + "".join(",".join(moved(generator, place, shift)) + "\n" for place in places))
    lines += ["[[particles]]", 'name = "block"', 'kind = "file"', f'file = "{particles.name}"',
              f"radius = {block['radius']}", f"mass = {block['mass']}",
              "[output]", "snapshot_interval = 1.0", "history_interval = 1e-3"]
    path = pathlib.Path(folder) / "deck.toml"
    path.write_text("\n".join(lines) + "\n")
    return path


def energies(arguments, seed, wrong=None):
    """One run; {time: values of QUANTITIES}. wrong: one of WRONG."""
    end = WRONG_END if wrong else max(REFERENCE)
    with tempfile.TemporaryDirectory() as folder:
        deck = write_deck(folder, arguments.shift, seed, wrong)
        subprocess.run([arguments.scree, "run", str(deck), "--output", f"{folder}/results", "--set",
                        f"time.step={arguments.step}", "--set", f"time.end={end}"],
                       check=True, stdout=subprocess.DEVNULL)
        history = results.columns(f"{folder}/results")
    times, column = history["step/time"], {name.removeprefix("energy/"): values for name, values in history.items()}
    out = {}
    for time in (time for time in REFERENCE if time <= end):
        row = abs(times - time).argmin()
        dissipated = column["dissipated_contacts"][row] + column["dissipated_force_elements"][row]
        out[time] = (column["kinetic"][row], column["gravitational"][row], column["elastic_force_elements"][row],
                     dissipated, column["total"][row])
    return out


def deviation_of(references, index):
    """Mean of the reference. The kinetic energy, where it is not known, is the total less the gravitational one and the
    springs', but for a small part in contacts."""
    if references[index][1] is not None:
        return references[index][1]
    return sum(references[QUANTITIES.index(name)][1] for name in ("total", "gravitational", "springs"))


def judge(runs):
    """Lines of a table, how many quantities differ from the reference, and by how much at most: standard errors, and
    spread over the reference's."""
    lines = ["  t [s]  quantity         reference (sd)          here (sd)      apart, in standard errors; spread"]
    failures, most_apart, most_spread = 0, 0, 0
    for time in runs[0]:
        for index, name in enumerate(QUANTITIES):
            mean, _, digit = REFERENCE[time][index]
            deviation = deviation_of(REFERENCE[time], index)
            values = [run[time][index] for run in runs]
            error = math.sqrt(deviation**2 * (1 / REFERENCE_RUNS + 1 / len(values)) + digit**2 / 3)
            apart = (statistics.mean(values) - mean) / error
            spread = statistics.stdev(values) / math.hypot(deviation, digit)
            fails = not (abs(apart) <= MOST_ERRORS and spread <= MOST_SPREAD)
            failures += fails
            most_apart, most_spread = max(most_apart, abs(apart)), max(most_spread, spread)
            lines.append(f"  {time:5.1f}  {name:13} {mean:10.3f} ({deviation:>6}) {statistics.mean(values):10.3f} "
                         f"({statistics.stdev(values):8.4f})   {apart:6.1f} {spread:6.2f}{'  NO' if fails else ''}")
    return lines, failures, most_apart, most_spread


def note(program, apart, spread):
    commit = measured.commit_of(program)
    measured.note("net_400/apart", apart, "standard errors", at_most=MOST_ERRORS, commit=commit)
    measured.note("net_400/spread", spread, at_most=MOST_SPREAD, commit=commit)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scree")
    parser.add_argument("--runs", type=int, help="default: 4; with --wrong 2")
    parser.add_argument("--step", default="1e-5")
    parser.add_argument("--shift", type=float, default=1e-6)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--wrong", action="store_true")
    arguments = parser.parse_args()
    arguments.runs = arguments.runs or (2 if arguments.wrong else 4)

    passed = True
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for wrong in WRONG if arguments.wrong else (None,):
            seeds = range(arguments.seed, arguments.seed + arguments.runs)
            runs = list(pool.map(lambda seed, wrong=wrong: energies(arguments, seed, wrong), seeds))
            lines, failures, apart, spread = judge(runs)
            passed = passed and (failures > 0) == (wrong is not None)
            if wrong:
                lines = [f"{wrong} larger by a tenth: {failures} of {len(lines) - 1} quantities differ"]
            print("\n".join(lines))
            if (arguments.runs, arguments.step, wrong) == (4, "1e-5", None):  # the case of the page
                note(arguments.scree, apart, spread)
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
