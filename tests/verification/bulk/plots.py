#!/usr/bin/env python3
"""The bulk cases in one picture: discharge, Janssen's law, heaps and the chute, measured and as the literature or an
independent program has them.

    tests/verification/bulk/plots.py [FILE]         (default: postprocess/pictures/bulk.png)

Measured: the rows "bulk/" of tests/verification/measured.csv. `show` of the other scripts writes such rows into the
folder SCREE_MEASURED, and tests/support/measured.py --merge takes them over. The rest: silo.csv, janssen.csv, chute.csv
and bands.csv of tests/reference/contact. Needs postprocess/requirements.txt."""

import pathlib
import re
import sys

import numpy

import bulk
import chute
import heap
import janssen
import silo

sys.path.insert(0, str(bulk.REFERENCE.parents[1] / "support"))
import figures  # noqa: E402
import measured  # noqa: E402

TABLE = pathlib.Path(__file__).resolve().parents[1] / "measured.csv"
PICTURE = pathlib.Path(__file__).resolve().parents[3] / "postprocess/pictures/bulk.png"
OURS, THEIRS, BAND = figures.CPU, figures.GPU, "#ececec"
RADIUS, SPHERES, THEIR_DECAY = 10.0, 16000, 21.29  # of the cylinder whose wall moves up; see janssen.csv [d]
DOT = {"marker": "o", "markersize": 8, "linestyle": "none", "color": OURS}
RING = {"marker": "o", "markersize": 13, "linestyle": "none", "markerfacecolor": "none", "markeredgecolor": THEIRS,
        "markeredgewidth": 2}


def table():
    """{key without "bulk/": value}"""
    return {row["key"].removeprefix("bulk/"): float(row["value"]) for row in measured.read(TABLE)
            if row["key"].startswith("bulk/")}


def series(values, pattern):
    """([x], [value]) of the keys that fit the pattern, whose first group is x."""
    found = sorted((float(match[1]), value) for key, value in values.items() if (match := re.fullmatch(pattern, key)))
    return numpy.array(found).T


def beverloo(holes, rates):
    """The line of rates^0.4 over holes: its slope, and k, where it is zero [d]."""
    slope, cut = numpy.polyfit(holes, rates**0.4, 1)
    return slope, -cut / slope


def discharge(axes, values):
    reference = bulk.reference("silo.csv")
    theirs = silo.OF_SAME_PROGRAM | dict(zip(reference["D"].astype(int), reference["W"]))
    holes, shares = series(values, r"silo/rate over the independent program's, (\d+) d")
    rates = shares * numpy.array([theirs[int(hole)] for hole in holes])
    slope, k = beverloo(holes, rates)
    fine = numpy.linspace(k, 13, 200)
    axes.plot(fine, (slope * (fine - k))**2.5, color=figures.PALE,
              label=f"Beverloo, C = {slope**2.5 / silo.DENSITY:.2f}, k = {k:.2f}")
    axes.plot(sorted(theirs), [theirs[hole] for hole in sorted(theirs)], **RING, label="independent program")
    axes.plot(holes, rates, **DOT, label="Scree, a silo runs empty")
    axes.plot(*series(values, r"hopper/rate, (\d+) d"), **DOT | {"marker": "s", "markerfacecolor": "white"},
              label="Scree, a bed kept full, round rim")
    axes.set(xlim=(0, 13), ylim=(0, 260))
    axes.legend(fontsize=figures.SMALL - 1, frameon=False, loc="upper left")
    figures.label(axes, "Discharge through a hole: Beverloo's law", "diameter of the hole [d]",
                  r"spheres per time [$\sqrt{g/d}$]")


def samples(values):
    """The masses of the fillings and the loads on the floor of janssen.py."""
    names = [key.removeprefix("janssen/mass, ") for key in values if key.startswith("janssen/mass, ")]
    return [numpy.array([values[f"janssen/{what}, {name}"] for name in names])
            for what in ("mass", "load on the floor")]


