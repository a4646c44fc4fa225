#!/usr/bin/env python3
"""Table 4 and Fig. 15 of Jung, Jun, Sohn (2013), and the same case scaled to a million particles.

    table4.py SCREE --out DIR [--backends cpu cuda] [--sizes N ...] [--budget SECONDS]
    table4.py --plot-only DIR

Measures the time for one simulated second, implicit at the paper's h = 1e-3 s and explicit at h = 1e-5 s with the
bodies every 1e-4 s. Materials, springs and block are those of input/paper/table4.toml. Up to 900 particles that is the
deck itself, from rest. Larger cases have about sqrt(N / 900) nets side by side and a block as many times wider and
higher; they begin at the impact, the block a hundredth of a diameter above the nets with the speed of its fall.

A run that takes longer than --budget is stopped; what it has simulated is the window of that case, and of the backends
after it. The time for one second is then the time per simulated second of the window. It is the wall time of the step
loop, from the run record, less the output within. The wall time of the whole run, start and files included, stands
beside it.

Writes DIR/table4.csv, a row after each run: the same command again goes on where it was stopped. Then DIR/table4.md
and, where there is matplotlib, DIR/table4.png. --plot-only draws the picture alone:

    table4.py --plot-only postprocess/pictures
"""
import argparse
import csv
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import time
import tomllib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import figures  # noqa: E402
import measured  # noqa: E402

DECK = pathlib.Path(__file__).resolve().parents[2] / "input/paper/table4.toml"
PAPER_SIZES = list(range(100, 901, 50))
SCALED_SIZES = [10_000, 100_000, 1_000_000]
# The paper's times for one second at N = 900: its program on the CPU, and on the GPU [s].
PAPER_TIMES = {"cpu": 150.1, "cuda": 31.8}
METHODS = {
    "implicit": {"time.step": "1e-3"},
    "explicit": {"time.step": "1e-4", "integrator.particles": "velocity-verlet", "integrator.substeps": "10"},
}
COLUMNS = ["method", "particles", "nets", "bodies", "start", "backend", "status", "simulated", "steps", "newton",
           "linear", "stepping_seconds", "wall_seconds", "cpu_seconds", "seconds_per_second", "commit", "processor",
           "description"]
START_SECONDS = 600  # for a large deck to be read, before --budget begins
STOP_SECONDS = 600  # for the last step and the files of a stopped run
POLL_SECONDS = 1e-3  # between looks at the files of a run


def nets_for(particles):
    return max(1, round(math.sqrt(particles / 900)))


