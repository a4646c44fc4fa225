"""Tutorial 4: the forces in the cylinders and on the bucket, and the load as carried by the pins on the ground."""

import sys

import numpy as np
import scree

run = scree.open(sys.argv[1])
time, history = run.history.time, run.history

digs = (time > 0.9) & (time < 1.4)

for cylinder in ("stick", "bucket"):
    force = np.hypot(history[f"reactions/{cylinder}_stroke/fx"], history[f"reactions/{cylinder}_stroke/fy"])
    print(f"{cylinder} cylinder: {force[0]:.0f} N at the start, {np.mean(force[digs]):.0f} N while it digs")
print(f"resistance of the bed: {np.mean(history['contacts/bucket/fx'][digs]):.0f} N")

rest = time > time[-1] - 0.2
linkage = 9.81 * sum(body["mass"] for body in run.deck["bodies"])
pins = np.mean(history["reactions/elbow/fy"][rest] + history["reactions/stick_stroke/fy"][rest])
bucket = -np.mean(history["contacts/bucket/fy"][rest])
print(f"at the end: {pins:.0f} N at the pins, {linkage:.0f} N of linkage and {bucket:.0f} N in the bucket")
