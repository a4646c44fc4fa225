"""Janssen's law in a silo, 2D: the load on the floor saturates with the filling.

    tests/verification/bulk/janssen.py run DIR --scree SCREE     (64 to 1,024 discs, 200,000 steps each)
    tests/verification/bulk/janssen.py show DIR

Discs whose diameters vary by a fifth between two plane walls ten diameters apart, on a floor of discs that a
driver lowers slowly: the grains slide down along the walls, which carry what friction lets them. (Poured and left
alone a column hardly leans on its walls. silo.py moves the wall instead, in 3D.) Friction 0.5 between grains, 0.25 on
the walls, below the 0.28 or so of which a sheared bed is capable, so that it is at the walls that they slide.
Janssen: m_app = m_sat (1 - exp(-m/m_sat)), m the mass of the filling, m_app what the floor feels of it. m_sat is
the one number that is fitted, to all fillings together; from it follows K = (m/h) W / (2 mu_w m_sat), the
pressure on the walls over the vertical stress, h the height of the filling.

Checked are the balance of forces, that the walls are frictional at Coulomb's limit, the shape of the law, its
saturation, and K. Bands: forces and friction from mechanics; that columns whose walls move follow the law is
Ovarlez, Fond and Clement 2003 (Phys. Rev. E 67, 060302; from memory), the 8 % of m_sat allowed to the mean of
three samples are this script's own: one sample lies some 10 % from the next, as the law's K is that of its
packing. K between Rankine's active and passive states of a bed of friction 0.28, 0.57 to 1.75: wide, as the law
says nothing of K.
"""

import math
import sys

import numpy

import bulk

WIDTH = 10.0
FILLINGS = (8, 16, 32, 64, 128)  # rows of eight
SEEDS = (7, 8, 9)
SPEED = 0.01  # of the floor
END = 150.0
STEADY = 100.0
WALL_FRICTION = 0.25
LAW = "stiffness = 2e4\nrestitution = 0.5\nfriction = {}\ntangential_damping_ratio = 0.3\n"


def laws():
    """Contacts between particles, and with walls and floor; these do not touch each other."""
    text = "".join(f'[[materials]]\nname = "{name}"\n' for name in ("grain", "base"))
    for pair, law in (('["grain", "grain"]', LAW.format(0.5)), ('["grain", "base"]', LAW.format(WALL_FRICTION)),
                      ('["base", "base"]', "stiffness = 0.0\n")):
        text += f"[[contact.pairs]]\nmaterials = {pair}\n{law}"
    return text


def deck(name, rows, seed=7, end=END, speed=SPEED):
    floor = [((place + 0.5 - 0.5 * WIDTH, 0.0), 0.5) for place in range(int(WIDTH))]
    return "\n".join([
        f'title = "silo, {rows} rows"', "gravity = [0.0, -1.0]", 'velocities = "consistent"',
        bulk.table("space",
                   dimension=2,
                   min=f"[0.0, {-speed * end - 2}]",
                   max=f"[{WIDTH}, {1.25 * rows + 5}]",
                   x_min='"wall"',
                   x_max='"wall"',
                   wall_material='"base"'),
        bulk.table("time", end=end, step=7.5e-3),
        bulk.table("integrator", particles='"velocity-verlet"', substeps=10),
        laws(),
        bulk.body("floor", [0.5 * WIDTH, -0.5], floor, ground=False),
        bulk.table("[joints]",
                   name='"down"',
                   type='"translational"',
                   bodies='["ground", "floor"]',
                   axis="[0.0, 1.0]"),
        bulk.table("[drivers]", name='"piston"', joint='"down"', motion=f'{{ kind = "ramp", rate = {-speed} }}'),
        bulk.table("[particles]",
                   kind='"lattice"',
                   origin="[0.7, 0.7]",
                   spacing="[1.225, 1.225]",
                   size=f"[8, {rows}]",
                   radius='{ kind = "uniform", min = 0.4, max = 0.6 }',
                   density=4 / math.pi,
                   material='"grain"',
                   random_velocity=0.3,
                   seed=seed),
        bulk.output(name, end / 15, end / 3000, ["radius", "velocity"],
                    history_contacts='["floor", "x_min", "x_max"]')
    ])


def decks():
    return {f"silo_{rows}_{seed}": deck(f"silo_{rows}_{seed}", rows, seed) for rows in FILLINGS for seed in SEEDS}


