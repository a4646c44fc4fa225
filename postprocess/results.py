"""Reads what a run wrote: the snapshots of a .vtkhdf file, one at a time, and the history."""

import pathlib
import sys

import h5py
import numpy as np


def fail(message):
    sys.exit(f"error: {message}")


def open_file(path):
    try:
        return h5py.File(path, "r")
    except OSError as error:
        fail(f"{path}: cannot open: {error}")


class Series:
    """The snapshots of one kind (particles, bodies or surfaces)."""

    def __init__(self, path):
        self._file = open_file(path)
        self._root = self._file["VTKHDF"]
        steps = self._root["Steps"]
        self.times = steps["Values"][:]  # [s]
        self._first = steps["PointOffsets"][:]
        self._count = self._root["NumberOfPoints"][:][steps["PartOffsets"][:]]
        self.title = self._file["Scree"].attrs["title"]
        if isinstance(self.title, bytes):
            self.title = self.title.decode()
        if len(self.times) == 0:
            fail(f"{path}: holds no snapshot")

    def __len__(self):
        return len(self.times)

    def rows(self, snapshot, name):
        """One snapshot's rows of Points or of a field."""
        if name != "Points" and not self.has(name):
            fail(f"{self._file.filename}: holds no field {name}; the run's output.fields must name it")
        dataset = self._root[name if name == "Points" else f"PointData/{name}"]
        first = self._first[snapshot]
        return dataset[first : first + self._count[snapshot]]

    def triangles(self):
        """Of surfaces: the rows of Points at their corners [n][3]."""
        return self._root["Polygons/Connectivity"][:].reshape(-1, 3)

    def numbers(self, name):
        """Of surfaces: what no snapshot changes, per triangle."""
        return self._root[f"CellData/{name}"][:]

    def of_triangles(self, snapshot, name):
        """Of surfaces: one snapshot's values of a field, of a vector its length."""
        if f"CellData/{name}" not in self._root or f"Steps/CellDataOffsets/{name}" not in self._root:
            fail(f"{self._file.filename}: holds no field {name}; the run's output.surface_fields must name it")
        first = self._root[f"Steps/CellDataOffsets/{name}"][snapshot]
        values = self._root[f"CellData/{name}"][first : first + len(self.triangles())]
        return values if values.ndim == 1 else np.linalg.norm(values, axis=1)

    def unit(self, name):
        """Of a field of triangles."""
        unit = self._root[f"CellData/{name}"].attrs["unit"]
        return unit.decode() if isinstance(unit, bytes) else unit

    def has(self, name):
        """Whether the field is there."""
        return name in self._root["PointData"]

    def speed(self, snapshot):
        """[m/s]"""
        return np.linalg.norm(self.rows(snapshot, "velocity"), axis=1)


def open_series(directory, kind):
    """None where the run has none of this kind."""
    path = pathlib.Path(directory) / f"{kind}.vtkhdf"
    return Series(path) if path.exists() else None


def read_history(directory):
    """{"group/name": (values, unit, description)}"""
    columns = {}

    def add(name, item):
        if isinstance(item, h5py.Dataset):
            unit, description = (item.attrs[key] for key in ("unit", "description"))
            texts = [text.decode() if isinstance(text, bytes) else str(text) for text in (unit, description)]
            columns[name] = (item[:], *texts)

    with open_file(pathlib.Path(directory) / "history.h5") as file:
        file.visititems(add)
    return columns
