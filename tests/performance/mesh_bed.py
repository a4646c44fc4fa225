#!/usr/bin/env python3
"""A bed of spheres on an analytic plane, and on the same plane cut into triangles: time per step, and whether the
states have the same bits.
Usage: mesh_bed.py SCREE [--backend cuda] [--side 100] [--layers 100] [--steps 1000] [--edge 0.0107]
One layer: every sphere touches the floor, and no other."""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import measured  # noqa: E402

SPACING, LAYER = 0.021, 0.01995  # of the lattice [m]
DECK = """gravity = [0.0, 0.0, -9.81]
[space]
dimension = 3
min = [0.0, 0.0, -0.1]
max = [{width}, {width}, {height}]
x_min = "periodic"
x_max = "periodic"
y_min = "periodic"
y_max = "periodic"
[time]
end = {end}
step = 2e-5
[integrator]
particles = "velocity-verlet"
[[materials]]
name = "grain"
density = 2500.0
[[contact.pairs]]
stiffness = 1e4
restitution = 0.6
friction = 0.4
tangential_damping_ratio = 0.1
[[particles]]
name = "bed"
kind = "lattice"
origin = [0.0105, 0.0105, 0.00999]
spacing = [{spacing}, {spacing}, {layer}]
size = [{side}, {side}, {layers}]
radius = 0.01
random_velocity = 0.05
material = "grain"
[output]
history_interval = 0.01
"""
PLANE = '[[walls]]\nname = "floor"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n'
MESH = ('[[meshes]]\nname = "floor"\nkind = "rectangle"\nsize = [{size}, {size}]\noffset = [{middle}, {middle}, 0.0]\n'
        'refine = {edge}\n[[walls]]\nname = "floor"\nmesh = "floor"\n')


def deck(side, layers, steps):
    """The bed without a floor."""
    return DECK.format(width=SPACING * side, height=0.5 + 1.2 * LAYER * layers, end=2e-5 * steps, side=side,
                       layers=layers, spacing=SPACING, layer=LAYER)


def milliseconds(record, steps):
    """Of a step, without the start and output."""
    return f"{1e3 * sum(s['seconds'] for s in record['stages'] if s['stage'] != 'output') / steps:8.4f}"


def run(scree, backend, text):
    with tempfile.TemporaryDirectory(prefix="scree_mesh_bed_") as folder:
        path = pathlib.Path(folder) / "deck.toml"
        path.write_text(text)
        subprocess.run([scree, "run", path, "--backend", backend, "--output", folder, "--overwrite"], check=True,
                       stdout=subprocess.DEVNULL)
        return json.loads((pathlib.Path(folder) / "run_record.json").read_text())


def note(arguments, layers, name, record):
    seconds = {stage["stage"]: stage["seconds"] for stage in record["stages"]}
    size = f"{arguments.backend}, {arguments.side} x {arguments.side} x {layers}, edge {arguments.edge}"
    measured.note(f"mesh_bed/{size}/{name} step", 1e3 * seconds["contact_force"] / arguments.steps, "ms", record=record)
    measured.note(f"mesh_bed/{size}/{name} list", 1e3 * seconds["neighbors"] / max(record["counts"]["list_builds"], 1),
                  "ms", record=record)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scree")
    parser.add_argument("--backend", default="cpu")
    parser.add_argument("--side", type=int, default=100)
    parser.add_argument("--layers", type=int)
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--edge", type=float, default=0.0107)
    arguments = parser.parse_args()
    width, layers = SPACING * arguments.side, arguments.layers or arguments.side
    bed = deck(arguments.side, layers, arguments.steps)
    hashes = set()
    for name, wall in ("plane", PLANE), ("mesh", MESH.format(size=width + 0.3, middle=width / 2, edge=arguments.edge)):
        record = run(arguments.scree, arguments.backend, bed + wall)
        note(arguments, layers, name, record)
        seconds = {stage["stage"]: stage["seconds"] for stage in record["stages"]}
        hashes.add(record["run"]["state_hash"])
        print(f"{name:6} {1e3 * seconds['contact_force'] / arguments.steps:8.4f} ms a step, lists "
              f"{1e3 * seconds['neighbors']:8.2f} ms in all, {record['counts']['list_builds']} of them")
    print("the same state hash" if len(hashes) == 1 else "different state hashes")


if __name__ == "__main__":
    main()
