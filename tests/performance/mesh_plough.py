#!/usr/bin/env python3
"""Blades of triangles that plunge into a bed of spheres, the same bed without them, and with one sphere that flies
above it as fast as the blades hit those of the bed: time per step. Lists last as long as the fastest sphere lets
them, so that the first two differ by more than what the blades' contacts take.
Usage: mesh_plough.py SCREE [--backend cuda] [--side 200] [--steps 400] [--edge 0.011] [--skin 0.3]
--skin: of the lists, in radii, the same for all three."""

import argparse

import mesh_bed
from mesh_bed import measured

COLUMNS, ROWS = 5, 4
SIZE = (0.4, 0.02, 0.4)  # of a blade [m]
MESH = '[[meshes]]\nname = "blade"\nkind = "box"\nsize = {size}\nrefine = {edge}\n'
AGITATED = """[[particles]]
name = "agitated"
kind = "lattice"
origin = [0.5, 0.5, {z}]
spacing = [1.0, 1.0, 1.0]
size = [1, 1, 1]
radius = 0.01
velocity = [0.7071, 0.0, 0.0]
material = "grain"
"""
BLADE = """[[bodies]]
name = "blade{number}"
kind = "spatial"
position = [{x}, {y}, {z}]
velocity = [0.5, 0.0, -0.5]
solids = [{{ kind = "mesh", mesh = "blade", density = 7800.0 }}]
meshes = [{{ mesh = "blade", material = "grain" }}]
"""


def blades(width, top, edge):
    places = [(column, row) for row in range(ROWS) for column in range(COLUMNS)]
    return MESH.format(size=list(SIZE), edge=edge) + "".join(
        BLADE.format(number=k, x=width * (column + 0.5) / COLUMNS, y=width * (row + 0.5) / ROWS,
                     z=top + SIZE[2] / 2 + 1e-4) for k, (column, row) in enumerate(places))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scree")
    parser.add_argument("--backend", default="cpu")
    parser.add_argument("--side", type=int, default=200)
    parser.add_argument("--steps", type=int, default=400)
    parser.add_argument("--edge", type=float, default=0.011)
    parser.add_argument("--skin", type=float, default=0.3)
    arguments = parser.parse_args()
    deck = mesh_bed.deck(arguments.side, arguments.side, arguments.steps, skin=arguments.skin) + mesh_bed.PLANE
    width, top = mesh_bed.SPACING * arguments.side, mesh_bed.LAYER * (arguments.side - 1) + 0.02
    for name, extra in (("bed", ""), ("agitated", AGITATED.format(z=top + 0.3)),
                        ("blades", blades(width, top, arguments.edge))):
        record = mesh_bed.run(arguments.scree, arguments.backend, deck + extra)
        size = f"{arguments.backend}, side {arguments.side}, edge {arguments.edge}, skin {arguments.skin}"
        milliseconds = mesh_bed.milliseconds(record, arguments.steps)
        measured.note(f"mesh_plough/{size}/{name} step", float(milliseconds), "ms", record=record)
        measured.note(f"mesh_plough/{size}/{name} lists", record["counts"]["list_builds"], "lists", record=record)
        print(f"{name:6} {milliseconds} ms a step in all but output, "
              f"{record['counts']['list_builds']} lists")


if __name__ == "__main__":
    main()
