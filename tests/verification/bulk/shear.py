"""Simple shear with friction between two rough walls, 2D (da Cruz, Emam, Prochnow, Roux and Chevoir 2005, Phys.
Rev. E 72, 021309).

    tests/verification/bulk/shear.py run DIR --scree SCREE     (864 discs, 400,000 to 900,000 steps per speed)
    tests/verification/bulk/shear.py show DIR

Discs whose diameters vary by a fifth, friction 0.4, stiffness over pressure 1e4 as there, no gravity. The lower
wall, a body of discs, holds; the upper one is driven along x by a slide, free along y and pressed down by a
constant force. Units: mean diameter, a mean disc's mass, pressure. The rows start with the speeds of a straight
profile: from rest the shear would spread from the upper wall for a time of 300. Inertial number I = shear rate
sqrt(m/P), from the speeds between the walls' layers. Bands: mu* = 0.25 + 1.1 I and volume fraction 0.81 - 0.3 I
(da Cruz et al., mu = 0.4, I from 0.001 to 0.2; from memory), to 0.03 and 0.015: 28 diameters between the walls,
one run each.
"""

import math
import sys

import numpy

import bulk

SPEEDS = {0.01: 900.0, 0.03: 600.0, 0.1: 400.0, 0.2: 400.0}  # target inertial number, and end of the run
WIDTH = 30.0
ROWS = 36
LAW = ("stiffness = 1e4\nrestitution = 0.3\nfriction = 0.4\ntangential_stiffness = 5e3\n")


def deck(name, number, end, rows=ROWS):
    top = 1.25 * rows + 0.6
    wall = [((1.2 * place - 0.5 * WIDTH + 0.6, 0.0), 0.5) for place in range(25)]
    speed = number * 28.0 * rows / ROWS
    return "\n".join([
        f'title = "simple shear, I about {number}"', 'velocities = "consistent"',
        bulk.table("space",
                   dimension=2,
                   min="[0.0, -2.0]",
                   max=f"[{WIDTH}, {top + 10}]",
                   x_min='"periodic"',
                   x_max='"periodic"'),
        bulk.table("time", end=end, step=5e-3),
        bulk.table("integrator", particles='"velocity-verlet"', substeps=5),
        bulk.pairs(LAW),
        bulk.body("lower", [0.5 * WIDTH, -0.5], wall),
        bulk.body("upper", [0.5 * WIDTH, top], wall, ground=False, mass=100.0),
        bulk.table("[bodies]", name='"slide"', position=f"[{0.5 * WIDTH}, {top}]", mass=1.0, inertia=1.0),
        bulk.table("[joints]",
                   name='"along"',
                   type='"translational"',
                   bodies='["ground", "slide"]',
                   axis="[1.0, 0.0]"),
        bulk.table("[joints]",
                   name='"down"',
                   type='"translational"',
                   bodies='["slide", "upper"]',
                   axis="[0.0, 1.0]"),
        bulk.table("[drivers]", name='"pull"', joint='"along"', motion=f'{{ kind = "ramp", rate = {speed} }}'),
        bulk.table("[applied_forces]", name='"pressure"', body='"upper"', fy=-WIDTH), *[
            bulk.table("[particles]",
                       kind='"row"',
                       origin=f"[0.625, {1.25 * row + 0.625}]",
                       spacing="[1.25, 0.0]",
                       count=24,
                       velocity=f"[{speed * (row + 0.5) / rows}, 0.0]",
                       random_velocity=0.3,
                       seed=row + 1,
                       radius='{ kind = "uniform", min = 0.4, max = 0.6 }',
                       density=4 / math.pi,
                       material='"grain"') for row in range(rows)
        ],
        bulk.output(name,
                    end / 24,
                    end / 2000, ["radius", "velocity"],
                    history_contacts='["lower", "upper"]',
                    history_bodies='["upper"]')
    ])


def decks():
    return {f"shear_{number}": deck(f"shear_{number}", number, end) for number, end in SPEEDS.items()}


def inside(folder, name, from_time):
    """Over the snapshots after from_time, away from the walls: layers' middles and speeds, shear rate, volume
    fraction, and the mean mass of a disc."""
    edges = numpy.arange(0.0, 40.0)
    number, speed = numpy.zeros(len(edges) - 1), numpy.zeros(len(edges) - 1)
    fractions, tops, masses = [], [], []
    for time, fields in bulk.snapshots(folder, name):
        if time < from_time:
            continue
        height, radius = fields["position"][:, 1], fields["radius"]
        tops.append(numpy.sort(height)[-12:].mean())
        number += numpy.histogram(height, edges)[0]
        speed += numpy.histogram(height, edges, weights=fields["velocity"][:, 0])[0]
        fractions.append(covered(height, radius, 5.0, tops[-1] - 5.0))
        masses.append((4 * radius**2).mean())
    middle = 0.5 * (edges[1:] + edges[:-1])
    used = (middle > 4) & (middle < numpy.mean(tops) - 4)
    profile = speed / numpy.maximum(number, 1)
    return (middle[number > 0], profile[number > 0], numpy.polyfit(middle[used], profile[used], 1)[0],
            numpy.mean(fractions), numpy.mean(masses))


