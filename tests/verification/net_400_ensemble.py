"""Case 5.3 with 400 particles against the reference ensemble: energies at 0.4, 0.5, 0.6, 0.7, 0.8 and 1.0 s.

    python3 tests/verification/net_400_ensemble.py SCREE [--runs N] [--step H] [--shift S] [--seed K]

The case is chaotic: a change of 1e-10 grows by 1e6 up to 0.55 s and by 2e9 up to 1 s. So the reference is an ensemble,
48 runs whose free bodies and particles were moved at the start, at random, by up to 1e-6 m
(tests/reference/README.md), and this program makes its own of equal perturbations, for mean and spread belong to their
size. The means of the two must agree within three standard errors of their difference; where the reference's deviation
is not known they are only shown. Exit code 0 if all do.
"""

import argparse
import concurrent.futures
import math
import os
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile
import tomllib

import h5py

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


def moved(generator, place, shift):
    return [repr(x + generator.uniform(-shift, shift)) for x in place]


def write_deck(folder, step, shift, seed):
    """The deck with every body a table of its own, as a row's bodies cannot be moved one by one; its path."""
    deck = tomllib.loads(DECK.read_text())
    generator = random.Random(seed)
    net, cord, block = deck["bodies"][0], deck["spring_dampers"][0], deck["particles"][0]
    head = DECK.read_text().split("[[bodies]]")[0]
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


def energies(scree, step, shift, seed):
    """One run; {time: values of QUANTITIES}."""
    with tempfile.TemporaryDirectory() as folder:
        deck = write_deck(folder, step, shift, seed)
        subprocess.run([scree, "run", str(deck), "--output", f"{folder}/results", "--set", f"time.step={step}"],
                       check=True, stdout=subprocess.DEVNULL)
        with h5py.File(os.path.join(folder, "results/history.h5")) as history:
            times = history["step/time"][:]
            column = {name: values[:] for name, values in history["energy"].items()}
    out = {}
    for time in REFERENCE:
        row = abs(times - time).argmin()
        dissipated = column["dissipated_contacts"][row] + column["dissipated_force_elements"][row]
        out[time] = (column["kinetic"][row], column["gravitational"][row], column["elastic_force_elements"][row],
                     dissipated, column["total"][row])
    return out


def standard_error(reference, values):
    """Of the difference of the two means: one population, whose variance both ensembles tell; and the reference's
    digits."""
    _, deviation, digit = reference
    count = len(values)
    squares = (REFERENCE_RUNS - 1) * deviation**2 + (count - 1) * statistics.variance(values)
    variance = squares / (REFERENCE_RUNS + count - 2)
    return math.sqrt(variance * (1 / REFERENCE_RUNS + 1 / count) + digit**2 / 3)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scree")
    parser.add_argument("--runs", type=int, default=4)
    parser.add_argument("--step", default="1e-5")
    parser.add_argument("--shift", type=float, default=1e-6)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        jobs = [pool.submit(energies, arguments.scree, arguments.step, arguments.shift, arguments.seed + k)
                for k in range(arguments.runs)]
        runs = [job.result() for job in jobs]

    failures = 0
    print("  t [s]  quantity         reference (sd)          here (sd)      apart, in standard errors")
    for time, references in REFERENCE.items():
        for index, (name, reference) in enumerate(zip(QUANTITIES, references)):
            values = [run[time][index] for run in runs]
            mean, deviation = reference[0], reference[1]
            verdict = ""
            if deviation is not None:
                apart = (statistics.mean(values) - mean) / standard_error(reference, values)
                failures += abs(apart) > MOST_ERRORS
                verdict = f"{apart:5.1f}{'  NO' if abs(apart) > MOST_ERRORS else ''}"
            print(f"  {time:5.1f}  {name:13} {mean:10.3f} ({'' if deviation is None else deviation:>6}) "
                  f"{statistics.mean(values):10.3f} ({statistics.stdev(values):8.4f})   {verdict}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
