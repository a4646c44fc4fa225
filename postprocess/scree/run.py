"""A run: the results in its folders, complete or so far."""

from __future__ import annotations

import os
import pathlib
import warnings
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from scree.errors import ScreeError, ScreeWarning
from scree.history import History, HistoryFile
from scree.record import earlier_folder, is_going_on, read_deck, read_record
from scree.series import Series, SeriesFile
from scree.snapshots import KINDS, Snapshots

if TYPE_CHECKING:
    import pandas

    from scree.times import Reader

Folder = str | os.PathLike[str]


class Part:
    """The current content of one folder."""

    def __init__(self, folder: pathlib.Path) -> None:
        history = folder / "history.h5"
        self.history = HistoryFile.open(history) if history.exists() else None
        paths = {kind: folder / f"{kind}.vtkhdf" for kind in KINDS}
        self.series = {kind: SeriesFile.open(path) for kind, path in paths.items() if path.exists()}
        # The files of a snapshot are written one after the other: only the common snapshots are complete.
        self.snapshots = min((len(file.times) for file in self.series.values()), default=0)

    @property
    def start(self) -> float:
        """Earliest time in the folder [s]; infinite if it is empty."""
        times = [self.history.times] if self.history else []
        times += [file.times for file in self.series.values()]
        return min((float(found[0]) for found in times if len(found)), default=np.inf)


def rows_before(times: np.ndarray, limit: float) -> int:
    return int(np.searchsorted(times, limit, side="left"))


class Run:
    """Made by scree.open(). History and snapshots are those at that instant, or at the last refresh()."""

    def __init__(self, folders: Sequence[pathlib.Path], is_part: bool = False) -> None:
        """folders: in the order of time; the last one is that of the run itself. is_part: without its earlier
        folders."""
        self.folders, self._is_part = list(folders), is_part
        self.refresh()

    @property
    def folder(self) -> pathlib.Path:
        return self.folders[-1]

    def refresh(self) -> None:
        """Adds the data that the run has written since."""
        self.__dict__.pop("deck", None)
        self.record: dict[str, Any] | None = read_record(self.folder)
        self.is_going_on = is_going_on(self.folder)
        parts = [Part(folder) for folder in self.folders]
        self._begin = parts[0].start
        # Rows of a later folder replace rows of an earlier folder at the same and at later times.
        limits = [min((later.start for later in parts[k + 1 :]), default=np.inf) for k in range(len(parts))]
        histories = [(part.history, rows_before(part.history.times, limit))
                     for part, limit in zip(parts, limits) if part.history]
        self.history = History(histories)
        with_snapshots = [(part, limit) for part, limit in zip(parts, limits) if part.snapshots]
        self._series = {
            kind: Series([(part.series[kind], rows_before(part.series[kind].times[: part.snapshots], limit))
                          for part, limit in with_snapshots])
            for kind in KINDS
            if with_snapshots and all(kind in part.series for part, _ in with_snapshots)
        }
        self.snapshots = Snapshots(self._series)

    def series(self, kind: str) -> Series | None:
        """Snapshots of one of the KINDS, such as "particles"; None if the run has none."""
        return self._series.get(kind)

    @cached_property
    def deck(self) -> dict[str, Any]:
        """The resolved deck with all defaults. Throws ScreeError as long as the run has not written one."""
        return read_deck(self.folder, self.record)

    @property
    def title(self) -> str:
        """Title of the deck, or name of the folder."""
        return next((found.title for found in self._series.values() if found.title), "") or self.folder.name

    @property
    def status(self) -> str:
        """"done", the reason of the end, or "running"."""
        if self.is_going_on:
            return "running"
        return str(self.record["run"]["status"]) if self.record else "ended without a record: killed?"

    @property
    def stop_condition(self) -> str:
        """The stop condition that ended the run, with the last value of its column; empty if none did."""
        return str(self.record["run"].get("stop_condition", "")) if self.record else ""

    @property
    def lost_start(self) -> str:
        """A message if data before the first row are missing, otherwise empty."""
        if self._is_part or not 0 < self._begin < np.inf:
            return ""
        return f"{self.folders[0]}: begins at t = {self._begin:.9g} s, and no record names the folder with the " \
               f'earlier results; scree.open("EARLIER", "{self.folders[0].name}") joins the two'

    @property
    def warnings(self) -> list[str]:
        """Warnings of the record, and lost_start."""
        return [self.lost_start] * bool(self.lost_start) + (list(self.record["warnings"]) if self.record else [])

    def _names(self, kind: str, what: str) -> list[str]:
        return self._series[kind].names(what) if kind in self._series else []

    @property
    def body_names(self) -> list[str]:
        """Names of bodies, in the order in which fields count them."""
        found = self._series.get("bodies") or self._series.get("surfaces")
        return found.names("names") if found else []

    @property
    def material_names(self) -> list[str]:
        """Names of materials, as counted by the field "material" of particles and surfaces."""
        return self._names("particles", "materials")

    @property
    def group_names(self) -> list[str]:
        """Names of [[particles]], or their numbers, as counted by the field "group"."""
        return self._names("particles", "groups")

    @property
    def wall_names(self) -> list[str]:
        """Names of walls, as counted by the field "wall" of contacts and surfaces: the deck's [[walls]], then the sides
        of the domain that are walls, such as "x_min"."""
        domain = self.deck["space"]
        return [wall["name"] for wall in self.deck.get("walls", [])] + [
            f"{axis}_{end}" for axis in "xyz" for end in ("min", "max") if domain.get(f"{axis}_{end}") == "wall"]

    @property
    def link_names(self) -> list[str]:
        """Names of joints and force elements, as counted by the field "link"."""
        return self._names("links", "names")

    def to_dataframe(self, *patterns: str) -> pandas.DataFrame:
        """The history as a table: see History.to_dataframe()."""
        return self.history.to_dataframe(*patterns)

    def __repr__(self) -> str:
        return (f"<run {self.folder}, {self.status}: {self.history.rows} rows of {len(self.history)} columns, "
                f"{len(self.snapshots)} snapshots>")


def open_run(folder: Folder, *later: Folder, earlier: bool = True) -> Run:
    """The run in a folder. If it continued from a checkpoint in another folder, the results there up to the checkpoint
    come first; earlier=False leaves them out. Several folders are joined in the given order, which is that of time.

    Throws ScreeError if the folder does not exist, has no results of a run, or if the earlier folder is not found.
    Warns if the run begins after t = 0 and no earlier folder is known.
    """
    folders = [pathlib.Path(path).resolve() for path in (folder, *later)]
    for path in folders:
        if path.is_file():
            raise ScreeError(f"{path}: is a file; a run is opened by its folder, here {path.parent}")
        if not path.is_dir():
            raise ScreeError(f"{path}: no such folder")
    if earlier and not later:
        while (before := earlier_folder(folders[0], read_record(folders[0]))) and before not in folders:
            folders.insert(0, before)
    run = Run(folders, is_part=not earlier)
    if not (run.history or len(run.snapshots) or run.record or run.is_going_on):
        raise ScreeError(f"{run.folder}: holds no results of a run")
    if run.lost_start:
        warnings.warn(run.lost_start, ScreeWarning, stacklevel=2)
    return run


def reader(path: Folder) -> Reader:
    """pyvista's reader of a .vtkhdf with support for times, which pyvista's own lacks: time_values,
    set_active_time_value(), read()."""
    from scree.times import Reader

    return Reader(path)
