"""The free surface of grains and its angle."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

POINTS = 64  # sample points in each grain
COLUMN, ROW = 1.0, 0.25  # size of a cell along and across the surface, in mean diameters
SMOOTHED = 5  # rows over which the solid fraction is averaged: 1.25 diameters, so that gaps between grains do not count


@dataclass(frozen=True)
class Surface:
    """Heights of the surface over the horizontal coordinate [m], and the straight line through them."""

    x: np.ndarray
    height: np.ndarray
    slope: float
    start: float  # height of the line at x = 0

    @property
    def angle(self) -> float:
        """Of the line to the horizontal [degrees], not negative."""
        return float(np.degrees(np.arctan(abs(self.slope))))

    @property
    def deviation(self) -> float:
        """Root mean square distance of the heights from the line [m]."""
        return float(np.sqrt(np.mean((self.height - self.start - self.slope * self.x) ** 2)))


def points_in_a_ball() -> np.ndarray:
    """[POINTS][3], each for an equal part of the volume of the unit ball: radii for equal shells, directions on a
    Fibonacci spiral in an order that does not follow the radii."""
    number = np.arange(POINTS) + 0.5
    height, turn = 1 - 2 * number / POINTS, np.pi * (3 - np.sqrt(5)) * number
    ring = np.sqrt(1 - height**2)
    directions = np.column_stack([ring * np.cos(turn), ring * np.sin(turn), height])
    radii = ((number * 29) % POINTS / POINTS) ** (1 / 3)
    return directions * radii[:, None]


def solid_area(states: Iterable[tuple[np.ndarray, np.ndarray]], edges: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """Volume of the grains over each cell of the x-z plane, summed over states of (positions [m], radii [m])."""
    ball, found = points_in_a_ball(), np.zeros((len(edges[0]) - 1, len(edges[1]) - 1))
    for positions, radii in states:
        points = (positions[:, None, :] + radii[:, None, None] * ball).reshape(-1, 3)
        shares = np.repeat(4 / 3 * np.pi * radii**3 / POINTS, POINTS)
        found += np.histogram2d(points[:, 0], points[:, 2], edges, weights=shares)[0]
    return found


def crossing(column: np.ndarray, centers: np.ndarray, level: float) -> float:
    """Height at which a column of solid fractions falls below the level for the last time; NaN if it never exceeds it."""
    above = np.flatnonzero(column >= level)
    if not len(above) or above[-1] + 1 == len(column):
        return float("nan")
    k = above[-1]
    share = (column[k] - level) / (column[k] - column[k + 1])
    return float(centers[k] + share * (centers[k + 1] - centers[k]))


def find(states: Iterable[tuple[np.ndarray, np.ndarray]], low: float, high: float) -> Surface | None:
    """The surface between two horizontal coordinates [m], averaged over the depth and the states: where the solid
    fraction is half of that inside the grains. None if fewer than three columns have a surface."""
    kept = [(np.asarray(positions, float), np.asarray(radii, float)) for positions, radii in states]
    kept = [(positions, radii) for positions, radii in kept if len(radii)]
    if not kept:
        return None
    size = 2 * np.mean(np.concatenate([radii for _, radii in kept]))
    bottom = min(positions[:, 2].min() for positions, _ in kept) - 2 * size
    top = max(positions[:, 2].max() for positions, _ in kept) + 3 * size
    edges = (np.linspace(low, high, max(2, round((high - low) / (COLUMN * size)) + 1)),
             np.arange(bottom, top + ROW * size, ROW * size))
    filled = solid_area(kept, edges)
    smooth = np.apply_along_axis(np.convolve, 1, filled, np.ones(SMOOTHED) / SMOOTHED, mode="same")
    if not smooth.any():
        return None
    level = 0.5 * np.median(smooth[smooth > 0.5 * smooth.max()])
    centers = 0.5 * (edges[1][1:] + edges[1][:-1])
    x = 0.5 * (edges[0][1:] + edges[0][:-1])
    height = np.array([crossing(column, centers, level) for column in smooth])
    there = np.isfinite(height)
    if there.sum() < 3:
        return None
    slope, start = np.polyfit(x[there], height[there], 1)
    return Surface(x[there], height[there], float(slope), float(start))
