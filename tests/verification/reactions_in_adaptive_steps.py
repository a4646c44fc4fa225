"""Errors of joint reactions in adaptive steps where an impact elsewhere changes the step: the numbers of
input/choosing.md.

    .venv/bin/python tests/verification/reactions_in_adaptive_steps.py build/release/scree

A pendulum swings beside a disc that bounces, on a pin without or with friction. The reaction at its pivot is compared
to the one that follows from its position, its speed and the friction in the history; a line per choice of
steps, "STEPS: up to ERROR N of LARGEST N". The last lines say how far the angle with friction is off at most from that
in short fixed steps, with the disc and without it."""

import pathlib
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

import scree

ARM, MASS, INERTIA, GRAVITY = 0.5, 1.0, 0.005, 9.81
FINE = {"control": "fixed", "step": 1e-4}
CHOICES = {"adaptive": {}, "fixed, step 1e-4": FINE}


def deck(steps, has_friction=False, disc=True):
    found = scree.Deck(title="a pendulum beside a bouncing disc", gravity=[0.0, -GRAVITY],
                       space={"dimension": 2, "min": [-1.0, -1.0], "max": [3.0, 1.0], "y_min": "wall"},
                       time={"end": 1.0} | steps, output={"history_bodies": ["bob"]})
    found.add("contact.pairs", stiffness=1e5, restitution=0.7)
    found.add("bodies", name="bob", position=[ARM, 0.0], mass=MASS, inertia=INERTIA)
    found.add("joints", name="pivot", type="revolute", bodies=["ground", "bob"], point=[0.0, 0.0])
    if has_friction:
        found.add("joint_frictions", name="friction", joint="pivot", friction_coefficient=0.3, radius=0.03,
                  stiffness=1e4)
    if disc:
        found.add("particles", name="far", kind="list", positions=[[2.0, -0.5]], radius=0.02, mass=0.01)
    return found


def history(program, *of_deck):
    with tempfile.TemporaryDirectory() as folder:
        columns = deck(*of_deck).run(folder, scree=program, quiet=True).history
        return np.asarray(columns.time), {name: columns[name].values for name in columns}


def errors(columns):
    """Errors of the reaction, and its magnitudes [N]: [rows]."""
    x, y, speed = (columns[f"bodies/bob/{name}"] for name in ("x", "y", "angular_velocity"))
    turn = (columns.get("efforts/friction/effort", 0) - MASS * GRAVITY * x) / (INERTIA + MASS * ARM**2)  # acceleration
    exact = MASS * np.array([-turn * y - speed**2 * x, turn * x - speed**2 * y + GRAVITY])
    found = np.array([columns[f"reactions/pivot/{name}"] for name in ("fx", "fy")])
    return np.linalg.norm(found - exact, axis=0), np.linalg.norm(exact, axis=0)


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: reactions_in_adaptive_steps.py SCREE")
    program = sys.argv[1]
    for has_friction in (False, True):
        for name, steps in CHOICES.items():
            error, size = errors(history(program, steps, has_friction)[1])
            print(f"{'friction, ' if has_friction else ''}{name}: up to {error.max():.2g} N of {size.max():.3g} N")
    times, fine = history(program, FINE, True)
    for disc in (True, False):
        at, found = history(program, {}, True, disc)
        angle = np.interp(at, times, fine["bodies/bob/angle"])
        print(f"friction, adaptive, {'with' if disc else 'without'} the disc: the angle is off by up to "
              f"{np.abs(found['bodies/bob/angle'] - angle).max():.2g} rad of {np.abs(angle).max():.3g} rad")


main()