def carried(axes, values):
    """Loads over the saturated load, against the filling over the mass of that load."""
    deep = numpy.linspace(0, 5.2, 200)
    axes.plot(deep, deep, ":", color=figures.PALE, label="the weight alone")
    axes.plot(deep, -numpy.expm1(-deep), color=figures.PALE, label="Janssen's law")
    table = bulk.reference("janssen.csv")
    inner = (table["z"] >= 3) & (table["z"] <= 40)
    density = table["number"][inner].mean() / (numpy.pi * RADIUS**2)  # spheres per volume: slices one diameter high
    depth, decay = table["z"].max() - table["z"], THEIR_DECAY
    axes.plot(depth / decay, table["sigma"] / (density * decay), **RING,
              label="independent program, a cylinder's wall moved up")
    filled = SPHERES / (density * numpy.pi * RADIUS**2) / values["silo/decay length"]
    axes.plot(filled, values["silo/share of the weight on the floor"] * filled,
              **DOT | {"marker": "s", "markersize": 9}, label="Scree, the same, on the floor")
    mass, load = samples(values)
    saturated = janssen.fit(mass, load)
    axes.plot(mass / saturated, load / saturated, **DOT | {"markerfacecolor": "white", "markeredgewidth": 1.8},
              label=f"Scree, discs, floor lowered: {len(mass)} fillings")
    axes.set(xlim=(0, 5.2), ylim=(0, 1.25))
    axes.legend(fontsize=figures.SMALL - 1, frameon=False, loc="lower right")
    figures.label(axes, "Silos: Janssen's law", r"filling over $m_{sat}$", r"load on the floor over $m_{sat}\,g$")


def heaps(axes, values):
    for rolling, span in ((0.0, (0.3, 0.6)), (0.3, (0.48, 0.52))):
        low, high, _ = heap.band(3, 0.5, rolling)
        axes.fill_between(span, low, high, color=BAND, zorder=0)
    for dimension, color in (("3D", OURS), ("2D", figures.OTHER)):
        axes.plot(*series(values, rf"heap/{dimension}, friction ([\d.]+), rolling friction 0\.0"), "o-", color=color,
                  markersize=8, linewidth=2, label=f"{dimension}, spheres" if dimension == "3D" else "2D, discs")
        for rolling, mark in (("0.1", "^"), ("0.3", "D")):
            axes.plot(0.5, values[f"heap/{dimension}, friction 0.5, rolling friction {rolling}"], mark, color=color,
                      markersize=9, markerfacecolor="white", markeredgewidth=2,
                      label=f"{dimension}, rolling friction {rolling}")
    axes.set(xlim=(0, 0.9), ylim=(0, 40))
    axes.legend(fontsize=figures.SMALL - 2, frameon=False, loc="lower right", ncols=2)
    axes.annotate("grey: literature, in 3D without\nrolling friction and with 0.3", (0.02, 0.97), va="top",
                  xycoords="axes fraction", fontsize=figures.SMALL - 1, color=figures.PALE)
    figures.label(axes, "Heaps on a plate: angle of repose", "friction", "angle [degrees]")


def flow(axes, values):
    angles, speeds = series(values, r"chute/speed, (\d+) degrees")
    wanted = sorted(chute.SPEED)
    axes.errorbar(wanted, [chute.SPEED[angle] for angle in wanted], [chute.SPEED_TOLERANCE[angle] for angle in wanted],
                  **RING, ecolor=THEIRS, capsize=6, label="independent program, with its tolerance")
    axes.plot(angles, speeds, **DOT, label="Scree")
    axes.plot([20], [0], **DOT | {"markerfacecolor": "white"}, label="Scree: comes to rest")
    axes.axvspan(19, 22, color=BAND, zorder=0)
    axes.annotate("flow begins\n(Silbert et al.)", (19.1, 4.6), fontsize=figures.SMALL - 1, color=figures.PALE)
    axes.set(xlim=(18.5, 27), ylim=(-0.3, 6))
    axes.legend(fontsize=figures.SMALL - 1, frameon=False, loc="upper left", bbox_to_anchor=(0.0, 0.72))
    figures.label(axes, "Flow down a bumpy chute, 18 d deep", "slope [degrees]", r"mean speed [$\sqrt{g d}$]")


def main():
    path = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else PICTURE
    values = table()
    figure, axes = figures.subplots(2, 2, figsize=(13, 10))
    for draw, each in zip((discharge, carried, heaps, flow), axes.flat):
        draw(each, values)
    figures.save(figure, path, "Bulk cases: measured, and what the literature and an independent program say")
    print(path)


if __name__ == "__main__":
    main()
