#!/usr/bin/env python3
"""Steering a run from Python: a controller outside the deck holds an arm in a bed of particles at an angle.

    .venv/bin/python postprocess/examples/steer.py results/steer

The run consists of pieces of 20 ms. After each piece the controller reads the angle of the arm and appends the torque
of the next piece to the table of the motor; then the run continues from its checkpoint. The table is unchanged up to
the checkpoint, so that the complete state continues, contact springs and spins included: a run with the complete table
from the start gives the same bits.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve()
if (HERE.parents[1] / "scree/__init__.py").exists():  # in the repository; elsewhere the installed package is used
    sys.path.insert(0, str(HERE.parents[1]))

import scree

PIECE, PIECES = 0.02, 25  # [s]
TARGET = 0.6  # angle of the arm [rad]
STIFFNESS, DAMPING, INTEGRAL = 4.0, 0.5, 8.0  # gains of the controller [N m/rad], [N m s/rad], [N m/(rad s)]


def machine():
    """The deck: an arm on a pin at the edge of a box of particles."""
    deck = scree.Deck(title="an arm that Python steers", gravity=[0.0, -9.81],
                      space={"dimension": 2, "min": [-0.3, -0.1], "max": [0.5, 0.6], "x_min": "wall", "x_max": "wall",
                             "y_min": "wall"})
    deck["time"] = {"end": PIECE, "step": 2e-4, "control": "fixed"}
    deck["output"] = {"snapshot_interval": PIECE, "history_interval": 0.005, "history_coordinates": 1}
    deck.add("contact.pairs", stiffness=5e3, restitution=0.4, friction=0.4)
    deck.add("bodies", name="arm", position=[0.1, 0.1], mass=0.4, inertia=2e-3,
             shapes=[{"radius": 0.02, "offset": [0.03 * k, 0.0]} for k in range(-3, 4)])
    deck.add("joints", name="pin", type="revolute", bodies=["ground", "arm"], point=[0.0, 0.1])
    deck.add("motors", name="motor", joint="pin", type="effort",
             effort={"kind": "table", "times": [0.0, PIECE], "values": [0.0, 0.0]})
    deck.add("particles", name="grains", kind="lattice", origin=[0.25, -0.088], spacing=[0.026, 0.026], size=[9, 9],
             radius=0.012, mass=2e-3)
    return deck


def controller():
    """A function from the angle [rad] and its rate [rad/s] to the torque [N m]."""
    integral = 0.0

    def torque(angle, rate):
        nonlocal integral
        integral += (TARGET - angle) * PIECE
        return float(STIFFNESS * (TARGET - angle) - DAMPING * rate + INTEGRAL * integral)

    return torque


def steer(folder, deck, torque, pieces=PIECES, **how):
    """Returns the run, and the deck with the complete table. how: further arguments of Deck.run."""
    run = deck.run(folder, "--overwrite", **how)
    for piece in range(1, pieces):
        angle, rate = (float(run.history[f"coordinates/pin/{name}"][-1]) for name in ("angle", "angle_rate"))
        deck["motors.motor.effort"]["times"].append(round((piece + 1) * PIECE, 9))
        deck["motors.motor.effort"]["values"].append(torque(angle, rate))
        deck["time.end"] = round((piece + 1) * PIECE, 9)
        run = deck.run(folder, "--restart", f"{folder}/checkpoint_end.h5", **how)
    return run, deck


if __name__ == "__main__":
    run, _ = steer(sys.argv[1], machine(), controller(), quiet=True)
    print(f"t = {run.history.time[-1]:.2f} s: the arm is at {run.history['coordinates/pin/angle'][-1]:.3f} rad, "
          f"wanted: {TARGET} rad; the motor gives {run.history['efforts/motor/effort'][-1]:.3f} N m")
