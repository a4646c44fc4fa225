"""Angle of repose against friction and rolling friction, in 2D and 3D: the heap left on a plate from which
grains run off.

    tests/verification/bulk/heap.py run DIR --scree SCREE [--backend cuda]
        (200,000 steps of 1,800 to 7,700 grains each)
    tests/verification/bulk/heap.py show DIR

A loose block falls on a rough plate of fixed grains that is open at both ends; what passes the edges falls
away, and two slopes stay (the drained angle of repose; discharging device of Zhou, Xu, Yu and Zulli 2001). In
3D the heap is a wedge of equal spheres, periodic across, in 2D of discs whose diameters vary by a fifth. Angles
are those of lines through the surface of both flanks. Bands: bands.csv; in 2D arctan of the macroscopic
friction of slow shear (da Cruz et al. 2005: 0.25 at mu = 0.4), to 6 degrees more as small heaps are steeper.
"""

import math
import sys

import numpy

import bulk

FRICTION = (0.1, 0.3, 0.5, 0.8)  # without rolling friction
ROLLING = (0.1, 0.3)  # at friction 0.5
HALF = {2: 40, 3: 30}  # half length of the plate
ACROSS = 6.0
END = 150.0


def law(friction, rolling):
    text = f"stiffness = 2e4\nrestitution = 0.5\nfriction = {friction}\ntangential_damping_ratio = 0.3\n"
    return text + (f"rolling_friction = {rolling}\nrolling_damping_ratio = 0.3\n" if rolling else "")


def deck(name, dimension, friction, rolling, end=END, layers=28, half=None):
    half = half or HALF[dimension]
    flat = dimension == 2

    def place(x, across, up):
        return bulk.numbers([x, up] if flat else [x, across, up])

    plate = [((x, 0.0) if flat else (x, y + 0.5, 0.0), 0.5) for x in range(-half, half + 1)
             for y in range(1 if flat else int(ACROSS))]
    row = int(2 * half / 1.25) if flat else int(2 * half / 1.08)
    spacing = 2 * half / row
    sides = {} if flat else {"y_min": '"periodic"', "y_max": '"periodic"'}
    return "\n".join([
        f'title = "heap, friction {friction}, rolling friction {rolling}"', f"gravity = {place(0, 0, -1)}",
        bulk.table("space",
                   dimension=dimension,
                   min=place(-half - 10, 0, -8),
                   max=place(half + 10, ACROSS, 60),
                   leaving='"remove"',
                   **sides),
        bulk.table("time", end=end, step=7.5e-3),
        bulk.table("integrator", particles='"velocity-verlet"', substeps=10),
        bulk.pairs(law(friction, rolling)),
        bulk.body("base", [0.0, 0.0] if flat else [0.0, 0.0, 0.0], plate),
        bulk.table("[particles]",
                   kind='"lattice"',
                   origin=place(-half + 0.5 * spacing, 0.6, 1.2),
                   spacing=bulk.numbers([spacing, 1.25] if flat else [spacing, 1.2, 1.05]),
                   size=f"[{row}, {layers}]" if flat else f"[{row}, 5, {layers}]",
                   material='"grain"',
                   radius='{ kind = "uniform", min = 0.4, max = 0.6 }' if flat else 0.5,
                   density=4 / math.pi if flat else 6 / math.pi,
                   random_velocity=0.3,
                   seed=7),
        bulk.output(name, 0.0, 0.5, ["radius", "velocity"])
    ])


def cases():
    """Names with dimension, friction and rolling friction."""
    for dimension in (2, 3):
        for friction, rolling in [(mu, 0.0) for mu in FRICTION] + [(0.5, mu_r) for mu_r in ROLLING]:
            yield f"heap_{dimension}d_{friction}_{rolling}", dimension, friction, rolling


def decks():
    return {name: deck(*[name, *case]) for name, *case in cases()}


def surface(fields, half):
    """Middles of strips one diameter wide along the plate, and the height of the topmost particle there: in 3D the
    mean over strips across."""
    place, top = fields["position"], fields["position"][:, 1] + fields["radius"]
    across = numpy.zeros(len(place), int)
    if place[:, 2].any():
        top, across = place[:, 2] + fields["radius"], numpy.clip(place[:, 1].astype(int), 0, 5)
    strip = numpy.floor(place[:, 0] + half).astype(int)
    heights = numpy.full((2 * half, across.max() + 1), 0.5)
    on_plate = (strip >= 0) & (strip < 2 * half)
    numpy.maximum.at(heights, (strip[on_plate], across[on_plate]), top[on_plate])
    return numpy.arange(2 * half) + 0.5 - half, heights.mean(axis=1)


def angle(fields, half):
    """Angles of both flanks [degrees]."""
    x, height = surface(fields, half)
    found = []
    for side in (-1, 1):
        flank = (side * x > 4) & (side * x < half - 3)
        found.append(-side * math.degrees(math.atan(numpy.polyfit(x[flank], height[flank], 1)[0])))
    return found


