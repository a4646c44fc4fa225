"""What a particle takes in memory, and a particle and a body in files: the numbers of src/model/memory.hpp,
src/model/memory.cpp, src/dem/kept_contacts.cpp and src/run/check.cpp.
Usage: bytes_per_item.py SCREE"""

import os
import pathlib
import subprocess
import sys
import tempfile

HEAD = """
[time]
end = 1e-4
step = 2e-5
control = "fixed"
[[contact.pairs]]
stiffness = 1e5
"""
RUBS = "friction = 0.4\n"  # further keys of the pair
ROLLS = RUBS + "rolling_friction = 0.2\n"
PARTICLES = """
[space]
dimension = 3
min = [0.0, 0.0, 0.0]
max = [101.0, 101.0, 101.0]
[[particles]]
name = "block"
kind = "lattice"
origin = [0.5, 0.5, 0.5]
spacing = [0.999, 0.999, 0.999]     # six neighbours each
size = [100, 100, 100]
radius = 0.5
mass = 1.0
"""
BODIES = """
[space]
dimension = 2
min = [0.0, 0.0]
max = [20001.0, 10.0]
[[bodies]]
name = "row"
count = 10000
position = [1.0, 5.0]
spacing = [2.0, 0.0]
mass = 1.0
inertia = 0.1
shapes = [{ radius = 0.5 }]
"""
JOINTS = """
[[joints]]
name = "pin"
type = "revolute"
chain = "row"
local_points = [[1.0, 0.0], [-1.0, 0.0]]
"""


def run(scree, folder, deck, *words):
    """Runs the deck; the most memory that it had [B]."""
    (folder / "deck.toml").write_text(HEAD + deck)
    command = [scree, "run", folder / "deck.toml", "--backend", "cpu", "--overwrite", "--output", folder / "out",
               *words]
    program = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(program.pid, 0)
    program.returncode = os.waitstatus_to_exitcode(status)
    if program.returncode != 0:
        raise subprocess.CalledProcessError(program.returncode, command)
    return usage.ru_maxrss * 1024


def print_files(folder, name, what, count, points=1):
    """points: in a snapshot, of each."""
    snapshots = 2
    size = (folder / 'out' / name).stat().st_size
    print(f"{what}: {size / snapshots / count / points:.0f} B in a snapshot{' per point' if points > 1 else ''}, "
          f"{(folder / 'out/checkpoint_end.h5').stat().st_size / count:.0f} B in a checkpoint")


def main():
    scree = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        empty = run(scree, folder, BODIES)
        print_files(folder, "bodies.vtkhdf", "body of one shape", 10000, points=2)
        run(scree, folder, BODIES + JOINTS)
        print(f"link: {(folder / 'out/links.vtkhdf').stat().st_size / 2 / 9999:.0f} B in a snapshot")
        # The others touch six each, which remember three and six numbers.
        for what, integrator, keys in (("explicit", "velocity-verlet", ""), ("implicit", "hht", ""),
                                       ("explicit, rubbing", "velocity-verlet", RUBS),
                                       ("explicit, rolling", "velocity-verlet", ROLLS)):
            most = run(scree, folder, keys + PARTICLES, "--set", f"integrator.particles={integrator}")
            print(f"{what}: {(most - empty) / 1e6:.0f} B of memory per particle")
            print_files(folder, "particles.vtkhdf", f"particle, {what}", 1e6)
        run(scree, folder, RUBS + PARTICLES, "--set", "integrator.particles=velocity-verlet", "--set",
            "output.contacts=true")
        contacts = (folder / "out/contacts.vtkhdf").stat().st_size / 2 / (3 * 99 * 100 * 100)
        print(f"contact, rubbing: {contacts:.0f} B in a snapshot")


if __name__ == "__main__":
    main()
