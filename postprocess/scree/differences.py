"""Differences between two runs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from scree.run import Run
from scree.snapshots import KINDS

ROUND_OFF = 1e-9  # fraction of the simulated time up to which two times are considered equal


@dataclass(frozen=True)
class Difference:
    """Difference between the values of two runs under one name."""

    name: str  # column of the history, or field such as "particles/velocity"
    text: str  # why there is no numerical difference; empty if there is
    largest: float = 0.0  # absolute difference [unit]
    relative: float = 0.0  # largest / largest absolute value in the first run
    time: float = 0.0  # time of the largest difference [s]
    unit: str = ""

    def __str__(self) -> str:
        if self.text:
            return f"{self.name}: {self.text}"
        return f"{self.name}: by up to {self.largest:.3g} {self.unit}, {self.relative:.3g} of its largest value, " \
               f"at t = {self.time:.9g} s"


def same_bits(one: np.ndarray, other: np.ndarray) -> bool:
    return one.dtype == other.dtype and one.shape == other.shape and one.tobytes() == other.tobytes()


def absolute_differences(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Absolute differences; infinite where one value is NaN or infinite and the other is different."""
    with np.errstate(invalid="ignore"):
        found = np.abs(np.subtract(one, other, dtype=float))
    same = (one == other) | (np.isnan(one) & np.isnan(other)) if one.dtype.kind == "f" else one == other
    return np.where(same, 0.0, np.where(np.isnan(found), np.inf, found))


def scale_of(values: np.ndarray) -> float:
    finite = np.abs(values[np.isfinite(values)]).astype(float)
    return float(finite.max(initial=0.0))


def over(largest: float, scale: float) -> float:
    if largest == 0:
        return 0.0
    return largest / scale if scale > 0 else np.inf


def matched(one: np.ndarray, other: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Indices, in each, of the times [s] that both have within round-off. Times increase."""
    if not len(one) or not len(other):
        return np.empty(0, int), np.empty(0, int)

    def nearest(times: np.ndarray, among: np.ndarray) -> np.ndarray:
        after = np.searchsorted(among, times).clip(1, max(len(among) - 1, 1))
        last = np.minimum(after, len(among) - 1)
        return np.where(np.abs(among[after - 1] - times) <= np.abs(among[last] - times), after - 1, last)

    there = nearest(one, other)
    span = max(one[-1], other[-1]) - min(one[0], other[0])
    rows = np.arange(len(one))
    both = (np.abs(one - other[there]) <= ROUND_OFF * span) & (nearest(other, one)[there] == rows)
    return rows[both], there[both]


def missing(name: str, runs: tuple[Run, Run], times: tuple[np.ndarray, np.ndarray],
            common: tuple[np.ndarray, np.ndarray]) -> Iterator[Difference]:
    """Items that only one run has. name: of an item, singular."""
    for run, all_times, shared in zip(runs, times, common):
        alone = np.delete(all_times, shared)
        if len(alone) == 1:
            yield Difference(f"{name}s", f"one more {name} at t = {alone[0]:.9g} s in {run.folder}")
        elif len(alone):
            yield Difference(f"{name}s", f"{len(alone)} more {name}s from t = {alone[0]:.9g} s to {alone[-1]:.9g} s in "
                                         f"{run.folder}")


def common_rows(one: Run, other: Run) -> tuple[np.ndarray, np.ndarray]:
    """Rows of the history at common times, in each."""
    if not (one.history.rows and other.history.rows):
        return np.empty(0, int), np.empty(0, int)
    return matched(one.history.time.values, other.history.time.values)


def common_snapshots(one: Run, other: Run) -> tuple[np.ndarray, np.ndarray]:
    return matched(one.snapshots.times, other.snapshots.times)


def times_of(run: Run) -> np.ndarray:
    return run.history.time.values if run.history.rows else np.empty(0)


def history_differences(one: Run, other: Run) -> Iterator[Difference]:
    a, b = one.history, other.history
    a.read(), b.read()  # all at once
    for name in sorted(set(a) ^ set(b)):
        yield Difference(name, f"in {one.folder if name in a else other.folder} only")
    rows = common_rows(one, other)
    yield from missing("row", (one, other), (times_of(one), times_of(other)), rows)
    for name in a:
        if name not in b or not len(rows[0]):
            continue
        first, second = a[name].values[rows[0]], b[name].values[rows[1]]
        if same_bits(first, second):
            continue
        gaps = absolute_differences(first, second)
        row = int(gaps.argmax())
        yield Difference(name, "", float(gaps[row]), over(float(gaps[row]), scale_of(first)),
                         float(a.time[rows[0][row]]), a[name].unit)


def field_difference(one: Run, other: Run, kind: str, name: str,
                     shared: tuple[np.ndarray, np.ndarray]) -> Difference | None:
    """Difference over the common snapshots; None if all bits are equal."""
    a, b = one.series(kind), other.series(kind)
    assert a is not None and b is not None
    label, largest, time, scale, same = f"{kind}/{name}", -1.0, 0.0, 0.0, True
    for snapshot, of_other in zip(*shared):
        first, second = a.rows(snapshot, name), b.rows(of_other, name)
        if first.shape != second.shape:
            return Difference(label, f"{len(first)} rows against {len(second)} at t = {a.times[snapshot]:.9g} s")
        scale = max(scale, scale_of(first))
        if same_bits(first, second):
            continue
        same = False
        gap = float(absolute_differences(first, second).max())
        if gap > largest:
            largest, time = gap, float(a.times[snapshot])
    return None if same else Difference(label, "", largest, over(largest, scale), time, a.label(name)[0])


def snapshot_differences(one: Run, other: Run) -> Iterator[Difference]:
    shared = common_snapshots(one, other)
    yield from missing("snapshot", (one, other), (one.snapshots.times, other.snapshots.times), shared)
    if not len(shared[0]):
        return
    times = one.snapshots.times[shared[0]], other.snapshots.times[shared[1]]
    if not same_bits(*times):
        gaps = absolute_differences(*times)
        latest = int(gaps.argmax())
        yield Difference("times of snapshots", "", float(gaps[latest]), over(float(gaps[latest]), scale_of(times[0])),
                         float(times[0][latest]), "s")
    for kind in KINDS:
        series = one.series(kind), other.series(kind)
        if series[0] is None or series[1] is None:
            if series != (None, None):
                yield Difference(kind, f"in {one.folder if series[0] else other.folder} only")
            continue
        names = [set(found.fields(0)) for found in series if found]
        for name in sorted(names[0] ^ names[1]):
            yield Difference(f"{kind}/{name}", f"in {(one if name in names[0] else other).folder} only")
        for name in sorted(names[0] & names[1]):
            found = field_difference(one, other, kind, name, shared)
            if found:
                yield found


def differences(one: Run, other: Run) -> list[Difference]:
    """Columns of the history and fields of the snapshots with different bits at common times, and data of only one
    run. Empty if the runs are identical."""
    return [*history_differences(one, other), *snapshot_differences(one, other)]
