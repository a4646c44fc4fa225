"""The snapshots of one kind: the content of particles.vtkhdf, bodies.vtkhdf, surfaces.vtkhdf, contacts.vtkhdf or
links.vtkhdf."""

from __future__ import annotations

import pathlib
from collections.abc import Sequence
from dataclasses import dataclass

import h5py
import numpy as np

from scree import files
from scree.errors import ScreeError
from scree.fields import POSITION
from scree.quantity import Quantity

COUNTS = "Thinned/counts"  # number of points of each snapshot before scree-post thin left some out


@dataclass(frozen=True)
class SeriesFile:
    """Metadata of the snapshots in one file, without their rows."""

    path: pathlib.Path
    title: str
    names: dict[str, list[str]]  # names that fields count: of bodies or links ("names"), "materials", "groups"
    times: np.ndarray  # [snapshots] [s]
    first: np.ndarray  # first row of each snapshot in Points
    field_first: dict[str, np.ndarray]  # first row of each snapshot, per field of points
    points: np.ndarray  # number of points per snapshot
    counts: np.ndarray  # number of points per snapshot before scree-post thin left some out
    triangles: np.ndarray  # surfaces: [triangles][3], corner points counted from the first point of the snapshot
    lines: bool  # whether consecutive pairs of points are lines
    cell_first: dict[str, np.ndarray]  # first row of each snapshot, per field of triangles or lines
    labels: dict[str, tuple[str, str]]  # unit and description of position and of every field

    @staticmethod
    def open(path: pathlib.Path) -> SeriesFile:
        def take(file: h5py.File) -> SeriesFile:
            root, own = file["VTKHDF"], file["Scree"]
            steps = root["Steps"]
            labels = {POSITION: files.label(root["Points"])}
            for group in ("PointData", "CellData"):
                labels |= {name: files.label(field) for name, field in root.get(group, {}).items()}
            points, cells = steps.get("PointDataOffsets", {}), steps.get("CellDataOffsets", {})
            of_parts = root["NumberOfPoints"][:][steps["PartOffsets"][:]]
            triangles = root["Polygons/Connectivity"][:].reshape(-1, 3) if "Polygons" in root else np.empty((0, 3), int)
            return SeriesFile(
                path,
                files.text(own.attrs["title"]),
                {name: files.text(entries[()]).split("\n")[:-1] for name, entries in own.items()},
                steps["Values"][:],
                steps["PointOffsets"][:],
                {name: offsets[:] for name, offsets in points.items()},
                of_parts,
                file[COUNTS][:] if COUNTS in file else of_parts,
                triangles,
                "LineOffsets" in steps,
                {name: cells[name][:] if name in cells else np.zeros(len(steps["Values"]), int)
                 for name in root.get("CellData", {})},
                labels,
            )

        return files.read(path, take)

    def rows(self, snapshot: int, name: str) -> np.ndarray:
        """Rows of position or of a field in one snapshot."""
        if name not in self.labels:
            setting = "surface_fields" if self.cell_first else "fields"
            hint = "" if self.lines else f"; the run's output.{setting} must name it"
            raise ScreeError(f"{self.path}: holds no field {name}{hint}")
        if name in self.cell_first:
            first, where = self.cell_first[name][snapshot], f"CellData/{name}"
            count = self.points[snapshot] // 2 if self.lines else len(self.triangles)
        else:
            first = self.field_first.get(name, self.first)[snapshot]
            count = self.points[snapshot]
            where = "Points" if name == POSITION else f"PointData/{name}"
        found: np.ndarray = files.read(self.path, lambda file: file["VTKHDF"][where][first : first + count])
        if len(found) < count:
            raise ScreeError(f"{self.path}: has fewer snapshots than when it was opened; refresh() the run")
        return found


class Series:
    """Snapshots over all folders of a run, counted from 0."""

    def __init__(self, parts: Sequence[tuple[SeriesFile, int]]) -> None:
        """parts: files in the order of time, with the number of snapshots to use."""
        self._snapshots = [(file, snapshot) for file, count in parts for snapshot in range(count)]
        self._last = parts[-1][0]
        self.times = np.concatenate([file.times[:count] for file, count in parts])  # [s]

    def __len__(self) -> int:
        return len(self._snapshots)

    @property
    def title(self) -> str:
        return self._last.title

    def names(self, what: str) -> list[str]:
        """Names of bodies or links ("names"), "materials" or "groups", in the order in which fields count them."""
        return self._last.names.get(what, [])

    def fields(self, snapshot: int) -> list[str]:
        """Names of fields, position first."""
        return list(self._snapshots[snapshot][0].labels)

    def has(self, name: str) -> bool:
        return name in self._last.labels

    def label(self, name: str) -> tuple[str, str]:
        """Unit and description."""
        if not self.has(name):
            raise ScreeError(f"{self._last.path}: holds no field {name}")
        return self._last.labels[name]

    def count(self, snapshot: int) -> int:
        """Number of points."""
        file, number = self._snapshots[snapshot]
        return int(file.points[number])

    def whole_count(self, snapshot: int) -> int:
        """Number of points of the run, of which thinned results have a part."""
        file, number = self._snapshots[snapshot]
        return int(file.counts[number])

    def rows(self, snapshot: int, name: str) -> np.ndarray:
        """[points] or [points][k]; a field of triangles or lines has one row per triangle or line."""
        file, number = self._snapshots[snapshot]
        return file.rows(number, name)

    def speed(self, snapshot: int) -> np.ndarray:
        """[points] [m/s]"""
        return np.asarray(np.linalg.norm(self.rows(snapshot, "velocity"), axis=1))

    def quantity(self, snapshot: int, name: str) -> Quantity:
        return Quantity(self.rows(snapshot, name), *self._snapshots[snapshot][0].labels[name])

    def triangles(self, snapshot: int) -> np.ndarray:
        """Surfaces: rows of position at the corners of triangles [triangles][3]."""
        return self._snapshots[snapshot][0].triangles

    def lines(self, snapshot: int) -> np.ndarray:
        """Contacts and links: rows of position at the ends of lines [lines][2]."""
        file, number = self._snapshots[snapshot]
        return np.arange(file.points[number] if file.lines else 0).reshape(-1, 2)

    @property
    def has_lines(self) -> bool:
        return self._last.lines

    def is_of_cells(self, name: str) -> bool:
        """Whether it is a field of triangles or lines instead of points."""
        return name in self._last.cell_first
