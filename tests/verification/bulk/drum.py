"""Rotating drum, 2D: the slope that flows against friction.

    tests/verification/bulk/drum.py run DIR --scree SCREE     (529 discs, 400,000 steps per friction)
    tests/verification/bulk/drum.py show DIR

Discs whose diameters vary by a fifth in a drum of 40 diameters, a ring of discs on a driven body, two fifths
full, at omega^2 R/g = 0.008 (a steady flow, hardly bent). The angle is that of a line through the surface in
the middle half of the drum. Checked are its growth with friction; its size, no less than arctan of the friction
of slow shear (da Cruz et al. 2005: 0.11 without friction, 0.25 at mu = 0.4 and more) and no more than what
heaps of discs without rolling resistance reach (30 degrees, from memory); and that the torque of the grains on
the drum is their weight times how far their centre is carried sideways.
"""

import math
import sys

import numpy

import bulk

FRICTION = (0.1, 0.3, 0.5, 0.8)
RADIUS = 20.0  # to the inner edge of the ring
RATE = 0.02
END = 300.0
STEADY = 120.0
LAW = "stiffness = 2e4\nrestitution = 0.5\nfriction = {}\ntangential_damping_ratio = 0.3\n"


def deck(name, friction, end=END, rate=RATE):
    count = 144
    ring = [(((RADIUS + 0.5) * math.cos(2 * math.pi * i / count),
              (RADIUS + 0.5) * math.sin(2 * math.pi * i / count)), 0.5) for i in range(count)]
    return "\n".join([
        f'title = "drum, friction {friction}"', "gravity = [0.0, -1.0]", 'velocities = "consistent"',
        bulk.table("space", dimension=2, min="[-24.0, -24.0]", max="[24.0, 24.0]"),
        bulk.table("time", end=end, step=7.5e-3),
        bulk.table("integrator", particles='"velocity-verlet"', substeps=10),
        bulk.pairs(LAW.format(friction)),
        bulk.body("drum", [0.0, 0.0], ring, ground=False),
        bulk.table("[joints]", name='"axle"', type='"revolute"', bodies='["ground", "drum"]'),
        bulk.table("[drivers]", name='"motor"', joint='"axle"', motion=f'{{ kind = "ramp", rate = {-rate} }}'),
        bulk.table("[particles]",
                   kind='"lattice"',
                   center="[0.0, 0.0]",
                   spacing="[1.205, 1.205]",
                   size="[23, 23]",
                   radius='{ kind = "uniform", min = 0.4, max = 0.6 }',
                   density=4 / math.pi,
                   material='"grain"',
                   random_velocity=0.3,
                   seed=5),
        bulk.output(name, end / 50, end / 3000, ["radius", "velocity"], history_contacts='["drum"]')
    ])


def decks():
    return {f"drum_{friction}": deck(f"drum_{friction}", friction) for friction in FRICTION}


def surface(fields):
    """Strips one diameter wide in the drum's middle half: middles, and the height of the topmost disc."""
    x, top = fields["position"][:, 0], fields["position"][:, 1] + fields["radius"]
    middles = numpy.arange(-9.5, 10.0)
    return middles, numpy.array([top[abs(x - middle) < 0.5].max(initial=-RADIUS) for middle in middles])


def torque(folder, name, start):
    """Mean torque of the particles on the drum, and its standard error by ten parts."""
    columns = bulk.history(folder, name)
    values = columns["contacts/drum/torque_z"][columns["step/time"] >= start]
    return values.mean(), numpy.std([part.mean() for part in numpy.array_split(values, 10)]) / math.sqrt(10)


def show(folder, report):
    figure, axes = bulk.subplots(1, 3, figsize=(15, 4.8))
    angles = {}
    for friction in FRICTION:
        name = f"drum_{friction}"
        if not report.has(folder, name):
            continue
        slopes, sideways, heights = [], [], []
        for time, fields in bulk.snapshots(folder, name):
            if time < STEADY:
                continue
            middles, height = surface(fields)
            heights.append(height)
            slopes.append(math.degrees(math.atan(-numpy.polyfit(middles, height, 1)[0])))
            mass = 4 * fields["radius"]**2
            sideways.append((mass * fields["position"][:, 0]).sum())
        angles[friction] = abs(numpy.mean(slopes))
        measured, error = torque(folder, name, STEADY)
        report.say(f"     friction {friction}: {numpy.mean(slopes):.1f} degrees, sd of {len(slopes)} times "
                   f"{numpy.std(slopes):.1f}")
        report.check(f"torque on the drum over weight x offset, friction {friction}",
                     -measured / numpy.mean(sideways), 0.95, 1.05, "balance of angular momentum")
        low = math.degrees(math.atan(0.25 if friction >= 0.4 else 0.11))
        report.check(f"angle at friction {friction}", angles[friction], low, 30.0,
                     "da Cruz et al. 2005; heaps of discs")
        axes[1].plot(middles, numpy.mean(heights, axis=0), "o-", ms=3, label=f"$\\mu$ = {friction}")
    if len(angles) == len(FRICTION):
        values = [angles[friction] for friction in FRICTION]
        report.check("least growth of the angle with friction", min(numpy.diff(values)), -1.0, 30.0,
                     "grows, and saturates")
        report.check("growth from 0.1 to 0.8", values[-1] - values[0], 3.0, 30.0, "the same")
    if angles:
        place, radius = fields["position"], fields["radius"]
        axes[0].scatter(place[:, 0],
                        place[:, 1],
                        s=(3.6 * radius / 0.5)**2,
                        c=numpy.linalg.norm(fields["velocity"], axis=1))
        axes[0].set(aspect="equal",
                    title=f"last state, $\\mu$ = {friction}; colour: speed",
                    xlim=(-22, 22),
                    ylim=(-22, 22))
        axes[2].plot(list(angles), list(angles.values()), "o-")
        axes[1].legend(fontsize=8)
    axes[1].set(xlabel="x [d]", ylabel="mean height of the surface [d]")
    axes[2].set(xlabel="$\\mu$", ylabel="angle [degrees]", ylim=(0, 35))
    report.draw(figure)


def smoke():
    """The block falls into the drum, which carries it to one side."""
    def check(folder, report):
        last = list(bulk.snapshots(folder, "small"))[-1][1]
        report.check("farthest grain",
                     numpy.linalg.norm(last["position"], axis=1).max(), 15.0, RADIUS, "the drum holds")
        report.check("mean offset", last["position"][:, 0].mean(), -12.0, -0.3,
                     "carried to the side that goes up")

    return {"small": deck("small", 0.5, 20.0, 0.05)}, check


if __name__ == "__main__":
    sys.exit(bulk.main(__doc__, decks, show, smoke))
