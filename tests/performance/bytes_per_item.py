"""What a particle takes in memory, and a particle and a body in files: the numbers of src/model/checks/memory.hpp,
src/model/checks/memory.cpp and src/dem/history/packed_history.cpp. Files: tests/cli/test_disk.py.
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
FRICTION = "friction = 0.4\n"  # further keys of the pair
ROLLS = FRICTION + "rolling_friction = 0.2\n"
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
SHAPES = """
[space]
dimension = 2
min = [0.0, 0.0]
max = [600001.0, 10.0]
[[bodies]]
name = "rod"
position = [1.0, 5.0]
mass = 1.0
inertia = 0.1
shapes = [{{ radius = 0.5, count = {count}, spacing = [2.0, 0.0], collides = {collides} }}]
"""
BALL = """
[space]
dimension = 3
min = [0.0, 0.0, 0.0]
max = [31.0, 4.0, 4.0]
[[meshes]]
name = "ball"
kind = "sphere"
radius = 1.0
levels = {levels}
"""
CARRIER = """
[[bodies]]
name = "carrier{number}"
kind = "spatial"
position = [{place}, 2.0, 2.0]
mass = 1.0
inertia_tensor = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]
meshes = [{{ mesh = "ball" }}]
"""


def balls(levels, bodies):
    return BALL.format(levels=levels) + "".join(CARRIER.format(number=i, place=3.0 * i + 2.0) for i in range(bodies))


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
                                       ("explicit, frictional", "velocity-verlet", FRICTION),
                                       ("explicit, rolling", "velocity-verlet", ROLLS)):
            most = run(scree, folder, keys + PARTICLES, "--set", f"integrator.particles={integrator}")
            print(f"{what}: {(most - empty) / 1e6:.0f} B of memory per particle")
            print_files(folder, "particles.vtkhdf", f"particle, {what}", 1e6)
        contacts = 3 * 99 * 100 * 100
        for what, keys in (("smooth", ""), ("frictional", FRICTION)):
            words = ("--set", "integrator.particles=velocity-verlet", "--set", "output.contacts=true")
            without, most = (run(scree, folder, keys + PARTICLES, *few) for few in (words[:2], words))
            size = (folder / "out/contacts.vtkhdf").stat().st_size
            print(f"contact, {what}: {size / 2 / contacts:.0f} B in a snapshot, "
                  f"{(most - without) / contacts:.0f} B of memory on the way there")
        for what, collides in (("shape", "true"), ("shape for pictures alone", "false")):
            few, many = (run(scree, folder, SHAPES.format(count=count, collides=collides)) for count in (10, 300000))
            print(f"{what}: {(many - few) / 3e5:.0f} B of memory")
        none, one, four = (run(scree, folder, balls(levels, bodies)) for levels, bodies in ((0, 1), (7, 1), (7, 4)))
        triangles = 20 * 4**7
        print(f"triangle: {(one - none) / triangles:.0f} B of memory, {(four - one) / 3 / triangles:.0f} B each time "
              "that it is shown")


if __name__ == "__main__":
    main()
