"""Where two runs differ."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from scree.run import Run
from scree.snapshots import KINDS


@dataclass(frozen=True)
class Difference:
    """Of two runs' values under one name."""

    name: str  # of a column of the history, or of a field as "particles/velocity"
    text: str  # why it cannot be measured, empty where it can
    largest: float = 0.0  # absolute difference [unit]
    relative: float = 0.0  # that over the largest absolute value in the first run
    time: float = 0.0  # of the largest difference [s]
    unit: str = ""

    def __str__(self) -> str:
        if self.text:
            return f"{self.name}: {self.text}"
        return f"{self.name}: by up to {self.largest:.3g} {self.unit}, {self.relative:.3g} of its largest value, " \
               f"at t = {self.time:.9g} s"


def same_bits(one: np.ndarray, other: np.ndarray) -> bool:
    return one.dtype == other.dtype and one.shape == other.shape and one.tobytes() == other.tobytes()


def apart(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Absolute differences; where one is NaN or infinite and the other is something else, infinite."""
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


def history_differences(one: Run, other: Run) -> Iterator[Difference]:
    a, b = one.history, other.history
    a.read(), b.read()  # all at once
    for name in sorted(set(a) ^ set(b)):
        yield Difference(name, f"in {one.folder if name in a else other.folder} alone")
    shared = min(a.rows, b.rows)
    if a.rows != b.rows:
        yield Difference("history", f"{a.rows} rows against {b.rows}; the first {shared} are compared")
    for name in a:
        if name not in b:
            continue
        first, second = a[name].values[:shared], b[name].values[:shared]
        if same_bits(first, second):
            continue
        gaps = apart(first, second)
        row = int(gaps.argmax())
        yield Difference(name, "", float(gaps[row]), over(float(gaps[row]), scale_of(first)), float(a.time[row]),
                         a[name].unit)


def field_difference(one: Run, other: Run, kind: str, name: str, snapshots: int) -> Difference | None:
    """None where all bits are the same."""
    a, b = one.series(kind), other.series(kind)
    assert a is not None and b is not None
    label, largest, time, scale, same = f"{kind}/{name}", -1.0, 0.0, 0.0, True
    for snapshot in range(snapshots):
        first, second = a.rows(snapshot, name), b.rows(snapshot, name)
        if first.shape != second.shape:
            return Difference(label, f"{len(first)} rows against {len(second)} at t = {a.times[snapshot]:.9g} s")
        scale = max(scale, scale_of(first))
        if same_bits(first, second):
            continue
        same = False
        gap = float(apart(first, second).max())
        if gap > largest:
            largest, time = gap, float(a.times[snapshot])
    return None if same else Difference(label, "", largest, over(largest, scale), time, a.label(name)[0])


def snapshot_differences(one: Run, other: Run) -> Iterator[Difference]:
    shared = min(len(one.snapshots), len(other.snapshots))
    if len(one.snapshots) != len(other.snapshots):
        yield Difference("snapshots", f"{len(one.snapshots)} against {len(other.snapshots)}; "
                                      f"the first {shared} are compared")
    if not shared:
        return
    times = one.snapshots.times[:shared], other.snapshots.times[:shared]
    if not same_bits(*times):
        gaps = apart(*times)
        yield Difference("snapshots", f"times differ by up to {gaps.max():.3g} s")
    for kind in KINDS:
        series = one.series(kind), other.series(kind)
        if series[0] is None or series[1] is None:
            if series != (None, None):
                yield Difference(kind, f"in {one.folder if series[0] else other.folder} alone")
            continue
        names = [set(found.fields(0)) for found in series if found]
        for name in sorted(names[0] ^ names[1]):
            yield Difference(f"{kind}/{name}", f"in {(one if name in names[0] else other).folder} alone")
        for name in sorted(names[0] & names[1]):
            found = field_difference(one, other, kind, name, shared)
            if found:
                yield found


def differences(one: Run, other: Run) -> list[Difference]:
    """All columns of the history and all fields of the snapshots that have not the same bits; none where all have."""
    return [*history_differences(one, other), *snapshot_differences(one, other)]
