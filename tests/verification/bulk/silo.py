"""A cylinder of spheres on a flat floor, cylinder and floor of triangles: discharge through a hole in the floor, and
what the floor carries when the wall moves up. The cases of silo.csv and janssen.csv of tests/reference/contact,
which another program with analytic walls computed.

    tests/verification/bulk/silo.py run DIR --scree SCREE [--backend cuda]
        (600,000 to 750,000 steps of 40,000 spheres through each hole, 1.4 million of 16,000 in the other)
    tests/verification/bulk/silo.py show DIR

The spheres fall from a loose lattice and rest, the hole closed by a lid. At t = FILLED the lid drops, or the wall
begins to move. Rates are slopes of the number that has left. The vertical stress at a height is the weight of what
is above less the friction of the wall there, from the triangles' own shear.

Bands: the independent program's numbers, with the tolerances that stand in its tables.
"""

import math
import sys

import numpy

import bulk

HOLES = (6, 8, 10, 12)
OF_SAME_PROGRAM = {6: 24.0, 10: 118.8}  # rates from its author in addition to silo.csv
RATE_TOLERANCE = {6: 0.05, 8: 0.03, 10: 0.03, 12: 0.03}
DENSITY = 1.09  # spheres per volume in the silo, of that program
LAW = "stiffness = 2e5\ndamping = 25.0\nfriction = 0.5\n"
FILLED = 40.0
OPENED = 5.0  # after FILLED the rate is constant
FLOWN = {6: 110.0, 8: 110.0, 10: 80.0, 12: 60.0}
RAISED = 240.0  # duration of the wall's motion
STEADY = 120.0
UP = 0.02  # its speed
SEGMENTS = 144  # of a full circle; polygon and circle differ by 3e-4 of the area


