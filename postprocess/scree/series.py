"""The snapshots of one kind: what particles.vtkhdf, bodies.vtkhdf, surfaces.vtkhdf, contacts.vtkhdf or links.vtkhdf
holds."""

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


@dataclass(frozen=True)
class SeriesFile:
    """What one file says of its snapshots, without their rows."""

    path: pathlib.Path
    title: str
    names: dict[str, list[str]]  # what fields count: bodies or links as "names", "materials", "groups"
    times: np.ndarray  # [snapshots] [s]
    first: np.ndarray  # row in Points at which each snapshot begins
    field_first: dict[str, np.ndarray]  # likewise per field of points
    points: np.ndarray  # their numbers of points
    triangles: np.ndarray  # [triangles][3], of surfaces: points at the corners, counted from the snapshot's first
    lines: bool  # whether each two points are the ends of one
    cell_first: dict[str, np.ndarray]  # per field of triangles or lines: row at which each snapshot begins
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
            triangles = root["Polygons/Connectivity"][:].reshape(-1, 3) if "Polygons" in root else np.empty((0, 3), int)
            return SeriesFile(
                path,
                files.text(own.attrs["title"]),
                {name: files.text(entries[()]).split("\n")[:-1] for name, entries in own.items()},
                steps["Values"][:],
                steps["PointOffsets"][:],
                {name: offsets[:] for name, offsets in points.items()},
                root["NumberOfPoints"][:][steps["PartOffsets"][:]],
                triangles,
                "LineOffsets" in steps,
                {name: cells[name][:] if name in cells else np.zeros(len(steps["Values"]), int)
                 for name in root.get("CellData", {})},
                labels,
            )

        return files.read(path, take)

    def rows(self, snapshot: int, name: str) -> np.ndarray:
        """One snapshot's rows of position or of a field."""
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
    """Snapshots counted from 0, over all folders of a run."""

    def __init__(self, parts: Sequence[tuple[SeriesFile, int]]) -> None:
        """parts: files in the order of time, with the number of snapshots to take of each."""
        self._places = [(file, snapshot) for file, count in parts for snapshot in range(count)]
        self._last = parts[-1][0]
        self.times = np.concatenate([file.times[:count] for file, count in parts])  # [s]

    def __len__(self) -> int:
        return len(self._places)

    @property
    def title(self) -> str:
        return self._last.title

    def names(self, what: str) -> list[str]:
        """Of bodies or links ("names"), "materials" or "groups", in the order in which fields count them."""
        return self._last.names.get(what, [])

    def fields(self, snapshot: int) -> list[str]:
        """Position first."""
        return list(self._places[snapshot][0].labels)

    def has(self, name: str) -> bool:
        return name in self._last.labels

    def label(self, name: str) -> tuple[str, str]:
        """Unit and description."""
        if not self.has(name):
            raise ScreeError(f"{self._last.path}: holds no field {name}")
        return self._last.labels[name]

    def count(self, snapshot: int) -> int:
        """Of points."""
        file, place = self._places[snapshot]
        return int(file.points[place])

    def rows(self, snapshot: int, name: str) -> np.ndarray:
        """[points] or [points][k], of a field of triangles or lines one row for each of these."""
        file, place = self._places[snapshot]
        return file.rows(place, name)

    def speed(self, snapshot: int) -> np.ndarray:
        """[points] [m/s]"""
        return np.asarray(np.linalg.norm(self.rows(snapshot, "velocity"), axis=1))

    def quantity(self, snapshot: int, name: str) -> Quantity:
        return Quantity(self.rows(snapshot, name), *self._places[snapshot][0].labels[name])

    def triangles(self, snapshot: int) -> np.ndarray:
        """[triangles][3], of surfaces: rows of position at their corners."""
        return self._places[snapshot][0].triangles

    def lines(self, snapshot: int) -> np.ndarray:
        """[lines][2], of contacts and links: rows of position at their ends."""
        file, place = self._places[snapshot]
        return np.arange(file.points[place] if file.lines else 0).reshape(-1, 2)

    @property
    def has_lines(self) -> bool:
        return self._last.lines

    def is_of_cells(self, name: str) -> bool:
        """Of triangles or lines, not of points."""
        return name in self._last.cell_first