def write_scaled_deck(path, particles):
    """The paper's deck with more nets and a larger block of the same density, at the moment of impact."""
    paper = tomllib.loads(DECK.read_text())
    law, net, cord, block = paper["contact"]["pairs"][0], paper["bodies"][0], paper["spring_dampers"][0], \
        paper["particles"][0]
    gravity, dx, dy = -paper["gravity"][1], *block["spacing"]
    nets = nets_for(particles)
    columns = block["size"][0] * nets
    rows = -(-particles // columns)
    radius = block["radius"] + net["shapes"][0]["radius"]
    low = net["position"][1] + radius + 0.02 * block["radius"]
    speed = math.sqrt(2 * gravity * (block["origin"][1] - low))
    left = -(columns - 1) * dx / 2
    side = paper["space"]["max"][0] + block["origin"][0]  # free space beside the block
    lines = [
        f'title = "Table 4 scaled: {nets} nets and {particles} particles"', f"gravity = {paper['gravity']}",
        "[space]", "dimension = 2", f"min = [{left - side}, {paper['space']['min'][1]}]",
        f"max = [{-left + side}, {max(3.0, low + rows * dy)}]", 'leaving = "ballistic"',
        "[time]", f"end = {paper['time']['end']}", f"step = {paper['time']['step']}", 'control = "fixed"',
        "[integrator]", 'particles = "hht"', f"hht_alpha = {paper['integrator']['hht_alpha']}",
        "[[contact.pairs]]", f"stiffness = {law['stiffness']}", f"damping = {law['damping']}",
        f"limit_damping = {str(law['limit_damping']).lower()}",
    ]
    for k in range(nets):
        x = left + (k + 0.5) * block["size"][0] * dx - dx / 2 - (net["count"] - 1) * net["spacing"][0] / 2
        lines += ["[[bodies]]", f'name = "net{k}"', f"count = {net['count']}",
                  f"position = [{x}, {net['position'][1]}]", f"spacing = {net['spacing']}",
                  f"mass = {net['mass']}", f"inertia = {net['inertia']}",
                  f"shapes = [{{ radius = {net['shapes'][0]['radius']} }}]",
                  "[[spring_dampers]]", f'name = "cord{k}"', f'chain = "net{k}"', f"stiffness = {cord['stiffness']}",
                  f"damping = {cord['damping']}", f"free_length = {cord['free_length']}"]
        for end in (0, net["count"] - 1):
            lines += ["[[joints]]", f'name = "pin{k}_{end}"', 'type = "revolute"',
                      f'bodies = ["ground", "net{k}.{end}"]']
    lines += ["[[particles]]", 'name = "block"', 'kind = "lattice"', f"origin = [{left}, {low}]",
              f"spacing = {block['spacing']}", f"size = [{columns}, {rows}]", f"count = {particles}",
              f"radius = {block['radius']}", f"mass = {block['mass']}", f"velocity = [0.0, {-speed}]"]
    path.write_text("\n".join(lines) + "\n")


def run_case(arguments, method, particles, backend, window):
    """One run, stopped after the budget; window: simulated time to end at [s]. Returns the row."""
    folder = arguments.out / "runs" / f"{method}_{particles}_{backend}"
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.iterdir():  # of an earlier try
        old.unlink()
    from_rest = particles <= PAPER_SIZES[-1]
    deck = DECK
    settings = dict(METHODS[method]) | {"time.end": repr(window), "output.history_interval": "1",
                                        "output.snapshot_interval": "0"}
    if from_rest:
        settings["particles.block.count"] = str(particles)
    else:
        deck = folder / "deck.toml"
        write_scaled_deck(deck, particles)
    command = [arguments.scree, "run", str(deck), "--output", str(folder), "--backend", backend]
    for key, value in settings.items():
        command += ["--set", f"{key}={value}"]
    status = run_for(command, folder, arguments.budget)
    row = {"method": method, "particles": particles, "nets": nets_for(particles), "backend": backend, "status": status,
           "start": "rest" if from_rest else "impact"}
    if status == "done":
        row |= read_record(folder / "run_record.json")
    for large in folder.glob("*.h5"):  # snapshots and checkpoints of a million particles
        large.unlink()
    return row


def run_for(command, folder, budget):
    """Runs the command, with a signal to stop after the budget, which begins with the first step. Returns the
    status."""
    start = signalled = None
    begun = time.monotonic()
    with open(folder / "log", "w") as log:
        process = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT)
        try:
            while process.poll() is None:
                now = time.monotonic()
                if start is None and (folder / "run_record.json").exists():
                    start = now
                if start is None and now > begun + START_SECONDS:
                    return f"failed: not set up after {START_SECONDS} s"
                if start is not None and signalled is None and now > start + budget:
                    process.send_signal(signal.SIGTERM)
                    signalled = now
                if signalled is not None and now > signalled + STOP_SECONDS:
                    return f"failed: did not stop within {STOP_SECONDS} s of the signal"
                time.sleep(POLL_SECONDS)
        finally:
            if process.poll() is None:
                process.kill()
                process.wait()
    if process.returncode not in (0, 5):  # done, stopped by a signal
        return f"failed: exit code {process.returncode}; see {folder.name}/log"
    return "done"


def read_record(path):
    record = json.loads(path.read_text())
    counts, simulated = record["counts"], record["measures"]["simulated_time"]
    if not counts["steps"]:
        return {"status": "failed: no step within the budget"}
    output = sum(stage["seconds"] for stage in record["stages"] if stage["stage"] == "output")
    stepping = record["cost"]["loop_seconds"] - output
    return {"bodies": counts["bodies"], "simulated": simulated, "steps": counts["steps"],
            "newton": counts["newton_iterations"], "linear": counts["linear_iterations"],
            "stepping_seconds": stepping, "wall_seconds": record["cost"]["wall_seconds"],
            "cpu_seconds": record["cost"]["cpu_seconds"], "seconds_per_second": stepping / simulated,
            "commit": record["build"]["commit"], "processor": record["host"]["processor"],
            "description": record["run"]["backend"]}


