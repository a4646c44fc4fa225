"""Shared parts of the scripts of this folder: decks, runs, results, bands, the command line.

A script has `decks(small)`, texts by name, and `show(folder, report)`, which measures and draws. Decks in units
of the grains' diameter and mass and of gravity (or of the pressure), in which the laws stand as they are: scree
takes them for SI.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import queue
import subprocess
import sys
import tempfile

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import measured  # noqa: E402
import results  # noqa: E402

REFERENCE = pathlib.Path(__file__).resolve().parents[2] / "reference/contact"


def subplots(*shape, **options):
    """A figure and its axes. The library is loaded for pictures only: runs need none."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot
    return matplotlib.pyplot.subplots(*shape, **options)


class Report:
    """Prints measured values beside their bands and counts those outside."""
    def __init__(self, picture):
        self.picture, self.checked, self.failed = pathlib.Path(picture), 0, 0

    def say(self, text):
        print(text, flush=True)

    def check(self, what, value, low, high, source):
        holds = bool(low <= value <= high)
        self.checked += 1
        self.failed += not holds
        print(f"{'ok  ' if holds else 'FAIL'} {what}: {value:.4g}, band {low:.4g} to {high:.4g} ({source})",
              flush=True)

    def has(self, folder, name):
        """Whether a case is complete; prints a line where it is not."""
        there = finished(folder, name)
        if not there:
            self.say(f"{name}: not run")
        return there

    def keep(self, folder, name, what, value, unit=""):
        """Writes a row of measured.csv for a run, to be collected by tests/support/measured.py."""
        record = json.loads((folder / name / "run_record.json").read_text())
        measured.note(f"bulk/{what}", float(value), unit, record=record)

    def draw(self, figure):
        figure.savefig(self.picture, dpi=110, bbox_inches="tight")
        print(f"drawn: {self.picture}")


def reference(name):
    """Columns of a table of tests/reference/contact by their names."""
    lines = [line for line in (REFERENCE / name).read_text().splitlines() if line and not line.startswith("#")]
    rows = [[float(field or "nan") for field in line.split(",")] for line in lines[1:]]
    return dict(zip(lines[0].split(","), numpy.array(rows).T))


def numbers(values):
    return "[" + ", ".join(f"{value:.9g}" for value in values) + "]"


def body(name, position, shapes, ground=True, mass=1e6):
    """A body of spheres or discs, (centre, radius) each, in its own frame, of the material "base";
    ground: fixed to the ground."""
    lines = [
        "[[bodies]]", f'name = "{name}"', f"position = {numbers(position)}", f"mass = {mass}",
        f"inertia = {1e3 * mass}", "shapes = ["
    ]
    lines += [
        f'  {{ radius = {radius:.9g}, offset = {numbers(centre)}, material = "base" }},'
        for centre, radius in shapes
    ]
    lines += ["]"]
    if ground:
        lines += ["[[joints]]", f'name = "{name}_holds"', 'type = "fixed"', f'bodies = ["ground", "{name}"]']
    return "\n".join(lines) + "\n"


def pairs(law, materials=("grain", "base")):
    """The materials, and one law between particles and of particles with the others, which do not touch each other."""
    text = "".join(f'[[materials]]\nname = "{name}"\n' for name in materials)
    for other in materials:
        text += f'[[contact.pairs]]\nmaterials = ["grain", "{other}"]\n{law.strip()}\n'
    others = [name for name in materials if name != "grain"]
    for place, one in enumerate(others):
        text += "".join(f'[[contact.pairs]]\nmaterials = ["{one}", "{other}"]\nstiffness = 0.0\n'
                        for other in others[place:])
    return text


def table(name, /, **keys):
    """A table of a deck; values as TOML has them."""
    return f"[{name}]\n" + "".join(f"{key} = {value}\n" for key, value in keys.items())


