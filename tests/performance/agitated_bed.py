#!/usr/bin/env python3
"""A bed whose spheres fly about, so that lists last for some steps only: time per step, lists included, against how
far past touch these reach.
Usage: agitated_bed.py SCREE [--backend cuda] [--side 46] [--steps 4000] [--speed 3] [--skins 0.2 0.3 0.4]
--side: spheres along each side of a cube; --speed: of each, up to so much along each axis [m/s]; --skins: in radii."""

import argparse

import mesh_bed
from mesh_bed import measured


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scree")
    parser.add_argument("--backend", default="cpu")
    parser.add_argument("--side", type=int, default=46)
    parser.add_argument("--steps", type=int, default=4000)
    parser.add_argument("--speed", type=float, default=3.0)
    parser.add_argument("--skins", type=float, nargs="+", default=[0.2, 0.3, 0.4])
    arguments = parser.parse_args()
    for skin in arguments.skins:
        deck = mesh_bed.deck(arguments.side, arguments.side, arguments.steps, speed=arguments.speed, skin=skin)
        record = mesh_bed.run(arguments.scree, arguments.backend, deck + mesh_bed.PLANE)
        milliseconds, lists = mesh_bed.milliseconds(record, arguments.steps), record["counts"]["list_builds"]
        case = f"{arguments.backend}, side {arguments.side}, speed {arguments.speed}, skin {skin}"
        measured.note(f"agitated_bed/{case}/step", float(milliseconds), "ms", record=record)
        measured.note(f"agitated_bed/{case}/steps per list", arguments.steps / lists, "", record=record)
        print(f"skin {skin} radii: {milliseconds} ms a step in all but output, {lists} lists, "
              f"state {record['run']['state_hash'][:16]}", flush=True)


if __name__ == "__main__":
    main()