def read_rows(folder):
    path = folder / "table4.csv"
    if not path.exists():
        return []
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        row["particles"] = int(row["particles"])
        for name in ("simulated", "stepping_seconds", "wall_seconds", "cpu_seconds", "seconds_per_second", "steps",
                     "newton", "linear"):
            row[name] = float(row[name]) if row[name] else None
    return rows


def append_row(folder, row):
    path = folder / "table4.csv"
    new = not path.exists()
    with open(path, "a", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        if new:
            writer.writeheader()
        writer.writerow(row)
        file.flush()
        os.fsync(file.fileno())


def measure(arguments):
    for particles in arguments.sizes:
        for method in METHODS:
            for backend in arguments.backends:
                rows = [row for row in read_rows(arguments.out)
                        if row["method"] == method and row["particles"] == particles and row["status"] == "done"]
                if any(row["backend"] == backend for row in rows):
                    continue
                window = min((row["simulated"] for row in rows), default=1.0)
                row = run_case(arguments, method, particles, backend, window)
                append_row(arguments.out, row)
                done = "seconds_per_second" in row
                result = f"{row['seconds_per_second']:.4g} s per second" if done else row["status"]
                print(f"{method:8} N = {particles:7} {backend:4}: {result}", flush=True)


def note(row, key, value, unit):
    gpu = row["description"].removeprefix("cuda (").split(",")[0]
    measured.note(f"table4/{key}", value, unit, commit=row["commit"], backend=row["backend"],
                  machine=gpu if row["backend"] == "cuda" else row["processor"])


def finished(rows):
    """{(method, backend): [row in order of N]} of the last run of each case."""
    last = {(row["method"], row["backend"], row["particles"]): row for row in rows if row["status"] == "done"}
    series = {}
    for (method, backend, _), row in sorted(last.items()):
        series.setdefault((method, backend), []).append(row)
    return series


def crossover(cpu, gpu):
    """N from which on the GPU is the faster; between measured sizes on a straight line of the logarithms."""
    times = {row["particles"]: row["seconds_per_second"] for row in gpu}
    ratios = [(row["particles"], math.log(times[row["particles"]] / row["seconds_per_second"]))
              for row in cpu if row["particles"] in times]
    for (n0, r0), (n1, r1) in reversed(list(zip(ratios, ratios[1:]))):
        if r0 > 0 >= r1:
            return n0 * (n1 / n0) ** (r0 / (r0 - r1))
    return None


def markdown(rows):
    series = finished(rows)
    lines = ["Time for one simulated second. start: from rest, as the paper, or at the impact; simulated: the window "
             "that was run; stepping and whole run: wall time within it.", ""]
    for row in sorted({(r["backend"], r["description"], r["processor"], r["commit"])
                       for group in series.values() for r in group}):
        lines.append("- {}: {}; host {}; commit {}".format(*row))
    lines += ["", "| method | N | nets | start | backend | simulated [s] | Newton / step | linear / step "
              "| stepping [s] | whole run [s] | CPU [s] | for one second [s] | CPU / GPU |", "|" + "---|" * 13]
    for (method, backend), group in series.items():
        cpu = {row["particles"]: row for row in series.get((method, "cpu"), [])}
        for row in group:
            note(row, f"{method}, {backend}/{row['particles']}", row["seconds_per_second"], "s")
            base = cpu.get(row["particles"]) if backend != "cpu" else None
            gain = f"{base['seconds_per_second'] / row['seconds_per_second']:.3g}" if base else ""
            lines.append(f"| {method} | {row['particles']:,} | {row['nets']} | {row['start']} | {backend} "
                         f"| {row['simulated']:.4g} | {row['newton'] / row['steps']:.1f} "
                         f"| {row['linear'] / row['steps']:.1f} | {row['stepping_seconds']:.3g} "
                         f"| {row['wall_seconds']:.3g} | {row['cpu_seconds']:.3g} "
                         f"| {row['seconds_per_second']:.3g} | {gain} |")
    lines.append("")
    for method in METHODS:
        n = crossover(series.get((method, "cpu"), []), series.get((method, "cuda"), []))
        if n:
            note(series[method, "cuda"][-1], f"{method}/crossover", float(n), "particles")
            lines.append(f"The GPU is the faster from about N = {n:,.0f} on, {method}.")
    lines.append(f"The paper at N = 900: {PAPER_TIMES['cpu']} s on its CPU, {PAPER_TIMES['cuda']} s on its GPU.")
    failed = [row for row in rows if row["status"] != "done"]
    lines += [f"Not measured: {row['method']}, N = {row['particles']}, {row['backend']}: {row['status']}."
              for row in failed
              if all(r["particles"] != row["particles"] for r in series.get((row["method"], row["backend"]), []))]
    return "\n".join(lines) + "\n"


def plot(path, rows):
    colors, word = {"cpu": figures.CPU, "cuda": figures.GPU}, {"cpu": "one core", "cuda": "GPU"}
    figure, axes = figures.subplots(figsize=(11, 6.6))
    series = finished(rows)
    for (method, backend), group in series.items():
        line = "-" if method == "implicit" else "--"
        for start, fill in (("rest", "white"), ("impact", colors[backend])):
            part = [row for row in group if row["start"] == start]
            axes.plot([row["particles"] for row in part], [row["seconds_per_second"] for row in part], line, marker="o",
                      markersize=6, linewidth=2, color=colors[backend], markerfacecolor=fill)
        last = group[-1]
        others = [each[-1]["seconds_per_second"] for key, each in series.items() if key[1] == backend]
        upper = last["seconds_per_second"] == max(others)
        figures.beside(axes, last["particles"], last["seconds_per_second"], f"{word[backend]}, {method}",
                       colors[backend], (10, 6 if upper else -6))
    for backend, seconds in PAPER_TIMES.items():
        axes.plot([900], [seconds], "*", color=colors[backend], markersize=16)
        whose = "CPU" if backend == "cpu" else "GPU"
        figures.beside(axes, 900, seconds, f"the paper's {whose}: {seconds:g} s", colors[backend], (-12, 0), ha="right")
    found = [n for method in METHODS
             if (n := crossover(series.get((method, "cpu"), []), series.get((method, "cuda"), [])))]
    if found:
        axes.axvspan(min(found), max(found), color="#d9d9d9", zorder=0)
        axes.annotate("from here on the GPU\nis the faster", (max(found), 0.03), (8, 0), textcoords="offset points",
                      xycoords=("data", "axes fraction"), fontsize=figures.SMALL, color=figures.PALE)
    axes.set(xscale="log", yscale="log", xlim=(80, 6e6))
    axes.set_xticks([10**k for k in range(2, 7)], ["100", "1,000", "10,000", "100,000", "1 million"])
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:,g}")
    figures.label(axes, "Open: from rest, as in the paper; filled: more nets side by side, from the impact on",
                  "particles", "time for one simulated second [s]")
    figures.save(figure, path, "Particles that fall on a net (Table 4 of Jung, Jun and Sohn, 2013)")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scree", nargs="?", help="the program")
    parser.add_argument("--out", type=pathlib.Path, metavar="DIR", help="folder for the results")
    parser.add_argument("--backends", nargs="+", choices=["cpu", "cuda"], default=["cpu"])
    parser.add_argument("--sizes", nargs="+", type=int, default=PAPER_SIZES + SCALED_SIZES, metavar="N")
    parser.add_argument("--budget", type=float, default=60, metavar="SECONDS", help="per run (default: 60)")
    parser.add_argument("--plot-only", type=pathlib.Path, metavar="DIR", help="DIR/table4.png anew from DIR/table4.csv")
    arguments = parser.parse_args()
    folder = arguments.plot_only or arguments.out
    if not arguments.plot_only:
        if not arguments.scree or not arguments.out:
            parser.error("SCREE and --out DIR are needed, or --plot-only DIR")
        if bad := [n for n in arguments.sizes if n < 1 or n > 900 and n < 1000]:
            parser.error(f"--sizes {bad[0]}: must be 1 to 900, as in the paper, or 1000 and more, scaled")
        folder.mkdir(parents=True, exist_ok=True)
        measure(arguments)
    rows = read_rows(folder)
    if not rows:
        parser.error(f"{folder}/table4.csv: has no rows")
    text = markdown(rows)
    if not arguments.plot_only:
        (folder / "table4.md").write_text(text)
    try:
        plot(folder / "table4.png", rows)
    except ImportError as error:
        print(f"no figure: {error}; table4.py --plot-only {folder} draws it where there is matplotlib")
    failed = [row for row in rows if row["status"] != "done"]
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
