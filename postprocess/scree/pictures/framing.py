"""What part of a scene a picture shows, and from where."""

import numpy as np

from scree.fields import POSITION
from scree.pictures.mechanism import Mechanism

LONGEST_SIDE = 7.5  # of the axes [inch]
SPREAD = 40  # snapshots in which bodies are looked for
AZIMUTH, ELEVATION = 30, 26  # of the eye in space [degrees]
NEAR = 0.2  # of a picture's longest side: a side of the space that is no farther off is shown, too
IN_PLANE = np.array([1.0, 1.0, 0.0])


def bounds(series, snapshots, strays):
    """Box around the points of some snapshots, grown by the radius. strays: percentage left out per side."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for snapshot in snapshots:
        points = series.rows(snapshot, POSITION)
        if len(points) == 0:
            continue
        reach = series.rows(snapshot, "radius").max()
        low = np.minimum(low, np.percentile(points, strays, axis=0) - reach)
        high = np.maximum(high, np.percentile(points, 100 - strays, axis=0) + reach)
    return low, high


def union(*boxes):
    return np.min([low for low, _ in boxes], axis=0), np.max([high for _, high in boxes], axis=0)


def body_bounds(run, snapshots):
    """Of shapes, meshes, joints and springs."""
    mechanism = Mechanism(run.model, run.motion, 0.0)
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for snapshot in snapshots:
        lines, points = mechanism.draw(snapshot)
        everything = np.concatenate([a.reshape(-1, 3) for a in (*lines.values(), *points.values())])
        low = np.min(np.concatenate([[low], everything]), axis=0)
        high = np.max(np.concatenate([[high], everything]), axis=0)
    if run.surfaces:
        low, high = union((low, high), run.surfaces.bounds(snapshots))
    if run.bodies is None:
        return low, high
    return union((low, high), bounds(run.bodies, snapshots, strays=0))


def every_way(run):
    """Snapshots in which bodies are looked for that swing."""
    return np.unique(np.linspace(0, len(run.particles) - 1, SPREAD).astype(int))


def plane_bounds(run, snapshots):
    """All but stray particles and those outside the space, with a margin."""
    low, high = bounds(run.particles, snapshots, strays=0.5)
    if np.isfinite(low).all():
        low, high = np.maximum(low, run.model.low), np.minimum(high, run.model.high)
    # Where bodies swing, all the way.
    way = body_bounds(run, every_way(run))
    way = np.maximum(way[0], run.model.low), np.minimum(way[1], run.model.high)
    boxes = [(low, high), body_bounds(run, snapshots)] + [way] * bool((way[1] >= way[0]).all())
    low, high = union(*boxes)
    if not (np.isfinite(low).all() and (high >= low).all() and (high > low).any()):
        low, high = run.model.low, run.model.high
    low, high = low * IN_PLANE, high * IN_PLANE  # meshes in the plane reach out of it, for other programs to show
    near = NEAR * max(high - low)  # sides of the space that would be cut off by little
    low = np.where((low > run.model.low) & (low - run.model.low < near), run.model.low, low)
    high = np.where((high < run.model.high) & (run.model.high - high < near), run.model.high, high)
    margin = 0.04 * max(high - low)
    return low - margin, high + margin


def figure_size(width, height):
    """Axes of this shape [inch], not narrower or flatter than 1 : 2.2."""
    scale = LONGEST_SIDE / max(width, height)
    return max(scale * width, LONGEST_SIDE / 2.2), max(scale * height, LONGEST_SIDE / 2.2)


def scene_bounds(run, snapshots, bodies):
    """Of what a picture in space shows: the particles that are in the space, all but strays, and the bodies. Without
    particles the bodies wherever they swing. bodies: their bounds."""
    low, high = bounds(run.particles, snapshots, strays=0.2)
    low, high = np.maximum(low, run.model.low), np.minimum(high, run.model.high)
    if (high >= low).all():
        return union((low, high), bodies)
    way = body_bounds(run, every_way(run))
    return way if (way[1] > way[0]).any() and np.isfinite(way).all() else (run.model.low, run.model.high)


def scale_bar_length(width):
    """A round length near a fifth of the picture's width."""
    unit = 10.0 ** np.floor(np.log10(width / 5))
    return max(step * unit for step in (1, 2, 5) if step * unit <= width / 5)


def picture_axes(up):
    """Unit vectors of the picture in space: right, up, and towards the eye, which looks from the front and
    above."""
    first = np.eye(3)[0] if abs(up[0]) < 0.9 else np.eye(3)[1]
    first = first - (first @ up) * up
    first /= np.linalg.norm(first)
    second = np.cross(up, first)
    turn, rise = np.radians(AZIMUTH), np.radians(ELEVATION)
    right = np.cos(turn) * first + np.sin(turn) * second
    front = np.sin(turn) * first - np.cos(turn) * second
    eye = np.cos(rise) * front + np.sin(rise) * up
    return np.array([right, np.cross(eye, right), eye])
