#!/usr/bin/env python3
"""A bed of spheres on an analytic plane, and on the same plane cut into triangles: time per step, and whether the
states have the same bits.
Usage: mesh_bed.py SCREE [--backend cuda] [--side 100] [--layers 100] [--steps 1000] [--edge 0.0107] [--ranks 1]
                   [--unevenness 0]
One layer: every sphere touches the floor, and no other. --ranks 1 2: the bed on one rank, and one twice as long on
two, each with a GPU of its own (weak scaling). --unevenness 2e-5: the floor's vertices lie up to so many metres below
the plane, as in a curved wall: no two triangles are in one plane, and their edges and corners are touched, too."""

import argparse
import json
import math
import pathlib
import subprocess
import sys
import tempfile
from random import Random

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import measured  # noqa: E402

SPACING, LAYER = 0.021, 0.01995  # of the lattice [m]
RADIUS, SKIN = 0.01, 0.2  # of the spheres [m]; the skin that a deck gets without a word, in radii
DECK = """gravity = [0.0, 0.0, -9.81]
[space]
dimension = 3
min = [0.0, 0.0, -0.1]
max = [{length}, {width}, {height}]
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
[contact]
skin = {skin}
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
size = [{along}, {side}, {layers}]
radius = {radius}
random_velocity = {speed}
material = "grain"
[output]
history_interval = 0.01
"""
PLANE = '[[walls]]\nname = "floor"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n'
UNEVEN = ('[[meshes]]\nname = "floor"\nkind = "file"\nfile = "{file}"\nsheet = true\n'
          '[[walls]]\nname = "floor"\nmesh = "floor"\n')
MESH = ('[[meshes]]\nname = "floor"\nkind = "rectangle"\nsize = [{length}, {width}]\n'
        'offset = [{along}, {across}, 0.0]\n'
        'refine = {edge}\n[[walls]]\nname = "floor"\nmesh = "floor"\n')


def deck(side, layers, steps, ranks=1, speed=0.05, skin=SKIN):
    """The bed without a floor. speed: up to which each sphere has one along each axis [m/s]; skin: in radii."""
    return DECK.format(length=SPACING * side * ranks, width=SPACING * side, height=0.5 + 1.2 * LAYER * layers,
                       end=2e-5 * steps, along=side * ranks, side=side, layers=layers, spacing=SPACING, layer=LAYER,
                       speed=speed, radius=RADIUS, skin=f"{skin * RADIUS:.9g}")


def mesh(side, edge, ranks=1):
    """The floor, which goes on past the bed's sides."""
    length, width = SPACING * side * ranks, SPACING * side
    return MESH.format(length=length + 0.3, width=width + 0.3, along=length / 2, across=width / 2, edge=edge)


def uneven_mesh(path, side, edge, unevenness, ranks=1):
    """The same, from a file that this writes."""
    random = Random(1)
    along, across = (math.ceil((SPACING * side * n + 0.3) / edge) for n in (ranks, 1))
    with path.open("w") as out:
        for j in range(across + 1):
            for i in range(along + 1):
                out.write(f"v {edge * i - 0.15:.9g} {edge * j - 0.15:.9g} {-unevenness * random.random():.9g}\n")
        for j in range(across):
            for i in range(along):
                k = (along + 1) * j + i + 1
                out.write(f"f {k} {k + 1} {k + along + 2}\nf {k} {k + along + 2} {k + along + 1}\n")
    return UNEVEN.format(file=path)


def milliseconds(record, steps):
    """Of a step, without the start and output."""
    return f"{1e3 * sum(s['seconds'] for s in record['stages'] if s['stage'] != 'output') / steps:8.4f}"


def run(scree, backend, text, ranks=1):
    with tempfile.TemporaryDirectory(prefix="scree_mesh_bed_") as folder:
        path = pathlib.Path(folder) / "deck.toml"
        path.write_text(text)
        command = ["mpirun", "-n", str(ranks)] if ranks > 1 else []
        subprocess.run([*command, scree, "run", path, "--backend", backend, "--output", folder, "--overwrite"],
                       check=True, stdout=subprocess.DEVNULL)
        return json.loads((pathlib.Path(folder) / "run_record.json").read_text())


def note(arguments, ranks, name, record):
    layers = arguments.layers or arguments.side
    seconds = {stage["stage"]: stage["seconds"] for stage in record["stages"]}
    size = f"{arguments.backend}, {arguments.side} x {arguments.side} x {layers}, edge {arguments.edge}"
    if arguments.unevenness > 0:
        size += f", uneven by {arguments.unevenness}"
    if ranks > 1:
        size += f", each of {ranks} ranks"
    step = 1e3 * seconds["contact_force"] / arguments.steps
    lists = record["counts"]["list_builds"]
    measured.note(f"mesh_bed/{size}/{name} step", step, "ms", record=record)
    measured.note(f"mesh_bed/{size}/{name} list", 1e3 * seconds["neighbors"] / max(lists, 1), "ms", record=record)
    print(f"{ranks} {name:6} {step:8.4f} ms a step, lists {1e3 * seconds['neighbors']:8.2f} ms in all, {lists} of them",
          flush=True)


def compare(arguments, ranks, path):
    bed = deck(arguments.side, arguments.layers or arguments.side, arguments.steps, ranks)
    floor = mesh(arguments.side, arguments.edge, ranks)
    if arguments.unevenness > 0:
        floor = uneven_mesh(path, arguments.side, arguments.edge, arguments.unevenness, ranks)
    hashes = set()
    for name, wall in ("plane", PLANE), ("mesh", floor):
        record = run(arguments.scree, arguments.backend, bed + wall, ranks)
        note(arguments, ranks, name, record)
        hashes.add(record["run"]["state_hash"])
    if not arguments.unevenness > 0:
        print("the same state hash" if len(hashes) == 1 else "different state hashes")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scree")
    parser.add_argument("--backend", default="cpu")
    parser.add_argument("--side", type=int, default=100)
    parser.add_argument("--layers", type=int)
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--edge", type=float, default=0.0107)
    parser.add_argument("--ranks", type=int, nargs="+", default=[1])
    parser.add_argument("--unevenness", type=float, default=0.0)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="scree_mesh_bed_") as folder:
        for ranks in arguments.ranks:
            compare(arguments, ranks, pathlib.Path(folder) / "floor.obj")


if __name__ == "__main__":
    main()
