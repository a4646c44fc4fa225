#!/usr/bin/env python3
"""A bed of particles with friction, on an analytic plane and on the same plane cut into triangles, on several numbers
of ranks: the state after very many steps has the same bits. Exit code 1 where it has not. Root needs Open MPI's two
variables.
Usage: mesh_plane.py SCREE [--backend cuda] [--steps 100000] [--ranks 1 2 4 8] [--side 10] [--layers 5] [--edge 0.01]"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "performance"))
import mesh_bed  # noqa: E402


def state_hash(arguments, ranks, text):
    with tempfile.TemporaryDirectory(prefix="scree_mesh_plane_") as folder:
        deck = pathlib.Path(folder) / "deck.toml"
        deck.write_text(text)
        command = [arguments.scree, "run", deck, "--backend", arguments.backend, "--output", folder, "--overwrite"]
        if ranks > 1:
            command = ["mpirun", "--oversubscribe", "-n", str(ranks), *command]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        record = json.loads((pathlib.Path(folder) / "run_record.json").read_text())
    return record["run"]["state_hash"], record["counts"]["list_builds"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scree")
    parser.add_argument("--backend", default="cpu")
    parser.add_argument("--steps", type=int, default=100000)
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2, 4, 8])
    parser.add_argument("--side", type=int, default=10)
    parser.add_argument("--layers", type=int, default=5)
    parser.add_argument("--edge", type=float, default=0.0107)
    arguments = parser.parse_args()
    bed = mesh_bed.deck(arguments.side, arguments.layers, arguments.steps)
    mesh = mesh_bed.mesh(arguments.side, arguments.edge)
    hashes = set()
    for floor, wall in ("plane", mesh_bed.PLANE), ("mesh", mesh):
        for ranks in arguments.ranks:
            found, lists = state_hash(arguments, ranks, bed + wall)
            hashes.add(found)
            print(f"{floor:6} {ranks:2} ranks: {found}, {lists} lists in {arguments.steps} steps", flush=True)
    print("the same state hash" if len(hashes) == 1 else "different state hashes")
    return 0 if len(hashes) == 1 else 1


if __name__ == "__main__":
    sys.exit(main())
