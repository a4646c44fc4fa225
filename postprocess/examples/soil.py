#!/usr/bin/env python3
"""Measures runs of the examples with soil: the force on a tine and its furrow, the soil that stays in buckets.

    .venv/bin/python postprocess/examples/soil.py tine results/tine_in_soil results/tine_without_adhesion
    .venv/bin/python postprocess/examples/soil.py bucket results/bucket_of_soil
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve()
if (HERE.parents[1] / "scree/__init__.py").exists():  # in the repository; elsewhere the installed package is used
    sys.path.insert(0, str(HERE.parents[1]))

import numpy as np

import scree

PULLED = (0.1, 0.2)  # displacements of the carriage between which forces are averaged [m]
TRACK, BESIDE = 0.012, 0.03  # distances from the middle of the track: edge of the furrow, edge of the bed [m]
MARGIN = 0.04  # distance from the front of the bed and from the tine within which the furrow does not count [m]
CELL = 0.004  # of the grid on which heights of the surface are found [m]
OPENING = 0.05  # half the inner width, depth and height of a bucket [m]


def heights(particles, x, y):
    """Height of the surface at the points (x, y) [m]: the top of the highest sphere there, or 0."""
    position, radius = np.array(particles["position"]), np.array(particles["radius"])
    apart = (x[:, None] - position[:, 0]) ** 2 + (y[:, None] - position[:, 1]) ** 2
    tops = position[:, 2] + np.sqrt(np.maximum(radius**2 - apart, 0))
    return np.where(apart < radius**2, tops, 0.0).max(axis=1)


def furrow(run):
    """Mean heights of the bed beside the track, and of the bottom of the furrow behind the tine at the end [m]."""
    low, high = run.deck["space"]["min"][1], run.deck["space"]["max"][1]
    begin = np.array(run.snapshots[0].particles["position"])[:, 0].min() + MARGIN
    end = float(run.history["bodies/tine/x"][-1]) - MARGIN
    x, y = np.meshgrid(np.arange(begin, end, CELL), np.arange(low, high, CELL) + CELL / 2)
    found = heights(run.snapshots[-1].particles, x.ravel(), y.ravel())
    away = np.abs(y.ravel() - (low + high) / 2)
    return found[away > BESIDE].mean(), found[away < TRACK].mean()


def tine(run):
    moved = np.array(run.history["coordinates/beam/displacement"])
    rows = (moved > PULLED[0]) & (moved < PULLED[1])
    torque = np.abs(np.array(run.history["efforts/spring/effort"])[rows])
    draft = np.abs(np.array(run.history["contacts/tine/fx"])[rows])
    bed, bottom = furrow(run)
    return (f"torque of the spring {torque.mean():.2f} +- {torque.std():.2f} N m, "
            f"draft {draft.mean():.1f} +- {draft.std():.1f} N; "
            f"the bed is {1e3 * bed:.0f} mm high, the furrow {1e3 * (bed - bottom):.0f} mm deep")


def bucket(run):
    """The mass in each bucket at the end, as a share of the mass that was put into it."""
    first, last, found = run.snapshots[0].particles, run.snapshots[-1].particles, []
    for number, name in enumerate(run.group_names):
        center = np.array(run.deck["bodies"][0]["position"]) + number * np.array(run.deck["bodies"][0]["spacing"])
        away = np.abs(np.array(last["position"]) - center).max(axis=1)
        inside = (np.array(last["group"]) == number) & (away < OPENING)
        whole = (np.array(first["radius"])[np.array(first["group"]) == number] ** 3).sum()
        found.append(f"{name}: {100 * (np.array(last['radius'])[inside] ** 3).sum() / whole:.1f} %")
    return "mass that stays in its bucket: " + ", ".join(found)


if __name__ == "__main__":
    measures = {"tine": tine, "bucket": bucket}
    if len(sys.argv) < 3 or sys.argv[1] not in measures:
        sys.exit("usage: soil.py tine|bucket FOLDER ...")
    for folder in sys.argv[2:]:
        print(f"{folder}: {measures[sys.argv[1]](scree.open(folder))}")
