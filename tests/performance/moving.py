"""Steps of particles that move far: a column of spheres that collapses on several ranks, with lists built, particles
that change their rank, and boxes cut anew on the way. Prints a markdown table.

    moving.py SCREE [--particles N] [--ranks 1 2 ...] [--backend cuda|cpu] [--end SECONDS] [--mpirun "OPTIONS"]
"""
import argparse
import json
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import measured  # noqa: E402

DIAMETER, SPACING = 0.01, 0.0102  # [m]
STEP = 1e-5  # [s]
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")

DECK = """gravity = [0.0, -9.81, 0.0]
[space]
dimension = 3
min = [0.0, 0.0, 0.0]
max = [{length}, {length}, {width}]
x_min = "wall"
x_max = "wall"
y_min = "wall"
z_min = "periodic"
z_max = "periodic"
[integrator]
particles = "velocity-verlet"
[time]
end = {end}
step = {step}
control = "fixed"
[[contact.pairs]]
stiffness = 1e5
damping = 2.0
[[particles]]
name = "column"
kind = "lattice"
origin = [{half}, {half}, {half}]
spacing = [{spacing}, {spacing}, {spacing}]
size = [{side}, {side}, {side}]
radius = {radius}
density = 2500.0
random_velocity = 0.1
[output]
history_interval = {end}
"""


def write_deck(path, particles, end):
    side = round(particles ** (1 / 3))
    width = side * SPACING
    path.write_text(DECK.format(side=side, spacing=SPACING, half=SPACING / 2, radius=DIAMETER / 2, width=width,
                                length=3 * width, end=end, step=STEP))


def run(scree, deck, folder, backend, ranks=1, mpirun="", settings=()):
    """Runs the deck into the folder, with settings (key=value) of its keys; the run record."""
    words = ["mpirun", "--oversubscribe", *shlex.split(mpirun), "-n", str(ranks), scree, "run", str(deck), "--backend",
             backend, "--output", str(folder)]
    for setting in settings:
        words += ["--set", setting]
    done = subprocess.run(words, env=ENVIRONMENT, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"error: {' '.join(words)}: exit code {done.returncode}\n{done.stderr}")
    return json.loads((folder / "run_record.json").read_text())


def step_seconds(record):
    """Wall seconds per step of the loop, less the output within."""
    output = sum(stage["seconds"] for stage in record["stages"] if stage["stage"] == "output")
    return (record["cost"]["loop_seconds"] - output) / record["counts"]["steps"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scree")
    parser.add_argument("--particles", type=float, default=2e6, help="about so many (default 2e6)")
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--backend", choices=["cuda", "cpu"], default="cuda")
    parser.add_argument("--end", type=float, default=0.3, help="simulated time [s] (default 0.3)")
    parser.add_argument("--mpirun", default="", help="options of mpirun")
    arguments = parser.parse_args()
    print("| ranks | particles | steps | ms per step | lists built | changed their rank | boxes cut anew | "
          "largest imbalance | state |\n|" + "---|" * 9)
    with tempfile.TemporaryDirectory(prefix="scree_moving_") as name:
        folder = pathlib.Path(name)
        write_deck(folder / "moving.toml", arguments.particles, arguments.end)
        for ranks in arguments.ranks:
            record = run(arguments.scree, folder / "moving.toml", folder / str(ranks), arguments.backend, ranks,
                         arguments.mpirun)
            counts, measures = record["counts"], record["measures"]
            size = f"{arguments.backend}, {arguments.particles:g} particles"
            for name, value, unit in (("step", 1e3 * step_seconds(record), "ms"), ("lists", counts["list_builds"], ""),
                                      ("steps", counts["steps"], ""), ("moved", counts["migrated"], "")):
                measured.note(f"moving/{size}/{ranks} ranks {name}", value, unit, record=record)
            print(f"| {ranks} | {counts['particles']:,} | {counts['steps']:,} | "
                  f"{1e3 * step_seconds(record):.4g} | {counts['list_builds']:,} | "
                  f"{counts['migrated']:,} | {counts['rebalances']:,} | {100 * measures['largest_imbalance']:.0f} % | "
                  f"{record['run']['state_hash']} |", flush=True)


if __name__ == "__main__":
    sys.exit(main())