def covered(height, radius, low, high):
    """Fraction of the strip between two heights that is covered by discs."""
    def below(level):
        share = numpy.clip((level - height) / radius, -1.0, 1.0)
        return (radius**2 * (0.5 * math.pi + numpy.arcsin(share) + share * numpy.sqrt(1 - share**2))).sum()

    return (below(high) - below(low)) / (WIDTH * (high - low))


def show(folder, report):
    figure, axes = bulk.subplots(1, 3, figsize=(15, 4.5))
    found = []
    for wished, end in SPEEDS.items():
        name = f"shear_{wished}"
        if not report.has(folder, name):
            continue
        columns = bulk.history(folder, name)
        time = columns["step/time"]
        start = 0.5 * time[-1]
        late = time >= start
        pull, press = columns["contacts/lower/fx"], -columns["contacts/lower/fy"]
        mu = pull[late].mean() / press[late].mean()
        layers, speeds, rate, fraction, mass = inside(folder, name, start)
        number = rate * math.sqrt(mass * WIDTH / press[late].mean())
        found.append((number, mu, fraction))
        report.say(f"     I = {number:.4f} (wished {wished}), over t = {start:g} to {time[-1]:g}: friction {mu:.3f}")
        report.check(f"shear force on the upper wall over the lower's, I = {number:.3f}",
                     -columns["contacts/upper/fx"][late].mean() / pull[late].mean(), 0.95, 1.05, "steady")
        report.check(f"pressure on the lower wall, I = {number:.3f}", press[late].mean() / WIDTH, 0.97, 1.03,
                     "that on the upper wall")
        report.check(f"macroscopic friction at I = {number:.3f}", mu, 0.22 + 1.1 * number, 0.28 + 1.1 * number,
                     "da Cruz et al. 2005: 0.25 + 1.1 I")
        report.check(f"volume fraction at I = {number:.3f}", fraction, 0.795 - 0.3 * number, 0.825 - 0.3 * number,
                     "da Cruz et al. 2005: 0.81 - 0.3 I")
        axes[2].plot(speeds / speeds.max(), layers, "o-", ms=3, label=f"I = {number:.3f}")
    line = numpy.linspace(0, 0.25, 2)
    for axis, column, law, label in ((axes[0], 1, 0.25 + 1.1 * line, "macroscopic friction"),
                                     (axes[1], 2, 0.81 - 0.3 * line, "volume fraction")):
        axis.plot(line, law, "k--", label="da Cruz et al. 2005")
        axis.plot([row[0] for row in found], [row[column] for row in found], "o", label="measured")
        axis.set(xlabel="I", ylabel=label)
    axes[2].set(xlabel="speed over the largest", ylabel="y [d]")
    if len(found) >= 3:
        rows = numpy.array(found)
        slope, start = numpy.polyfit(rows[:, 0], rows[:, 1], 1)
        report.check("slope of the friction over I", slope, 0.8, 1.4, "da Cruz et al. 2005: 1.1")
        loosening, densest = numpy.polyfit(rows[:, 0], rows[:, 2], 1)
        report.say(f"     lines: {start:.3f} + {slope:.2f} I, {densest:.3f} - {-loosening:.2f} I")
        report.check("decrease of the volume fraction over I", -loosening, 0.15, 0.45, "da Cruz et al. 2005: 0.3")
    for axis in axes:
        axis.legend(fontsize=8)
    report.draw(figure)


def smoke():
    """The upper wall moves down on a few rows and drags them along."""
    def check(folder, report):
        columns = bulk.history(folder, "small")
        late = columns["step/time"] > 10
        report.check("pressure", -columns["contacts/lower/fy"][late].mean() / WIDTH, 0.7, 1.3,
                     "the wall's weight")
        report.check("friction",
                     -columns["contacts/lower/fx"][late].mean() / columns["contacts/lower/fy"][late].mean(), 0.05,
                     1.0, "along the drag")

    return {"small": deck("small", 0.1, 20.0, 6)}, check


if __name__ == "__main__":
    sys.exit(bulk.main(__doc__, decks, show, smoke))
