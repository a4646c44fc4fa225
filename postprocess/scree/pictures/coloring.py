"""Colours of the particles in pictures: by speed, by a field, or by the names of groups and materials."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.colors import BoundaryNorm, Colormap, ListedColormap, Normalize

from scree.errors import ScreeError
from scree.pictures.palette import CATEGORIES, SPEED_MAP
from scree.series import Series

SPEED = "velocity"
Visible = Callable[[int], np.ndarray]  # from a snapshot to a mask [particles] of those in the picture
SLOW = 0.1  # smallest end of the speed scale over sqrt(g d): particles at rest have the lowest colour


def rounded_up(value: float) -> float:
    """The value rounded up to a number with few digits."""
    unit = 10.0 ** np.floor(np.log10(value))
    return float(next(step * unit for step in (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10) if step * unit >= 0.999 * value))


def slowest_limit(particles: Series, snapshots: Iterable[int], gravity: float, visible: Visible) -> float:
    """Smallest upper end of the speed scale [m/s]: 0.1 sqrt(g d) with the median diameter d of the particles in the
    last picture that shows any. gravity [m/s^2]."""
    for snapshot in reversed(list(snapshots)):
        radii = particles.rows(snapshot, "radius")[visible(snapshot)]
        if len(radii):
            return SLOW * float(np.sqrt(gravity * 2 * np.median(radii)))
    return 0.0


@dataclass(frozen=True)
class Coloring:
    """field: of the particles, for a vector its magnitude. names: of the categories that the field counts, if any. low,
    high: ends of the scale. label: of the scale, with the unit."""

    field: str
    label: str
    low: float
    high: float
    names: Sequence[str] = ()

    @property
    def map(self) -> Colormap:
        return ListedColormap([CATEGORIES[k % len(CATEGORIES)] for k in range(len(self.names))]) if self.names else \
            SPEED_MAP

    @property
    def norm(self) -> Normalize:
        if self.names:
            return BoundaryNorm(np.arange(len(self.names) + 1) - 0.5, len(self.names))
        return Normalize(self.low, self.high)

    def values(self, particles: Series, snapshot: int) -> np.ndarray:
        """[particles]"""
        rows = particles.rows(snapshot, self.field)
        return np.linalg.norm(rows, axis=1) if rows.ndim > 1 else rows

    def summary(self) -> str:
        """The colour bar in one line of text."""
        return f"{self.label}: {', '.join(self.names) if self.names else f'{self.low:g} to {self.high:g}'}"


def extremes(particles: Series, field: str, snapshots: Iterable[int], visible: Visible) -> tuple[float, float]:
    """1st and 99th percentile of the values of visible particles, over the snapshots."""
    plain = Coloring(field, "", 0, 1)
    values = [plain.values(particles, snapshot)[visible(snapshot)] for snapshot in snapshots]
    found = [np.percentile(each, [1, 99]) for each in values if len(each)]
    return (float(min(low for low, _ in found)), float(max(high for _, high in found))) if found else (0.0, 0.0)


def coloring(particles: Series, field: str, snapshots: Sequence[int], gravity: float, visible: Visible,
             fastest: float | None = None) -> Coloring:
    """Coloring for these snapshots. Only visible particles determine the scale, because particles that have fallen out
    of sight become arbitrarily fast. fastest: upper end of the speed scale [m/s] instead of that of the particles.
    Throws ScreeError if there is no such field."""
    if not particles.has(field):
        raise ScreeError(f"particles have no field {field}; there are "
                         f"{', '.join(name for name in particles.fields(0) if name != 'position')}; the run's "
                         "output.fields must name it, or --color another one")
    names = particles.names({"group": "groups", "material": "materials"}.get(field, ""))
    unit, _ = particles.label(field)
    name = "speed" if field == SPEED else field.replace("_", " ")
    label = f"particle {name}" + (f" [{unit}]" if unit != "1" else "")
    if names:
        return Coloring(field, label, 0, len(names), names)
    low, high = extremes(particles, field, snapshots, visible)
    if field == SPEED:
        high = max(high, slowest_limit(particles, snapshots, gravity, visible))
        return Coloring(field, label, 0.0, fastest or (rounded_up(high) if high > 0 else 1.0))
    if low < 0:
        return Coloring(field, label, low, high)
    return Coloring(field, label, 0.0, rounded_up(high) if high > 0 else 1.0)
