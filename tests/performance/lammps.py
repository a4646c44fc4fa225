#!/usr/bin/env python3
"""The bed with friction against gran/hooke/history of LAMMPS: the same spheres, walls, stiffnesses and dampers, a list
every 25 steps, both on one core by turns. Prints a markdown table.

    lammps.py BED [--lammps lmp] [--particles 10000 100000] [--rounds 5] [--steps 500]

BED is build/release/tests/performance/bed, lmp the one of Debian's package `lammps`. Times are CPU seconds: LAMMPS
prints its wall seconds and the share of them that it had a processor for. Both lists must have as many entries.
"""
import argparse
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

import h5py
import numpy as np

import jobs

ROOT = pathlib.Path(__file__).resolve().parents[2]
# As sphere_bed() and set_contact() of bed_cases.cpp make the bed: spheres of 1 kg.
TILE, RADIUS, HEIGHT, STEP, SKIN, REBUILD = 25, 0.5, 20, 1e-4, 0.1, 25
STIFFNESS, DAMPER, FRICTION = 2e5, 25, 0.5
INPUT = """units si
atom_style sphere
boundary f f f
comm_modify vel yes
newton off
read_data bed.data
pair_style gran/hooke/history {stiffness:.17g} {shear:.17g} {of_pair:.17g} 0 {friction} 0
pair_coeff * *
timestep {step}
neighbor {skin} bin
neigh_modify every {rebuild} delay 0 check no
fix motion all nve/sphere
fix weight all gravity 1 vector 0 0 -1
fix x all wall/gran hooke/history {stiffness:.17g} {shear:.17g} {of_wall:.17g} 0 {friction} 0 xplane {low} {x:.17g}
fix y all wall/gran hooke/history {stiffness:.17g} {shear:.17g} {of_wall:.17g} 0 {friction} 0 yplane {low} {y:.17g}
fix z all wall/gran hooke/history {stiffness:.17g} {shear:.17g} {of_wall:.17g} 0 {friction} 0 zplane 0 NULL
compute touching all contact/atom
compute contacts all reduce ave c_touching
thermo_style custom step ke c_contacts
thermo 1000000
run {rebuild}
run {steps}
"""


def spheres(count):
    """Positions of the spheres, and the upper corner of the bed."""
    with h5py.File(ROOT / "tests/reference/bed_tile.h5") as file:
        tile = np.column_stack([file[axis][...] for axis in "xyz"])
    tiles, rest = divmod(count, len(tile))
    if tiles < 1 or rest:
        sys.exit(f"lammps.py: --particles {count}: must be a multiple of {len(tile)}")
    rows = int(tiles ** 0.5)
    while tiles % rows:
        rows -= 1
    shifts = [(TILE * (at // rows), TILE * (at % rows), 0) for at in range(tiles)]
    return np.concatenate([tile + shift for shift in shifts]), (TILE * (tiles // rows) + RADIUS, TILE * rows + RADIUS)


def write_case(folder, count, steps):
    position, (x, y) = spheres(count)
    density = 1 / (4 / 3 * np.pi * RADIUS ** 3)
    lines = ["bed", "", f"{count} atoms", "1 atom types", "", f"{-RADIUS} {x} xlo xhi", f"{-RADIUS} {y} ylo yhi",
             f"0 {HEIGHT} zlo zhi", "", "Atoms # sphere", ""]
    lines += [f"{n} 1 {2 * RADIUS} {density:.17g} {x:.17g} {y:.17g} {z:.17g}"
              for n, (x, y, z) in enumerate(position, 1)]
    (folder / "bed.data").write_text("\n".join(lines) + "\n")
    # Dampers in gran/hooke/history are in proportion to the effective mass: half a kg, at a wall 1 kg.
    (folder / "in.bed").write_text(INPUT.format(
        stiffness=STIFFNESS, shear=2 / 7 * STIFFNESS, of_pair=2 * DAMPER, of_wall=DAMPER, friction=FRICTION, step=STEP,
        skin=SKIN, rebuild=REBUILD, low=-RADIUS, x=x, y=y, steps=steps))


def printed_by(words, folder):
    environment = {name: value for name, value in jobs.ENVIRONMENT.items() if name != "SCREE_MEASURED"}
    done = subprocess.run(list(map(str, words)), cwd=folder, text=True, capture_output=True, env=environment)
    if done.returncode:
        sys.exit(f"lammps.py: {words[0]} ended with {done.returncode}:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def pace_of_lammps(program, folder, count, steps):
    """Particle-steps per CPU second, contacts per particle and entries of a list per particle."""
    text = printed_by([program, "-in", "in.bed", "-log", "none"], folder)
    seconds = float(re.findall(r"Loop time of (\S+) on 1 procs", text)[-1])
    share = float(re.findall(r"([\d.]+)% CPU use", text)[-1]) / 100
    contacts = float(re.findall(r"^\s*\d+\s+\S+\s+(\S+)\s*$", text, re.MULTILINE)[-1])
    listed = 2 * float(re.findall(r"Ave neighs/atom = (\S+)", text)[-1])
    return count * steps / (seconds * share), contacts, listed


def pace_of_bed(program, folder, count, steps):
    text = printed_by([program, "--backend", "cpu", "--friction", FRICTION, "--particles", count, "--rebuild", REBUILD,
                       "--repeats", 1, "--seconds", 0, "--steps", steps], folder)
    pace, listed = re.search(r"^\s*\d+ (\S+) .* (\S+) listed per particle", text, re.MULTILINE).groups()
    return float(pace), float(listed)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bed", type=pathlib.Path)
    parser.add_argument("--lammps", default="lmp")
    parser.add_argument("--particles", type=int, nargs="+", default=[10_000, 100_000])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--steps", type=int, default=500)
    options = parser.parse_args()
    print("| spheres | bed, particle-steps/s | LAMMPS | times as fast (median of pairs) "
          "| listed per particle: bed, LAMMPS | contacts per particle (LAMMPS) |\n|---|---|---|---|---|---|")
    for count in options.particles:
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            write_case(folder, count, options.steps)
            rounds = []
            for _ in range(options.rounds):
                rounds.append((*pace_of_bed(options.bed.resolve(), folder, count, options.steps),
                               *pace_of_lammps(options.lammps, folder, count, options.steps)))
        ours, our_list, theirs, contacts, their_list = (statistics.median(column) for column in zip(*rounds))
        ratio = statistics.median(row[0] / row[2] for row in rounds)
        if abs(our_list / their_list - 1) > 0.01:
            sys.exit(f"lammps.py: lists of {our_list} and {their_list} entries per particle: not the same bed")
        print(f"| {count:,} | {ours:.3g} | {theirs:.3g} | {ratio:.2f} | {our_list:.3g}, {their_list:.3g} "
              f"| {contacts:.3g} |", flush=True)


if __name__ == "__main__":
    main()
