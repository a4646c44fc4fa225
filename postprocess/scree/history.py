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
FORMER = {"step/left": "step/particles_escaped"}  # names of columns in files of earlier versions, still understood


@dataclass(frozen=True)
class HistoryFile:
    """A history.h5: the labels (unit, description) of its columns by their names, their paths in the file where those
    are other ones, and its times [rows] [s]."""

    path: pathlib.Path
    labels: dict[str, tuple[str, str]]
    paths: dict[str, str]
    times: np.ndarray

    @staticmethod
    def open(path: pathlib.Path) -> HistoryFile:
        def take(file: h5py.File) -> HistoryFile:
            found = files.datasets(file)
            if TIME not in found:
                raise ScreeError(f"{path}: has no column {TIME}")
            rows = min(len(dataset) for dataset in found.values())
            paths = {FORMER[name]: name for name in found if name in FORMER}
            labels = {FORMER.get(name, name): files.label(d) for name, d in found.items()}
            return HistoryFile(path, labels, paths, found[TIME][:rows])

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
        """Columns of these names, or all, read together. Former names are understood. Throws MissingError where one is
        not there."""
        present = {name: name if name in self._labels else FORMER.get(name, name) for name in names or self._labels}
        for name in names:
            if present[name] not in self._labels:
                near = [path for path in self if name.split("/")[-1] in path][:5]
                raise MissingError(f"no column {name}" + (f"; there are {', '.join(near)}" if near else ""))
        self._load(present.values())
        return {name: Quantity(self._read[now], *self._labels[now]) for name, now in present.items()}

    def _load(self, names: Iterable[str]) -> None:
        wanted = [name for name in dict.fromkeys(names) if name not in self._read]
        if not wanted:
            return
        values: dict[str, list[np.ndarray]] = {name: [] for name in wanted}
        for file, rows in self._parts:
            paths = [file.paths.get(name, name) for name in wanted]

            def take(opened: h5py.File, count: int = rows, paths: Sequence[str] = tuple(paths)) -> list[np.ndarray]:
                return [opened[path][:count] for path in paths]

            for name, column in zip(wanted, files.read(file.path, take)):
                if len(column) < rows:
                    raise ScreeError(f"{file.path}: has fewer rows than when it was opened; refresh() the run")
                values[name].append(column)
        self._read.update({name: np.concatenate(columns) for name, columns in values.items()})

    def names(self, *patterns: str) -> list[str]:
        """Columns whose paths a pattern fits ("contacts/*/fx", or a name); throws ScreeError where none does."""
        found: list[str] = []
        for pattern in patterns:
            fitting = fnmatch.filter(self, FORMER.get(pattern, pattern))
            if not fitting:
                near = difflib.get_close_matches(pattern, self, cutoff=0.7)
                raise ScreeError(f"no column {pattern}; " + (f"did you mean {' or '.join(near)}?" if near else
                                                             f"there are: {', '.join(self) or 'none'}"))
            found += [name for name in fitting if name not in found]
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
