#!/usr/bin/env python3
"""Measures runs of the examples with inserters and outlets: the discharge of a silo, the sorting of a screen, the
steady flow on a chute.

    .venv/bin/python postprocess/examples/streams.py silo results/silo
    .venv/bin/python postprocess/examples/streams.py screen results/screen
    .venv/bin/python postprocess/examples/streams.py chute results/chute
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve()
if (HERE.parents[1] / "scree/__init__.py").exists():  # in the repository; elsewhere the installed package is used
    sys.path.insert(0, str(HERE.parents[1]))

import numpy as np

import scree

GRAVITY = 9.81  # [m/s^2]
BEVERLOO_C, BEVERLOO_K = 0.58, 1.5  # of spheres: Nedderman, Statics and Kinematics of Granular Materials, 1992
PRESSURE_RATIO = 0.5  # of horizontal to vertical stress in Janssen's law; usual values are 0.4 to 0.6
STEADY = (0.1, 0.45)  # shares of the mass between which the discharge counts as steady
WINDOW = 0.1  # over which a rate is averaged [s]
OPENED = (0.05, 0.2)  # after the gate begins to open, between which the load on the wall is averaged [s]
SETTLED = 0.9  # of the time before the gate opens, from which on loads are averaged


def column(run, name):
    return np.array(run.history[name])


def between(run, name, begin, end):
    """Mean and standard deviation of a column between two times [s]."""
    time = column(run, "step/time")
    values = column(run, name)[(time >= begin) & (time <= end)]
    return values.mean(), values.std()


def rates(time, mass):
    """Rates of a growing mass [kg/s] in windows of equal length."""
    edges = np.arange(time[0], time[-1], WINDOW)
    return np.diff(np.interp(edges, time, mass)) / WINDOW


def mass_of(particles, density):
    return density * 4 / 3 * np.pi * np.array(particles["radius"]) ** 3


def filling(run, opens, radius, density):
    """Bulk density [kg/m^3] of the middle of the filling when the gate opens, and the height of its top [m]."""
    snapshot = min(run.snapshots, key=lambda one: abs(one.time - opens))
    height = np.array(snapshot.particles["position"])[:, 2]
    mass = mass_of(snapshot.particles, density)
    top = mass.sum() / (mass[height < np.median(height)].sum() / np.median(height))
    inside = (height > 0.2 * top) & (height < 0.8 * top)
    return mass[inside].sum() / (np.pi * radius**2 * 0.6 * top), top


def silo(run):
    deck = run.deck
    radius = deck["meshes"][0]["inner_radius"]
    orifice = 2 * deck["meshes"][1]["hole_radius"]
    grain = deck["inserters"][0]["radius"]
    diameter = grain["min"] + grain["max"]
    opens = deck["drivers"][0]["motion"]["start"]
    bulk, height = filling(run, opens, radius, deck["materials"][0]["density"])
    time, out = column(run, "step/time"), column(run, "outlets/below/mass")
    total = column(run, "step/born_mass")[-1]
    steady = (out > STEADY[0] * total) & (out < STEADY[1] * total)
    found = rates(time[steady], out[steady])
    law = BEVERLOO_C * bulk * np.sqrt(GRAVITY) * (orifice - BEVERLOO_K * diameter) ** 2.5
    loads = {name: between(run, f"contacts/{name}/fz", SETTLED * opens, opens)[0]
             for name in ("tube", "floor", "gate")}
    bottom, weight = -loads["floor"] - loads["gate"], GRAVITY * total
    friction = deck["contact"]["pairs"][1]["friction"]
    saturation = 4 * friction * PRESSURE_RATIO * height / (2 * radius)
    janssen = (1 - np.exp(-saturation)) / saturation
    opened = -between(run, "contacts/tube/fz", opens + OPENED[0], opens + OPENED[1])[0]
    return (f"filling {total:.3f} kg, {1e3 * height:.0f} mm high, bulk density {bulk:.0f} kg/m^3\n"
            f"    discharge {found.mean():.3f} +- {found.std():.3f} kg/s in windows of {WINDOW} s, "
            f"Beverloo's law {law:.3f} kg/s: {100 * (found.mean() / law - 1):+.0f} %\n"
            f"    weight {weight:.2f} N, before the gate opens on floor and gate {bottom:.2f} N "
            f"({100 * bottom / weight:.0f} %; Janssen's law {100 * janssen:.0f} %), "
            f"on the wall {-loads['tube']:.2f} N; "
            f"on the wall while it discharges {opened:.2f} N")


def numbers(run, name, small, large):
    """Numbers of small and large particles that an outlet has removed, from its total number and mass."""
    count, mass = column(run, f"outlets/{name}/removed")[-1], column(run, f"outlets/{name}/mass")[-1]
    larger = round((mass - count * small) / (large - small))
    return count - larger, larger


def screen(run):
    density = run.deck["materials"][0]["density"]
    mixture = run.deck["inserters"][0]["mixture"]
    small, large = (density * 4 / 3 * np.pi * part["radius"]["value"] ** 3 for part in mixture)
    found = {name: numbers(run, name, small, large) for name in ("under", "over")}
    undersize = found["under"][0] / (found["under"][0] + found["over"][0])
    oversize = found["over"][1] / (found["under"][1] + found["over"][1])
    end = column(run, "step/time")[-1]
    swing = column(run, "bodies/screen/z")[column(run, "step/time") > 0.6 * end]
    lines = [f"    {name}: {pair[0]} small, {pair[1]} large" for name, pair in found.items()]
    return "\n".join([f"amplitude of the screen {5e2 * (swing.max() - swing.min()):.1f} mm", *lines,
                      f"    of the small ones {100 * undersize:.1f} % passed, of the large ones "
                      f"{100 * oversize:.1f} % left over the end"])


def chute(run):
    time, born, out = (column(run, name) for name in ("step/time", "step/born_mass", "outlets/end/mass"))
    late = time > 0.5 * time[-1]
    inflow, outflow = (rates(time[late], mass[late]) for mass in (born, out))
    held = (born - out)[late]
    return (f"in the second half: in {inflow.mean():.3f} +- {inflow.std():.3f} kg/s, out {outflow.mean():.3f} +- "
            f"{outflow.std():.3f} kg/s; on the chute {held.mean():.3f} +- {held.std():.3f} kg, mean residence time "
            f"{held.mean() / inflow.mean():.2f} s")


if __name__ == "__main__":
    measures = {"silo": silo, "screen": screen, "chute": chute}
    if len(sys.argv) < 3 or sys.argv[1] not in measures:
        sys.exit("usage: streams.py silo|screen|chute FOLDER ...")
    for folder in sys.argv[2:]:
        print(f"{folder}: {measures[sys.argv[1]](scree.open(folder))}")
