"""The part of a scene in a picture, and the direction of view."""

import numpy as np

from scree.fields import POSITION
from scree.pictures.mechanism import Mechanism

LONGEST_SIDE = 7.5  # longest side of the axes [inch]
SAMPLED = 40  # snapshots that determine the region of moving bodies
AZIMUTH, ELEVATION = 30, 26  # direction of view in 3D [degrees]
NEAR = 0.2  # distance over the longest side of a picture up to which sides of the domain are shown, too
IN_PLANE = np.array([1.0, 1.0, 0.0])


def bounds(series, snapshots, strays):
    """Box around the points of some snapshots, enlarged by the largest radius. strays: percentage omitted per side."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for snapshot in snapshots:
        points = series.rows(snapshot, POSITION)
        if len(points) == 0:
            continue
        radius = series.rows(snapshot, "radius").max()
        low = np.minimum(low, np.percentile(points, strays, axis=0) - radius)
        high = np.maximum(high, np.percentile(points, 100 - strays, axis=0) + radius)
    return low, high


def union(*boxes):
    return np.min([low for low, _ in boxes], axis=0), np.max([high for _, high in boxes], axis=0)


def body_bounds(run, snapshots):
    """Box around shapes, meshes, joints and springs."""
    mechanism = Mechanism(run.model, run.motion, 0.0)
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for snapshot in snapshots:
        lines, points = mechanism.draw(snapshot)
        points_of_all = np.concatenate([a.reshape(-1, 3) for a in (*lines.values(), *points.values())])
        low = np.min(np.concatenate([[low], points_of_all]), axis=0)
        high = np.max(np.concatenate([[high], points_of_all]), axis=0)
    if run.surfaces:
        low, high = union((low, high), run.surfaces.bounds(snapshots))
    if run.bodies is None:
        return low, high
    return union((low, high), bounds(run.bodies, snapshots, strays=0))


def sampled_snapshots(run):
    """Snapshots over the whole run, for the region of moving bodies."""
    return np.unique(np.linspace(0, len(run.particles) - 1, SAMPLED).astype(int))


def plane_bounds(run, snapshots):
    """Box around bodies and particles, without stray particles and those outside the domain, with a margin."""
    low, high = bounds(run.particles, snapshots, strays=0.5)
    if np.isfinite(low).all():
        low, high = np.maximum(low, run.model.low), np.minimum(high, run.model.high)
    # Moving bodies count with all their positions.
    swept = body_bounds(run, sampled_snapshots(run))
    swept = np.maximum(swept[0], run.model.low), np.minimum(swept[1], run.model.high)
    boxes = [(low, high), body_bounds(run, snapshots)] + [swept] * bool((swept[1] >= swept[0]).all())
    low, high = union(*boxes)
    if not (np.isfinite(low).all() and (high >= low).all() and (high > low).any()):
        low, high = run.model.low, run.model.high
    low, high = low * IN_PLANE, high * IN_PLANE  # meshes of planar runs have a thickness along z, for other programs
    near = NEAR * max(high - low)  # margin within which sides of the domain are included
    low = np.where((low > run.model.low) & (low - run.model.low < near), run.model.low, low)
    high = np.where((high < run.model.high) & (run.model.high - high < near), run.model.high, high)
    margin = 0.04 * max(high - low)
    return low - margin, high + margin


def figure_size(width, height):
    """Size of axes [inch] with this aspect ratio, limited to 1 : 2.2."""
    scale = LONGEST_SIDE / max(width, height)
    return max(scale * width, LONGEST_SIDE / 2.2), max(scale * height, LONGEST_SIDE / 2.2)


def scene_bounds(run, snapshots, bodies):
    """Box for a 3D picture: particles inside the domain without strays, and bodies. Without particles, all positions of
    the bodies. bodies: bounds of the bodies in the picture."""
    low, high = bounds(run.particles, snapshots, strays=0.2)
    low, high = np.maximum(low, run.model.low), np.minimum(high, run.model.high)
    if (high >= low).all():
        return union((low, high), bodies)
    swept = body_bounds(run, sampled_snapshots(run))
    return swept if (swept[1] > swept[0]).any() and np.isfinite(swept).all() else (run.model.low, run.model.high)


def scale_bar_length(width):
    """A round length near a fifth of the width of the picture."""
    unit = 10.0 ** np.floor(np.log10(width / 5))
    return max(step * unit for step in (1, 2, 5) if step * unit <= width / 5)


def picture_axes(up):
    """Unit vectors of the picture: right, up, and towards the viewer, who is in front and above."""
    first = np.eye(3)[0] if abs(up[0]) < 0.9 else np.eye(3)[1]
    first = first - (first @ up) * up
    first /= np.linalg.norm(first)
    second = np.cross(up, first)
    azimuth, elevation = np.radians(AZIMUTH), np.radians(ELEVATION)
    right = np.cos(azimuth) * first + np.sin(azimuth) * second
    front = np.sin(azimuth) * first - np.cos(azimuth) * second
    eye = np.cos(elevation) * front + np.sin(elevation) * up
    return np.array([right, np.cross(eye, right), eye])