def band(dimension, friction, rolling):
    """Lowest and highest angle expected, and their source; none where only the trend is known."""
    if rolling == 0.0 and dimension == 3 and friction in (0.3, 0.5):
        return 16, 25, "simulated heaps of equal spheres, mu 0.3 to 0.6: bands.csv"
    if rolling == 0.0 and dimension == 2 and friction in (0.3, 0.5):
        return 13, 20, "arctan of the friction of slow shear, da Cruz et al. 2005, to 6 degrees more"
    if rolling == 0.3 and dimension == 3:
        return 26, 36, "between glass beads and dry sand: bands.csv"
    return None


def grows(report, found, dimension, apart):
    """The trend: with friction and with rolling friction. The difference between the two flanks of a heap is a
    measure of the error of its angle: a step between two angles may be as negative as two standard errors."""
    error = math.sqrt(2.0 * numpy.mean(numpy.square(apart))) if apart else 0.0
    for keys, what in (([(mu, 0.0) for mu in FRICTION], "friction"), ([(0.5, mu_r) for mu_r in (0.0, *ROLLING)],
                                                                      "rolling friction")):
        angles = [found.get((dimension, *key)) for key in keys]
        if None in angles:
            continue
        report.say(f"     {dimension}D, against {what}: " + ", ".join(f"{angle:.1f}" for angle in angles) +
                   f"; standard error of a difference {error:.1f} degrees")
        report.check(f"{dimension}D: least growth with {what}", min(numpy.diff(angles)), -2.0 * error, 90.0,
                     "grows, and saturates: Zhou et al. 2001")
        report.check(f"{dimension}D: growth with {what}, first to last", angles[-1] - angles[0], 2.0 * error,
                     90.0, "the same")


def show(folder, report):
    figure, axes = bulk.subplots(2, 2, figsize=(13, 8))
    found, apart = {}, {2: [], 3: []}
    for name, dimension, friction, rolling in cases():
        if not report.has(folder, name):
            continue
        last = list(bulk.snapshots(folder, name))[-1][1]
        left, right = angle(last, HALF[dimension])
        found[dimension, friction, rolling] = 0.5 * (left + right)
        report.keep(folder, name, f"heap/{dimension}D, friction {friction}, rolling friction {rolling}",
                    0.5 * (left + right), "deg")
        apart[dimension].append(0.5 * (left - right))
        speed = numpy.linalg.norm(last["velocity"], axis=1)
        x, height = surface(last, HALF[dimension])
        axes[dimension - 2, 0].plot(x,
                                    height,
                                    label=f"$\\mu$ = {friction}, $\\mu_r$ = {rolling}: "
                                    f"{0.5 * (left + right):.1f}$^\\circ$")
        report.say(
            f"     {dimension}D, friction {friction}, rolling friction {rolling}: {left:.1f} and {right:.1f} degrees, "
            f"{len(speed)} grains left, median speed {numpy.median(speed):.1e}")
        expected = band(dimension, friction, rolling)
        if expected:
            report.check(f"{dimension}D, friction {friction}, rolling friction {rolling}", 0.5 * (left + right),
                         *expected)
    for dimension in (2, 3):
        grows(report, found, dimension, apart[dimension])
        left, right = axes[dimension - 2]
        left.set(xlabel="x [d]", ylabel="height [d]", title=f"{dimension}D", aspect="equal")
        left.set_ylim(0, 45)
        left.legend(fontsize=7, ncol=2, loc="upper center")
        for keys, label in (([(mu, 0.0) for mu in FRICTION], "against $\\mu$, no rolling friction"),
                            ([(0.5, mu_r) for mu_r in (0.0, *ROLLING)], "against $\\mu_r$, $\\mu$ = 0.5")):
            points = [(key[0] if key[1] == keys[-1][1] == 0.0 else key[1], found[(dimension, *key)])
                      for key in keys if (dimension, *key) in found]
            right.plot(*zip(*points), "o-", label=label) if points else None
        right.set(xlabel="$\\mu$ or $\\mu_r$", ylabel="angle [degrees]", ylim=(0, 40))
        right.legend(fontsize=8)
    report.draw(figure)


def smoke():
    """A small block in 2D and one in 3D run off a short plate; particles stay on it."""
    def check(folder, report):
        for name in ("flat", "deep"):
            first, last = [fields for _, fields in bulk.snapshots(folder, name)]
            gone = 1 - len(last["position"]) / len(first["position"])
            report.check(f"share that left ({name})", gone, 0.02, 0.98, "some do")
            report.check(f"lowest grain on the plate ({name})",
                         surface(last, 6)[1].min(), 0.0, 12.0, "the plate holds")

    return {"flat": deck("flat", 2, 0.5, 0.1, 15.0, 6, 6), "deep": deck("deep", 3, 0.5, 0.1, 15.0, 6, 6)}, check


if __name__ == "__main__":
    sys.exit(bulk.main(__doc__, decks, show, smoke))