def filling(diameter, count, lowest=0.7, spacing=1.1):
    """Centres of a loose lattice in the cylinder, layer by layer."""
    reach = int(diameter / spacing)
    row = [(i * spacing, j * spacing) for i in range(-reach, reach + 1) for j in range(-reach, reach + 1)]
    layer = [place for place in row if math.hypot(*place) < 0.5 * diameter - 0.7]
    return [(*layer[k % len(layer)], lowest + k // len(layer) * spacing) for k in range(count)]


def cylinder(name, diameter, bottom, top, refine=None):
    """A tube of triangles; its inside is the silo's wall."""
    keys = {} if refine is None else {"refine": refine}
    return bulk.table("[meshes]",
                      name=f'"{name}"',
                      kind='"pipe"',
                      inner_radius=0.5 * diameter,
                      radius=0.5 * diameter + 1.0,
                      length=top - bottom,
                      segments=SEGMENTS,
                      offset=bulk.numbers([0.0, 0.0, 0.5 * (bottom + top)]),
                      **keys)


def wall(name, *motions, **keys):
    listed = {} if not motions else {"motions": "[" + ", ".join(motions) + "]"}
    return bulk.table("[walls]", name=f'"{name}"', material='"base"', **keys, **listed)


def case(title, diameter, count, lowest, end, parts):
    """Common parts of both cases, with the meshes and walls of the case."""
    places = filling(diameter, count)
    reach, top = 0.5 * diameter + 2.0, places[-1][2] + 2.0
    return [
        f'title = "{title}"', "gravity = [0.0, 0.0, -1.0]",
        bulk.table("space",
                   dimension=3,
                   min=bulk.numbers([-reach, -reach, lowest]),
                   max=bulk.numbers([reach, reach, top]),
                   leaving='"remove"'),
        bulk.table("time", end=end, step=4e-3),
        bulk.table("integrator", particles='"velocity-verlet"', substeps=20),
        bulk.pairs(LAW), *parts(top),
        bulk.table("[particles]",
                   kind='"list"',
                   positions="[" + ", ".join(map(bulk.numbers, places)) + "]",
                   radius=0.5,
                   mass=1.0,
                   material='"grain"',
                   random_velocity=0.3,
                   seed=1)
    ]


def discharge(name, hole, end, diameter=30.0, count=40000, filled=FILLED):
    def parts(top):
        drop = f'{{ type = "translation", direction = [0.0, 0.0, -1.0], displacement = ' \
               f'{{ kind = "step", end_value = 20.0, start = {filled}, end = {filled + 1} }} }}'
        return [
            bulk.table("[meshes]",
                       name='"floor"',
                       kind='"plate"',
                       size=bulk.numbers([diameter + 3.0, diameter + 3.0, 1.0]),
                       hole_radius=0.5 * hole,
                       segments=SEGMENTS,
                       offset="[0.0, 0.0, -0.5]"),
            bulk.table("[meshes]", name='"lid"', kind='"rectangle"', size=bulk.numbers([hole + 2.0, hole + 2.0])),
            cylinder("cylinder", diameter, -1.0, top),
            wall("floor", mesh='"floor"'),
            wall("cylinder", mesh='"cylinder"'),
            wall("lid", drop, mesh='"lid"')
        ]

    return "\n".join(
        case(f"discharge through a hole of {hole} diameters", diameter, count, -3.0, end, parts) +
        [bulk.output(name, end, 0.2, ["velocity"], surface_fields="[]")])


def raised(name, end, diameter=20.0, count=16000, filled=FILLED):
    def parts(top):
        up = f'{{ type = "translation", direction = [0.0, 0.0, 1.0], displacement = ' \
             f'{{ kind = "ramp", rate = {UP}, start = {filled}, end = {filled + 1} }} }}'
        return [
            cylinder("cylinder", diameter, -2.0 - UP * RAISED, top, refine=2.5),
            wall("cylinder", up, mesh='"cylinder"'),
            wall("floor", point="[0.0, 0.0, 0.0]", normal="[0.0, 0.0, 1.0]")
        ]

    return "\n".join(
        case("a silo whose wall moves up", diameter, count, -1.0, end, parts) +
        [bulk.output(name, 4.0, 0.2, [], history_contacts='["floor", "cylinder"]')])


def decks():
    return {
        "raised": raised("raised", FILLED + RAISED),
        **{f"silo_{hole}": discharge(f"silo_{hole}", hole, FILLED + FLOWN[hole])
           for hole in HOLES}
    }


def stresses(folder, name, start):
    """Means over the snapshots from `start` on, at heights 0, 1, ...: spheres above, friction of the wall on them
    and the normal force on the wall, both above. A triangle's force counts as spread over its height."""
    heights, total, taken = numpy.arange(0.0, 60.0), numpy.zeros((3, 60)), 0
    for snapshot in bulk.run(folder, name).snapshots:
        if snapshot.time < start - 1e-6:
            continue
        taken += 1
        surfaces = snapshot.surfaces
        corners = surfaces["position"].values[surfaces.triangles]
        edges = corners[:, 1:] - corners[:, :1]
        area = 0.5 * numpy.linalg.norm(numpy.cross(edges[:, 0], edges[:, 1]), axis=1)
        shear, pressure = surfaces["shear"].values[:, 2], surfaces["pressure"].values
        touched = pressure > 0
        low, high = (of(corners[touched, :, 2], axis=1)[:, None] for of in (numpy.min, numpy.max))
        above = numpy.clip((high - heights) / (high - numpy.maximum(low, 0.0)), 0.0, 1.0)  # none is below the floor
        total[0] += (snapshot.particles["position"].values[:, 2:] > heights).sum(axis=0)
        total[1] -= (shear * area)[touched] @ above
        total[2] += (pressure * area)[touched] @ above
    return heights, total / taken


def show_rates(folder, report, axes):
    table = bulk.reference("silo.csv")
    found, rates = {}, OF_SAME_PROGRAM | dict(zip(table["D"].astype(int), table["W"]))
    for hole in HOLES:
        name = f"silo_{hole}"
        if not report.has(folder, name):
            continue
        columns = bulk.history(folder, name)
        time, left = columns["step/time"] - FILLED, columns["step/particles_escaped"]
        report.check(f"spheres that left before the hole of {hole} d was opened", left[time < 0].max(), 0, 0, "closed")
        steady = time >= OPENED
        found[hole] = numpy.polyfit(time[steady], left[steady], 1)[0]
        parts = [numpy.polyfit(t, n, 1)[0] for t, n in zip(numpy.array_split(time[steady], 6),
                                                          numpy.array_split(left[steady], 6))]
        report.say(f"     through {hole} d, in six parts of the time: " + " ".join(f"{part:.1f}" for part in parts))
        report.keep(folder, name, f"silo/rate over the independent program's, {hole} d", found[hole] / rates[hole])
        report.check(f"rate through {hole} d over that of the independent program", found[hole] / rates[hole],
                     1 - RATE_TOLERANCE[hole], 1 + RATE_TOLERANCE[hole],
                     "its author" if hole in OF_SAME_PROGRAM else "silo.csv")
        axes.plot(time, left, label=f"D = {hole} d")
    if len(found) == len(HOLES):
        holes, roots = numpy.array(list(found)), numpy.array(list(found.values()))**0.4
        slope, cut = numpy.polyfit(holes, roots, 1)
        report.say(f"     Beverloo's law with the independent program's density: C = {slope**2.5 / DENSITY:.3f}, "
                   f"k = {-cut / slope:.2f} (that program's rates: 0.552, 1.68)")
        report.check("largest deviation from the law", abs((roots / (slope * holes + cut))**2.5 - 1).max(), 0.0, 0.05,
                     "silo.csv: 0.03 of the independent program")
    axes.set(xlabel="t [sqrt(d/g)] after opening", ylabel="spheres that have left")


def show_raised(folder, report, axes):
    if not report.has(folder, "raised"):
        return
    columns = bulk.history(folder, "raised")
    start, time = FILLED + STEADY, columns["step/time"]
    heights, (above, friction, pressed) = stresses(folder, "raised", start)
    carried = -columns["contacts/floor/fz"] / above[0]
    rest = (time > FILLED - 10) & (time < FILLED)
    report.say(f"     the floor carries {carried[rest].mean():.3f} at rest (depends on the filling: not judged)")
    report.keep(folder, "raised", "silo/share of the weight on the floor", carried[time >= start].mean())
    report.check("share of the weight on the floor", carried[time >= start].mean(), 0.4243 - 0.02, 0.4243 + 0.02,
                 "janssen.csv")
    stress = (above - friction) / (math.pi * 100.0)
    table = bulk.reference("janssen.csv")
    places = table["z"].astype(int)
    away = stress[places] - table["sigma"]
    report.check("vertical stress, the farthest from the independent program's", away[abs(away).argmax()], -0.6, 0.6,
                 "janssen.csv")
    inside = (heights >= 3) & (heights <= 40)
    top = heights[above > 0.5].max()
    density = (above[10] - above[31]) / (21 * math.pi * 100.0)
    weight = above / (math.pi * 100.0 * density)  # as a height
    trials = numpy.linspace(10.0, 40.0, 3001)
    residues = [((density * trial * -numpy.expm1(-weight[inside] / trial) - stress[inside])**2).sum()
                for trial in trials]
    decay = trials[numpy.argmin(residues)]
    report.check("spheres per volume", density, 1.1109 * 0.98, 1.1109 * 1.02, "janssen.csv; the 2 % are this script's")
    report.keep(folder, "raised", "silo/decay length", decay, "d")
    report.check("decay length [d]", decay, 21.29 * 0.93, 21.29 * 1.07, "janssen.csv")
    report.check("friction of the wall over the normal force on it", friction[0] / pressed[0], 0.233 - 0.02,
                 0.233 + 0.02, "janssen.csv")
    axes.plot(stress[heights < top], heights[heights < top], label="measured")
    axes.plot(table["sigma"], table["z"], "r+", label="independent program")
    axes.set(xlabel="vertical stress [m g/d^2]", ylabel="z [d]")


def show(folder, report):
    figure, (left, right) = bulk.subplots(1, 2, figsize=(11, 4.5))
    show_rates(folder, report, left)
    show_raised(folder, report, right)
    for axes in (left, right):
        axes.legend(fontsize=8)
    report.draw(figure)


def smoke():
    """A small silo holds its filling until its lid drops; in another one the wall moves up and carries load."""
    def check(folder, report):
        columns = bulk.history(folder, "small")
        time, left = columns["step/time"], columns["step/particles_escaped"]
        report.check("spheres that left before the lid dropped", left[time < 3].max(), 0, 0, "closed")
        report.check("and after", left[-1], 5, 60, "some")
        _, (above, friction, pressed) = stresses(folder, "up", 7.0)
        lifted = bulk.history(folder, "up")["contacts/cylinder/fz"][-1]
        report.check("friction on the wall by triangles over that on the whole", -friction[0] / lifted, 0.999, 1.001,
                     "one force")
        report.check("over the normal force", friction[0] / pressed[0], 0.0, 0.5, "Coulomb")
        report.check("spheres above the floor", above[0], 200, 200, "all")

    return {
        "small": discharge("small", 4, 6.0, 8.0, 400, 3.0),
        "up": raised("up", 8.0, 6.0, 200, 4.0)
    }, check


if __name__ == "__main__":
    sys.exit(bulk.main(__doc__, decks, show, smoke))
