"""Discharge through round holes against Beverloo's law, W = C n sqrt(g) (D - k d)^2.5 (n: spheres per volume in
the bed).

    tests/verification/bulk/hopper.py run DIR --scree SCREE [--backend cuda]
        (400,000 steps of 7,800 to 12,300 spheres each)
    tests/verification/bulk/hopper.py show DIR

A bed about 18 diameters deep on a flat floor of fixed spheres with a hole, periodic in x and y; what falls
through comes back on top by the periodic side, so that the level stays. Rates follow from the spheres' mean
momentum: over a time in which the bed does not change on the whole, the number that passes any level per unit
time is -P_z/(m L_z).

Bands: literature as in bands.csv. Rates are some 16 % above those of a silo that empties through a hole with a
sharp edge (silo.py): another floor and another filling; which of both does it was not looked into.
"""

import math
import sys

import numpy

import bulk

HOLES = (5, 6, 8, 10)
LAW = "stiffness = 2e5\ndamping = 25.0\nfriction = 0.5\n"
HEIGHT = 34.0  # of the domain; the floor's surface is at FLOOR
FLOOR = 2.0
RIM = 0.25
STEADY = 30.0
END = 80.0


def width(hole):
    return 25.0 if hole > 8 else 20.0


def floor(hole, side):
    """Spheres of radius 1/4 on a lattice of 1/2 outside the hole, and a ring of radius RIM around it."""
    count = round(2 * side)
    places = [((i + 0.5) / 2 - side / 2, (j + 0.5) / 2 - side / 2) for i in range(count) for j in range(count)]
    edge = 0.5 * hole + RIM
    spheres = [((x, y, -0.25), 0.25) for x, y in places if math.hypot(x, y) > 0.5 * hole + 0.25]
    around = math.ceil(math.pi * edge / (0.7 * RIM))
    turns = [2.0 * math.pi * i / around for i in range(around)]
    return spheres + [((edge * math.cos(turn), edge * math.sin(turn), -RIM), RIM) for turn in turns]


def deck(name, hole, end=END, depth=18.0):
    side = width(hole)
    row = int(side / 1.08)
    count = int(1.09 * side * side * depth)
    return "\n".join([
        f'title = "discharge through a hole of {hole} diameters"', "gravity = [0.0, 0.0, -1.0]",
        bulk.table("space",
                   dimension=3,
                   min="[0.0, 0.0, 0.0]",
                   max=bulk.numbers([side, side, HEIGHT]),
                   **{f"{axis}_{end_}": '"periodic"'
                      for axis in "xyz"
                      for end_ in ("min", "max")}),
        bulk.table("time", end=end, step=4e-3),
        bulk.table("integrator", particles='"velocity-verlet"', substeps=20),
        bulk.pairs(LAW),
        bulk.body("base", [0.5 * side, 0.5 * side, FLOOR], floor(hole, side)),
        bulk.table("[particles]",
                   kind='"lattice"',
                   origin=bulk.numbers([0.54, 0.54, FLOOR + 0.6]),
                   spacing=bulk.numbers([side / row, side / row, 1.03]),
                   size=f"[{row}, {row}, {math.ceil(count / row**2)}]",
                   count=count,
                   radius=0.5,
                   mass=1.0,
                   material='"grain"',
                   random_velocity=0.3,
                   seed=hole),
        bulk.output(name, 0.5 * end, 0.1, ["image"])
    ])


def decks():
    return {f"hopper_{hole}": deck(f"hopper_{hole}", hole) for hole in HOLES}


def counted(folder, name):
    """Spheres that passed the periodic side between the last two snapshots, per unit time, corrected for
    those that are nearer to it now than before; and the number density of the bed."""
    (early, before), (late, after) = list(bulk.snapshots(folder, name))[-2:]
    before, after = (fields_by_id(fields) for fields in (before, after))
    fallen = -((after["image"][:, 2] - before["image"][:, 2]) * HEIGHT + after["position"][:, 2] -
               before["position"][:, 2])
    height = after["position"][:, 2]
    side = after["position"][:, :2].max()
    return fallen.sum() / HEIGHT / (late - early), ((height > FLOOR + 4) &
                                                    (height < FLOOR + 12)).sum() / (8.0 * side * side)


