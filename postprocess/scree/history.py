"""The history of a run: scalars over time."""

from __future__ import annotations

import difflib
import fnmatch
import pathlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import h5py
import numpy as np

from scree import files
from scree.errors import MissingError, ScreeError
from scree.quantity import Quantity

if TYPE_CHECKING:
    import pandas

TIME = "step/time"


@dataclass(frozen=True)
class HistoryFile:
    """A history.h5: the labels (unit, description) of its columns by their paths, and its times [rows] [s]."""

    path: pathlib.Path
    labels: dict[str, tuple[str, str]]
    times: np.ndarray

    @staticmethod
    def open(path: pathlib.Path) -> HistoryFile:
        def take(file: h5py.File) -> HistoryFile:
            found = files.datasets(file)
            if TIME not in found:
                raise ScreeError(f"{path}: has no column {TIME}")
            rows = min(len(dataset) for dataset in found.values())
            return HistoryFile(path, {name: files.label(d) for name, d in found.items()}, found[TIME][:rows])

        return files.read(path, take)


class History(Mapping[str, Quantity]):
    """Columns by their paths ("energy/kinetic"), each a Quantity [rows], read on demand.

    If a run continued from a checkpoint into another folder, the rows of both folders are joined, and the columns are
    those that both have.
    """

    def __init__(self, parts: Sequence[tuple[HistoryFile, int]]) -> None:
        """parts: files in the order of time, with the number of rows to use."""
        self._parts = list(parts)
        self._read: dict[str, np.ndarray] = {}
        last = self._parts[-1][0].labels if self._parts else {}
        self._labels = {name: label for name, label in last.items()
                        if all(name in file.labels for file, _ in self._parts)}

    @property
    def rows(self) -> int:
        return sum(rows for _, rows in self._parts)

    @property
    def time(self) -> Quantity:
        """Times of the rows [s]."""
        return self[TIME]

    def __iter__(self) -> Iterator[str]:
        return iter(self._labels)

    def __len__(self) -> int:
        """Number of columns."""
        return len(self._labels)

    def __getitem__(self, name: str) -> Quantity:
        return self.read(name)[name]

    def read(self, *names: str) -> dict[str, Quantity]:
        """Columns of these names, or all columns, with one access to the files. Throws MissingError for a missing
        one."""
        for name in names:
            if name not in self._labels:
                near = [path for path in self if name.split("/")[-1] in path][:5]
                raise MissingError(f"no column {name}" + (f"; there are {', '.join(near)}" if near else ""))
        self._load(names or self._labels)
        return {name: Quantity(self._read[name], *self._labels[name]) for name in names or self._labels}

    def _load(self, names: Iterable[str]) -> None:
        wanted = [name for name in dict.fromkeys(names) if name not in self._read]
        if not wanted:
            return
        values: dict[str, list[np.ndarray]] = {name: [] for name in wanted}
        for file, rows in self._parts:

            def take(opened: h5py.File, count: int = rows) -> list[np.ndarray]:
                return [opened[name][:count] for name in wanted]

            for name, column in zip(wanted, files.read(file.path, take)):
                if len(column) < rows:
                    raise ScreeError(f"{file.path}: has fewer rows than when it was opened; refresh() the run")
                values[name].append(column)
        self._read.update({name: np.concatenate(columns) for name, columns in values.items()})

    def names(self, *patterns: str) -> list[str]:
        """Columns that match a pattern ("contacts/*/fx", or a name); throws ScreeError if there is none."""
        found: list[str] = []
        for pattern in patterns:
            matching = fnmatch.filter(self, pattern)
            if not matching:
                near = difflib.get_close_matches(pattern, self, cutoff=0.7)
                raise ScreeError(f"no column {pattern}; " + (f"did you mean {' or '.join(near)}?" if near else
                                                             f"there are: {', '.join(self) or 'none'}"))
            found += [name for name in matching if name not in found]
        return found

    def to_dataframe(self, *patterns: str) -> pandas.DataFrame:
        """A table of the columns that match the patterns (all columns without a pattern), by time [s]. attrs["units"]
        and attrs["descriptions"] have units and descriptions by column."""
        import pandas

        found = self.read(TIME, *(self.names(*patterns) if patterns else self))
        index = pandas.Index(found.pop(TIME).values, name="time [s]")
        frame = pandas.DataFrame({name: column.values for name, column in found.items()}, index=index)
        frame.attrs["units"] = {name: column.unit for name, column in found.items()}
        frame.attrs["descriptions"] = {name: column.description for name, column in found.items()}
        return frame
