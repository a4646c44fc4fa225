"""Tutorial 3: the torque of the motor and the torque of the particles' weight, over the second half of the run."""

import math
import sys

import numpy as np
import scree

run = scree.open(sys.argv[1])
half = run.history.time[-1] / 2
late = run.history.time > half
torque = np.mean(run.history["efforts/motor/effort"][late])
rate = np.mean(run.history["efforts/motor/rate"][late])

centres = []                                                    # of mass of the particles
for snapshot in run.snapshots:
    if snapshot.time > half:
        mass = np.array(snapshot.particles["mass"])
        centres.append(mass @ np.array(snapshot.particles["position"]) / mass.sum())
x, y = np.mean(centres, axis=0)[:2]

print(f"rate {rate:.2f} rad/s, torque {torque:.2f} N m, weight times arm {9.81 * mass.sum() * x:.2f} N m")
print(f"centre of mass {math.degrees(math.atan2(x, -y)):.0f} degrees from the vertical")
