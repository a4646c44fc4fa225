"""Tutorial 2: the force of the particles on the closed flap, and the slope of the heap."""

import math
import sys

import numpy as np
import scree

run = scree.open(sys.argv[1])
time = run.history.time
closed = (time > 0.8) & (time < 1.0)
force = np.mean(run.history["contacts/flap/fx"][closed])

last = run.snapshots[-1].particles
x, top = np.array(last["position"])[:, 0], np.array(last["position"])[:, 1] + np.array(last["radius"])
weight = 9.81 * np.sum(last["mass"])

# The surface: the highest particle in each strip of 4 cm, where the heap is more than two particles high.
edges = np.arange(-0.18, 0.8, 0.04)
strips = [(x >= left) & (x < left + 0.04) for left in edges]
surface = np.array([(left + 0.02, top[strip].max()) for left, strip in zip(edges, strips) if strip.any()])
surface = surface[surface[:, 1] > 0.03]
slope = -np.polyfit(surface[:, 0], surface[:, 1], 1)[0]

share = 100 * force / weight
print(f"force on the closed flap {force:.0f} N, {share:.0f} % of the particles' weight of {weight:.0f} N")
print(f"slope {math.degrees(math.atan(slope)):.0f} degrees")