def output(name, snapshots, history, fields, /, **keys):
    """Compressed results of a case."""
    listed = "[" + ", ".join(f'"{field}"' for field in fields) + "]"
    return table("output",
                 directory=f'"{name}"',
                 snapshot_interval=snapshots,
                 history_interval=history,
                 fields=listed,
                 compression=9,
                 checkpoint_wall_interval=0,
                 **keys)


def history(folder, name):
    """Columns of a run's history by their path."""
    return results.columns(folder / name)


def snapshots(folder, name):
    """For each snapshot its time and fields: position and what the deck names, rows in the order of the ids."""
    return results.snapshots(folder / name)


def run(folder, name):
    """The run itself, for further fields of its snapshots."""
    return results.opened(folder / name)


def finished(folder, name):
    """Whether a run is complete: a stopped one has a record, too."""
    record = folder / name / "run_record.json"
    return record.exists() and json.loads(record.read_text())["run"]["exit_code"] == 0


def run_decks(folder, texts, arguments):
    """Writes the decks and runs those that have no results yet."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        (folder / f"{name}.toml").write_text(text)

    shown = os.environ.get("CUDA_VISIBLE_DEVICES", "")
    devices = shown.split(",") if shown else [str(device) for device in range(arguments.gpus)]
    gpus = queue.SimpleQueue()
    for job in range(arguments.jobs):
        gpus.put(devices[job % min(arguments.gpus, len(devices))])

    def run_one(name):
        gpu = gpus.get()
        try:
            with open(folder / f"{name}.log", "w", encoding="utf-8") as log:
                return subprocess.run(
                    [str(arguments.scree), "run", f"{name}.toml", "--overwrite", "--backend", arguments.backend],
                    cwd=folder,
                    env=os.environ if arguments.gpus == 1 else os.environ | {"CUDA_VISIBLE_DEVICES": gpu},
                    stdout=log,
                    stderr=subprocess.STDOUT).returncode
        finally:
            gpus.put(gpu)

    todo = [name for name in texts if not finished(folder, name)]
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        failed = [name for name, code in zip(todo, pool.map(run_one, todo)) if code != 0]
    for name in failed:
        print((folder / f"{name}.log").read_text()[-2000:])
        print(f"FAIL {name}: the run failed")
    return not failed


def main(description, decks, show, smoke):
    """The command line of a script. decks(): texts by name; show(folder, report); smoke(): (decks,
    check(folder, report))."""
    parser = argparse.ArgumentParser(description=description,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("decks", "run", "show", "smoke"))
    parser.add_argument("folder", nargs="?", type=pathlib.Path)
    parser.add_argument("--scree", default=os.environ.get("SCREE", "scree"))
    parser.add_argument("--backend", default="auto")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time")
    parser.add_argument("--gpus",
                        type=int,
                        choices=range(1, 17),
                        default=1,
                        metavar="N",
                        help="that the runs are shared out to")
    parser.add_argument("--only", default="", help="cases whose names have this in them")
    arguments = parser.parse_args()
    if os.sep in arguments.scree:
        arguments.scree = pathlib.Path(arguments.scree).resolve()
    if arguments.what == "smoke":
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            texts, check = smoke()
            report = Report(folder / "smoke.png")
            good = run_decks(folder, texts, arguments)
            if good:
                check(folder, report)
            return 0 if good and report.checked and not report.failed else 1
    if arguments.folder is None:
        parser.error("a folder is needed")
    folder = arguments.folder
    if arguments.what in ("decks", "run"):
        texts = {name: text for name, text in decks().items() if arguments.only in name}
        if arguments.what == "run":
            return 0 if run_decks(folder, texts, arguments) else 1
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in texts.items():
            (folder / f"{name}.toml").write_text(text)
        print("\n".join(texts))
        return 0
    report = Report(folder / f"{pathlib.Path(sys.argv[0]).stem}.png")
    show(folder, report)
    print(f"{report.checked} checks, {report.failed} failed")
    return 1 if report.failed or not report.checked else 0
