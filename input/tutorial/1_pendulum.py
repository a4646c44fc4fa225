"""Tutorial 1: the pendulum's period and the largest force in its pivot, compared with the closed form."""

import math
import sys

import numpy as np
import scree

run = scree.open(sys.argv[1])
time = run.history.time
angle = np.array(run.history["bodies/bob/angle"])               # relative to the start
reaction = np.hypot(run.history["reactions/pivot/fx"], run.history["reactions/pivot/fy"])

bob, gravity = run.deck["bodies"][0], -run.deck["gravity"][1]
x, y = bob["position"]
arm, start = math.hypot(x, y), math.atan2(x, -y)                # m, and rad from the lowest position
inertia = bob["inertia"] + bob["mass"] * arm**2                 # about the pivot

# The bob passes its lowest position between two rows of the history with angles of opposite sign.
below = angle + start
rows = np.flatnonzero(below[:-1] * below[1:] < 0)
passes = time[rows] - below[rows] * (time[rows + 1] - time[rows]) / (below[rows + 1] - below[rows])
period = 2 * (passes[-1] - passes[0]) / (len(passes) - 1)

a, b = 1.0, math.cos(start / 2)                                 # arithmetic-geometric mean, for the elliptic integral
while abs(a - b) > 1e-15:
    a, b = (a + b) / 2, math.sqrt(a * b)
small = 2 * math.pi * math.sqrt(inertia / (bob["mass"] * gravity * arm))
force = bob["mass"] * gravity * (1 + 2 * bob["mass"] * arm**2 / inertia * (1 - math.cos(start)))

print(f"period {period:.5f} s, closed form {small / a:.5f} s, for small swings {small:.5f} s")
print(f"largest force in the pivot {reaction.max():.2f} N, closed form {force:.2f} N")
