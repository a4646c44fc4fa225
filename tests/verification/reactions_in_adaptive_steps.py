"""How far joint reactions in adaptive steps err where an impact elsewhere changes the step: the numbers of
input/choosing.md.

    .venv/bin/python tests/verification/reactions_in_adaptive_steps.py build/release/scree

A pendulum swings beside a disc that bounces. The reaction at its pivot is compared to the one that follows from its
place and speed; a line per choice of steps, "STEPS: up to ERROR N of LARGEST N"."""

import pathlib
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

import scree

ARM, MASS, INERTIA, GRAVITY = 0.5, 1.0, 0.005, 9.81
CHOICES = {"adaptive": {}, "adaptive, max_step 1e-3": {"max_step": 1e-3}, "adaptive, max_step 1e-4": {"max_step": 1e-4},
           "fixed, step 1e-4": {"control": "fixed", "step": 1e-4}}


def deck(steps):
    found = scree.Deck(title="a pendulum beside a bouncing disc", gravity=[0.0, -GRAVITY],
                       space={"dimension": 2, "min": [-1.0, -1.0], "max": [3.0, 1.0], "y_min": "wall"},
                       time={"end": 1.0} | steps, output={"history_bodies": ["bob"]})
    found.add("contact.pairs", stiffness=1e5, restitution=0.7)
    found.add("bodies", name="bob", position=[ARM, 0.0], mass=MASS, inertia=INERTIA)
    found.add("joints", name="pivot", type="revolute", bodies=["ground", "bob"], point=[0.0, 0.0])
    found.add("particles", name="far", kind="list", positions=[[2.0, -0.5]], radius=0.02, mass=0.01)
    return found


def errors(history):
    """[rows] of the reaction's error, and of its size [N]."""
    x, y, speed = (history[f"bodies/bob/{name}"].values for name in ("x", "y", "angular_velocity"))
    turn = -MASS * GRAVITY * x / (INERTIA + MASS * ARM**2)  # angular acceleration
    exact = MASS * np.array([-turn * y - speed**2 * x, turn * x - speed**2 * y + GRAVITY])
    found = np.array([history[f"reactions/pivot/{name}"].values for name in ("fx", "fy")])
    return np.linalg.norm(found - exact, axis=0), np.linalg.norm(exact, axis=0)


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: reactions_in_adaptive_steps.py SCREE")
    for name, steps in CHOICES.items():
        with tempfile.TemporaryDirectory() as folder:
            error, size = errors(deck(steps).run(folder, scree=sys.argv[1], quiet=True).history)
        print(f"{name}: up to {error.max():.2g} N of {size.max():.3g} N")


main()