def fields_by_id(fields):
    order = numpy.argsort(fields["global_id"])
    return {key: values[order] for key, values in fields.items()}


def show(folder, report):
    figure, (left, right) = bulk.subplots(1, 2, figsize=(11, 4.5))
    found, densities = {}, []
    for hole in HOLES:
        name = f"hopper_{hole}"
        if not report.has(folder, name):
            continue
        columns = bulk.history(folder, name)
        time, rate = columns["step/time"], -columns["momentum/linear_z"] / HEIGHT
        late = time >= STEADY
        parts = [part.mean() for part in numpy.array_split(rate[late], 5)]
        found[hole] = rate[late].mean()
        left.plot(time[10:-9], numpy.convolve(rate, numpy.ones(20) / 20, "valid"), label=f"D = {hole} d")
        report.keep(folder, name, f"hopper/rate, {hole} d", found[hole], "sqrt(g/d)")
        crossed, density = counted(folder, name)
        densities.append(density)
        second = rate[time >= 0.5 * END].mean()
        report.say(f"     rate through {hole} d: {found[hole]:.2f}, in five parts of the time " +
                   " ".join(f"{part:.2f}" for part in parts))
        report.check(f"counted over from momentum, {hole} d, second half", crossed / second, 0.98, 1.02,
                     "they are one number")
    wide = [hole for hole in found if hole > 5]  # the law holds for more than five diameters
    if len(wide) >= 3:
        holes, rates = numpy.array(wide), numpy.array([found[hole] for hole in wide])
        slope, cut = numpy.polyfit(holes, rates**0.4, 1)
        k, c = -cut / slope, slope**2.5 / numpy.mean(densities)
        exponent = numpy.polyfit(numpy.log(holes - k), numpy.log(rates), 1)[0]
        report.say(f"     density of the bed {numpy.mean(densities):.3f} spheres per volume")
        report.check("Beverloo's C", c, 0.53, 0.66, "Beverloo 1961; Nedderman 1992")
        report.check("Beverloo's k", k, 1.2, 2.0, "the same")
        report.check("largest deviation from the law",
                     abs(rates / (slope * (holes - k))**2.5 - 1).max(), 0.0, 0.05,
                     "silo.csv: 0.03 of an independent program")
        report.check("exponent of the rate over D - k d", exponent, 2.4, 2.6, "Mankoc et al. 2007")
        fine = numpy.linspace(k, 12, 100)
        right.plot(fine, (slope * (fine - k))**2.5, "k-", label=f"C = {c:.3f}, k = {k:.2f}")
        right.plot(list(found), list(found.values()), "o", label="measured")
    left.set(xlabel="t [sqrt(d/g)]", ylabel="spheres per unit time (over 2)", title="from the mean momentum")
    right.set(xlabel="D [d]", ylabel="spheres per unit time", title="Beverloo's law")
    for axes in (left, right):
        axes.legend(fontsize=8)
    report.draw(figure)


def smoke():
    """A bed of three layers flows out through the hole and enters from above."""
    def check(folder, report):
        (_, before), (_, after) = list(bulk.snapshots(folder, "small"))[-2:]
        report.check("spheres that came in from above", (before["image"] - after["image"])[:, 2].sum(), 20, 800,
                     "some")
        columns = bulk.history(folder, "small")
        report.check("spheres that fall", -columns["momentum/linear_z"][-1], 1.0, 1e4, "downward")

    return {"small": deck("small", 6, 4.0, 3.0)}, check


if __name__ == "__main__":
    sys.exit(bulk.main(__doc__, decks, show, smoke))
