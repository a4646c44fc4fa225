"""Rigid clumps of discs or spheres, as bodies of a deck.

    deck.add("bodies", **scree.clumps.clump("grain", [[0, 0, 0], [0.01, 0, 0]], [0.01, 0.008], density=2650.0,
                                            position=[0, 0, 0.1]))
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from scree.errors import ScreeError

Numbers = Sequence[float] | np.ndarray
LINES = 400  # integration lines per axis through a clump with overlapping spheres; for discs this number squared
MOST_AT_ONCE = 2**20  # pairs of a line and a sphere that are evaluated at once


def overlap(centers: np.ndarray, radii: np.ndarray) -> bool:
    apart = np.linalg.norm(centers[:, None] - centers[None], axis=2)
    return bool((np.triu(radii[:, None] + radii[None] - apart, 1) > 0).any())


def united(begins: np.ndarray, ends: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Disjoint intervals with the same union as these intervals [lines][spheres]; begin = end is an empty one."""
    order = np.argsort(begins, axis=1)
    begins, ends = np.take_along_axis(begins, order, 1), np.take_along_axis(ends, order, 1)
    covered = np.maximum.accumulate(ends, axis=1)
    begins[:, 1:] = np.maximum(begins[:, 1:], covered[:, :-1])
    return begins, np.maximum(ends, begins)


def line_moments(lines: np.ndarray, centers: np.ndarray, radii: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Moments of the covered intervals, summed over lines along x at these transverse coordinates [lines][1 or 2]."""
    half = np.sqrt(np.maximum(radii**2 - ((lines[:, None] - centers[None, :, 1:]) ** 2).sum(axis=2), 0.0))
    begins, ends = united(centers[:, 0] - half, centers[:, 0] + half)
    powers = [((ends ** (k + 1) - begins ** (k + 1)) / (k + 1)).sum(axis=1) for k in range(3)]
    second = np.empty((centers.shape[1],) * 2)
    second[0, 0] = powers[2].sum()
    second[0, 1:] = second[1:, 0] = powers[1] @ lines
    second[1:, 1:] = (lines * powers[0][:, None]).T @ lines
    return float(powers[0].sum()), np.array([powers[1].sum(), *(powers[0] @ lines)]), second


def moments(centers: np.ndarray, radii: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Volume, first and second moments about the origin of the union of the discs or spheres. Exact without overlaps,
    otherwise a sum over lines along x, on each of which the integral is exact."""
    dimension = centers.shape[1]
    if not overlap(centers, radii):
        volumes = np.pi * radii**2 if dimension == 2 else 4 / 3 * np.pi * radii**3
        own = volumes * radii**2 / (dimension + 2)  # integral of x^2 over a disc or a sphere about its centre
        second = np.einsum("n,ni,nj->ij", volumes, centers, centers) + own.sum() * np.eye(dimension)
        return float(volumes.sum()), volumes @ centers, second
    low, high = (centers[:, 1:] - radii[:, None]).min(axis=0), (centers[:, 1:] + radii[:, None]).max(axis=0)
    count = LINES**2 if dimension == 2 else LINES
    steps = (high - low) / count
    axes = [start + (np.arange(count) + 0.5) * step for start, step in zip(low, steps)]
    lines = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, dimension - 1)
    volume, first, second = 0.0, np.zeros(dimension), np.zeros((dimension, dimension))
    for batch in np.array_split(lines, 1 + len(lines) * len(radii) // MOST_AT_ONCE):
        sums = line_moments(batch, centers, radii)
        volume, first, second = volume + sums[0], first + sums[1], second + sums[2]
    area = float(np.prod(steps))
    return volume * area, first * area, second * area


def clump(name: str, centers: Sequence[Numbers] | np.ndarray, radii: Numbers, *, position: Numbers,
          density: float | None = None, mass: float | None = None, **keys: Any) -> dict[str, Any]:
    """A table of [[bodies]]: discs or spheres as shapes, with the mass, centre of mass and inertia of their homogeneous
    union; overlaps count once. centers [n][2 or 3] and radii [n] [m]; position: of the frame of the centres; density
    [kg/m^3], for discs [kg/m^2], or mass [kg]; keys: further keys of the table."""
    points, sizes = np.asarray(centers, dtype=float), np.asarray(radii, dtype=float)
    if points.ndim != 2 or points.shape[1] not in (2, 3) or sizes.shape != (len(points),) or (sizes <= 0).any():
        raise ScreeError(f"clump {name}: centres must be points of 2 or 3 numbers, with a radius above 0 for each")
    if (density is None) == (mass is None):
        raise ScreeError(f"clump {name}: a density or a mass must be given, and not both")
    volume, first, second = moments(points, sizes)
    weight = density if density is not None else (mass or 0.0) / volume
    center = first / volume
    central = weight * (second - volume * np.outer(center, center))  # second moments of mass about the centre of mass
    body: dict[str, Any] = {"name": name, "position": [float(x) for x in position], "mass": weight * volume,
                            "center_of_mass": center.tolist()}
    if len(center) == 2:
        body["inertia"] = float(np.trace(central))
    else:
        tensor = np.trace(central) * np.eye(3) - central
        body["kind"] = "spatial"
        body["inertia_tensor"] = [float(tensor[i, j]) for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
    body["shapes"] = [{"radius": float(r), "offset": c.tolist()} for c, r in zip(points, sizes)]
    return body | keys
