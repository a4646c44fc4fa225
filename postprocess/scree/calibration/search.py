"""Search for two parameters that give wished values of one or two quantities.

All tests run on a grid of 3 x 3 sets of the parameters. A quadratic polynomial of both parameters is fitted to each
quantity by least squares. The set at which the polynomials are nearest to the targets is run, and added to the points;
further fits give points near this set more weight. The search ends if the values measured there meet the targets, or
after some rounds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from scree.errors import ScreeError

GRID = 3  # points along each parameter
FINE = 101  # points along each parameter at which the polynomials are evaluated
NEAR = 0.35  # distance, in parts of the ranges, at which the weight of a point has fallen to 61 %
CENTERING = 1e-3  # weight of the distance from the middle of the ranges, which decides where many sets meet the targets
LEAST = 0.02  # smallest tolerance, as a part of the target
WIDEST = 2  # spread of a set that meets the targets, in tolerances


@dataclass(frozen=True)
class Parameter:
    key: str
    low: float
    high: float

    def at(self, share: float) -> float:
        """Value at a share of the range, to 4 digits."""
        return float(f"{self.low + share * (self.high - self.low):.4g}")


@dataclass(frozen=True)
class Target:
    test: str
    quantity: str
    value: float

    @property
    def name(self) -> str:
        return f"{self.test}.{self.quantity}"


@dataclass(frozen=True)
class Point:
    """A set of the two parameters, as shares of their ranges, with the mean and the spread of each quantity."""

    shares: tuple[float, float]
    means: tuple[float, ...]
    spreads: tuple[float, ...]


@dataclass(frozen=True)
class Found:
    """All points in the order in which they were run; the best one; whether it meets the targets; for one target,
    shares of further sets at which the polynomial meets it."""

    points: list[Point]
    best: Point
    met: bool
    tolerances: tuple[float, ...]
    curve: list[tuple[float, float]]


def terms(shares: np.ndarray) -> np.ndarray:
    """Terms of the polynomial [points][6]."""
    x, y = np.asarray(shares, float).T
    return np.column_stack([np.ones_like(x), x, y, x * x, x * y, y * y])


def fitted(points: Sequence[Point], quantity: int, center: np.ndarray | None) -> np.ndarray:
    """Coefficients of the polynomial; center: where the weights are largest."""
    shares = np.array([each.shares for each in points])
    values = np.array([each.means[quantity] for each in points])
    weights = np.ones(len(points))
    if center is not None:
        weights = np.exp(-0.25 * np.sum((shares - center) ** 2, axis=1) / NEAR**2)  # roots of the weights
    found: np.ndarray = np.linalg.lstsq(terms(shares) * weights[:, None], values * weights, rcond=None)[0]
    return found


def fine_grid() -> np.ndarray:
    line = np.linspace(0, 1, FINE)
    return np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)


def misfit(values: np.ndarray, targets: Sequence[Target], tolerances: Sequence[float]) -> np.ndarray:
    """Sum of squares of the distances from the targets, in tolerances."""
    wished = np.array([each.value for each in targets])
    return np.asarray((((values - wished) / np.array(tolerances)) ** 2).sum(axis=-1))


def tolerances_of(points: Sequence[Point], targets: Sequence[Target]) -> tuple[float, ...]:
    """The spread over seeds, averaged over the points, and at least a part of the target."""
    spreads = np.sqrt(np.mean(np.array([each.spreads for each in points]) ** 2, axis=0))
    return tuple(max(float(spread), LEAST * abs(each.value)) for spread, each in zip(spreads, targets))


def predicted(points: Sequence[Point], targets: Sequence[Target], center: np.ndarray | None) -> np.ndarray:
    """Values of the polynomials on the fine grid [points][targets]."""
    grid = terms(fine_grid())
    return np.column_stack([grid @ fitted(points, k, center) for k in range(len(targets))])


def next_shares(points: Sequence[Point], targets: Sequence[Target], center: np.ndarray | None) -> tuple[float, float]:
    """Where the polynomials are nearest to the targets."""
    grid = fine_grid()
    cost = misfit(predicted(points, targets, center), targets, tolerances_of(points, targets))
    best = grid[np.argmin(cost + CENTERING * ((grid - 0.5) ** 2).sum(axis=1))]
    return float(best[0]), float(best[1])


def curve_through(points: Sequence[Point], targets: Sequence[Target], center: np.ndarray) -> list[tuple[float, float]]:
    """For one target: up to five values of the first parameter with the second one at which the polynomial meets it."""
    values = predicted(points, targets, center)[:, 0].reshape(FINE, FINE) - targets[0].value
    line, found = np.linspace(0, 1, FINE), []
    for row in range(FINE):
        for k in np.flatnonzero(np.diff(np.sign(values[row])) != 0)[:1]:
            share = values[row, k] / (values[row, k] - values[row, k + 1])
            found.append((float(line[row]), float(line[k] + share * (line[k + 1] - line[k]))))
    return [found[k] for k in sorted({*np.linspace(0, len(found) - 1, 5).astype(int)})] if found else []


def search(targets: Sequence[Target], measure: Callable[[tuple[float, float]], Point], tell: Callable[[Point], None],
           rounds: int, at_once: int = 1) -> Found:
    """measure: runs the tests with the parameters at these shares of their ranges; called for this number of points of
    the grid at once, from several threads. tell: is called for each point, in order."""
    if not 1 <= len(targets) <= 2:
        raise ScreeError("a search for two parameters has one or two targets")
    line = np.linspace(0, 1, GRID)
    points: list[Point] = []
    with ThreadPoolExecutor(at_once) as pool:
        for point in pool.map(measure, [(float(x), float(y)) for x in line for y in line]):
            tell(point)
            points.append(point)

    # The mean square distance of the runs from the targets: a mean that is near by chance has a wide spread.
    def cost(point: Point) -> float:
        tolerances = tolerances_of(points, targets)
        spread = np.sum((np.array(point.spreads) / np.array(tolerances)) ** 2)
        return float(misfit(np.array(point.means), targets, tolerances) + spread)

    def meets(point: Point) -> bool:
        wished = zip(point.means, point.spreads, targets, tolerances_of(points, targets))
        return all(abs(value - each.value) <= tolerance and spread <= WIDEST * tolerance
                   for value, spread, each, tolerance in wished)

    center: np.ndarray | None = None
    for _ in range(rounds):
        shares = next_shares(points, targets, center)
        if any(np.allclose(shares, each.shares, atol=0.5 / FINE) for each in points):
            break  # the polynomials lead to a set that was run
        points.append(measure(shares))
        tell(points[-1])
        center = np.array(shares)
        if meets(points[-1]):
            break
    # A point of the grid may meet the targets by chance; the last one does where the others lead.
    best = points[-1] if len(points) > GRID**2 and meets(points[-1]) else min(points, key=cost)
    around = np.array(best.shares)
    curve = curve_through(points, targets, around) if len(targets) == 1 else []
    return Found(points, best, meets(best), tolerances_of(points, targets), curve)