def loads(folder, name, start):
    """Means from `start` on: mass of the filling, loads of floor and walls, friction on the walls over the
    pressure on them, and height of the filling above the floor."""
    columns = bulk.history(folder, name)
    late = columns["step/time"] >= start

    def mean(path):
        return columns[f"contacts/{path}"][late].mean()

    fields = list(bulk.snapshots(folder, name))[-1][1]
    mass = (4 * fields["radius"]**2).sum()
    carried = -mean("x_min/fy") - mean("x_max/fy")
    pressed = mean("x_max/fx") - mean("x_min/fx")
    height = numpy.sort(fields["position"][:, 1])[-8:].mean() + 0.5 - fields["position"][:, 1].min() + 0.5
    return mass, -mean("floor/fy"), carried, carried / pressed, height


def janssen(mass, saturated):
    return saturated * -numpy.expm1(-mass / saturated)


def fit(mass, floor):
    """m_sat with the least squares of the distances from the floor's loads."""
    trials = numpy.linspace(0.5, 2.0, 3001) * floor.max()
    return trials[numpy.argmin([((janssen(mass, trial) - floor)**2).sum() for trial in trials])]


def show(folder, report):
    found = {}
    for name in decks():
        if not report.has(folder, name):
            continue
        found[name] = loads(folder, name, STEADY)
        report.say("     {}: mass {:.1f}, floor {:.1f}, walls {:.1f}, their friction {:.3f}, height {:.1f}".format(
            name, *found[name]))
        for what, value in zip(("mass", "load on the floor"), found[name]):
            report.keep(folder, name, f"janssen/{what}, {name}", value)
    if not found:
        return
    mass, floor, walls, friction, height = numpy.array(list(found.values())).T
    balance = (floor + walls) / mass
    report.check("floor and walls over the weight, the farthest from 1", balance[abs(balance - 1).argmax()], 0.99,
                 1.01, "balance of forces")
    report.check("friction on the walls over the pressure, least", friction.min(), 0.85 * WALL_FRICTION,
                 1.001 * WALL_FRICTION, "Coulomb's limit, which a wall that slides has")
    saturated = fit(mass, floor)
    per_height = numpy.median(mass / height)
    away = (floor - janssen(mass, saturated)) / saturated
    report.say(f"     m_sat = {saturated:.1f}, fitted: {saturated / per_height:.1f} d of height; samples lie up to "
               f"{100 * abs(away).max():.0f} % of it from the law")
    filling = numpy.array([int(name.split("_")[1]) for name in found])
    for rows in sorted(set(filling)):
        samples = filling == rows
        report.check(f"mean of {sum(samples)} from the law, over m_sat, {rows} rows", away[samples].mean(), -0.08, 0.08,
                     "Ovarlez et al. 2003; the width is ours")
    deepest = filling == max(FILLINGS)
    if deepest.any():
        report.check("load of the deepest filling over m_sat", floor[deepest].mean() / saturated, 0.92, 1.08,
                     "saturation")
        report.check("and over its weight", (floor / mass)[deepest].max(), 0.0, 0.3, "the walls carry most")
    report.check("pressure on the walls over vertical stress, K", per_height * WIDTH / (2 * WALL_FRICTION * saturated),
                 0.57, 1.75, "Rankine, friction 0.28")
    figure, axes = bulk.subplots(figsize=(6, 4.5))
    line = numpy.linspace(0.0, mass.max(), 200)
    axes.plot(line, line, "k:", label="without walls")
    axes.plot(line, janssen(line, saturated), "k--", label=f"Janssen, $m_{{sat}}$ = {saturated:.0f}")
    axes.plot(mass, floor, "o", label="measured")
    axes.set(xlabel="mass of the filling", ylabel="load on the floor over g", ylim=(0, 1.3 * floor.max()))
    axes.legend()
    report.draw(figure)


def smoke():
    """A few rows come to rest on the floor, which moves down, and press on the walls."""
    def check(folder, report):
        mass, floor, walls, friction, height = loads(folder, "small", 20.0)
        report.check("floor and walls over the weight", (floor + walls) / mass, 0.98, 1.02, "balance of forces")
        report.check("walls over the weight", walls / mass, 0.05, 0.4, "they hold the grains back")
        report.check("friction on the walls", friction, 0.1, 1.001 * WALL_FRICTION, "Coulomb's limit")
        report.check("height", height, 5.0, 10.0, "eight rows")

    return {"small": deck("small", 8, end=30.0)}, check


if __name__ == "__main__":
    sys.exit(bulk.main(__doc__, decks, show, smoke))
