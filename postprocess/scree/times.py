"""pyvista's reader of a .vtkhdf with support for times."""

from __future__ import annotations

import os
import pathlib
from typing import Any

from pyvista.core.utilities.reader import HDFReader, TimeReader

from scree.errors import ScreeError
from scree.series import SeriesFile


class Reader(HDFReader, TimeReader):
    """Reads one snapshot at a time: that of active_time_value. The times [s] and the number of snapshots are those of
    the file when the reader was made."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self._times = [float(time) for time in SeriesFile.open(pathlib.Path(path)).times]
        super().__init__(os.fspath(path))
        self._active = 0

    @property
    def number_time_points(self) -> int:
        return len(self._times)

    def time_point_value(self, time_point: int) -> float:
        return self._times[time_point]

    @property
    def active_time_value(self) -> float:
        return self._times[self._active]

    def set_active_time_point(self, time_point: int) -> None:
        self._active = range(self.number_time_points)[time_point]

    def set_active_time_value(self, time_value: float) -> None:
        """Throws ScreeError if the time is not one of time_values."""
        if time_value not in self._times:
            nearest = min(self._times, key=lambda time: abs(time - time_value))
            raise ScreeError(f"{self.path}: no snapshot at {time_value!r} s; the nearest is at {nearest!r} s")
        self._active = self._times.index(time_value)

    def read(self, **options: Any) -> Any:
        """pyvista.PolyData"""
        self.reader.SetStep(self._active)
        return super().read(**options)
