"""Snapshots of a run."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from scree.errors import MissingError, ScreeError
from scree.fields import POSITION
from scree.particle_file import write_columns
from scree.quantity import Quantity
from scree.series import Series

if TYPE_CHECKING:
    import pandas
    import pyvista

KINDS = ("particles", "bodies", "surfaces", "contacts", "links")
COMPONENTS = {3: "xyz", 4: "wxyz", 9: ("xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz")}


class Points(Mapping[str, Quantity]):
    """The particles, shapes of bodies, triangles or lines of one snapshot: fields by name, read on demand. "position"
    [points][3] [m] is one of them. Rows of particles are in the order of global_id."""

    def __init__(self, series: Series, snapshot: int) -> None:
        self._series, self._snapshot = series, snapshot
        self._read: dict[str, Quantity] = {}

    def __iter__(self) -> Iterator[str]:
        return iter(self._series.fields(self._snapshot))

    def __len__(self) -> int:
        """Number of fields."""
        return len(self._series.fields(self._snapshot))

    def __contains__(self, name: object) -> bool:
        return name in self._series.fields(self._snapshot)

    def __getitem__(self, name: str) -> Quantity:
        if name not in self:
            raise MissingError(f"no field {name}; there are {', '.join(self)}")
        if name not in self._read:
            self._read[name] = self._series.quantity(self._snapshot, name)
        return self._read[name]

    @property
    def count(self) -> int:
        """Number of particles, points of bodies, corners of surfaces, or lines of contacts and links. len() is the
        number of fields."""
        return len(self.lines) if self._series.has_lines else self._series.count(self._snapshot)

    @property
    def triangles(self) -> np.ndarray:
        """Surfaces: rows of position at the corners of triangles [triangles][3]. Empty for other kinds."""
        return self._series.triangles(self._snapshot)

    @property
    def lines(self) -> np.ndarray:
        """Contacts and links: rows of position at the ends of lines [lines][2]. Empty for other kinds."""
        return self._series.lines(self._snapshot)

    def to_dataframe(self) -> pandas.DataFrame:
        """One row per particle, shape, triangle or line; one column per component of a field, as "velocity_x". x, y and
        z are the position of a point or of the centre of a triangle; lines have the positions of their ends, "start_x",
        ..., "end_x", ... attrs["units"] has the units by column."""
        import pandas

        of_cells = any(map(self._series.is_of_cells, self))
        columns, units = {}, {}
        fields = {name: field for name, field in self.items() if self._series.is_of_cells(name) == of_cells}
        position = self[POSITION]
        if self._series.has_lines:
            fields = {name: Quantity(position.values[k::2], position.unit, position.description)
                      for k, name in enumerate(("start", "end"))} | fields
        elif of_cells:
            centers = position.values[self.triangles].mean(axis=1)
            fields = {POSITION: Quantity(centers, position.unit, position.description)} | fields
        for name, field in fields.items():
            for column, values in components(name, field.values).items():
                columns[column], units[column] = values, field.unit
        frame = pandas.DataFrame(columns)
        frame.attrs["units"] = units
        return frame

    def to_particle_file(self, path: str | os.PathLike[str], dimension: int = 3,
                         rows: np.ndarray | slice = slice(None),
                         more: Mapping[str, np.ndarray] | None = None) -> dict[str, Any]:
        """Writes a particle file for another deck, CSV, or HDF5 if the name ends in .h5: positions, and the velocities,
        spins, radii and masses that are fields. rows: the particles to write. more: fields that the snapshot does not
        have. Returns the keys of [[particles]] that read the file."""
        written = (POSITION, "velocity", "angular_velocity", "radius", "mass")
        known = {name: self[name].values[rows] for name in written if name in self}
        known |= {name: values[rows] for name, values in (more or {}).items() if name not in self}
        columns = dict(zip("xyz"[:dimension], known[POSITION].T))
        if "velocity" in known:
            columns |= {f"v{axis}": values for axis, values in zip("xyz"[:dimension], known["velocity"].T)}
        if "angular_velocity" in known:
            spins = dict(zip(("wx", "wy", "wz"), known["angular_velocity"].T))
            columns |= spins if dimension == 3 else {"wz": spins["wz"]}
        columns |= {name: known[name] for name in ("radius", "mass") if name in known}
        return write_columns(path, columns)

    def to_pyvista(self) -> pyvista.PolyData:
        """Vertices of points, triangles of surfaces, or lines of contacts and links, with all fields, and the time of
        the snapshot as field data "time". Particles become spheres of true size by `.glyph(scale="radius",
        geom=pyvista.Sphere(radius=1.0))`."""
        import pyvista

        mesh = pyvista.PolyData(self[POSITION].values)
        if len(self.triangles):
            mesh = pyvista.PolyData.from_regular_faces(self[POSITION].values, self.triangles)
        elif len(self.lines):
            mesh = pyvista.PolyData(self[POSITION].values, lines=np.insert(self.lines, 0, 2, axis=1).ravel())
        for name, field in self.items():
            if name != POSITION and len(field):  # pyvista refuses empty arrays
                data = mesh.cell_data if self._series.is_of_cells(name) else mesh.point_data
                data[name] = field.values
        mesh.field_data["time"] = self._series.times[self._snapshot : self._snapshot + 1]
        return mesh


def components(name: str, values: np.ndarray) -> dict[str, np.ndarray]:
    """Columns of a field: [n] is one, [n][k] has one per component. Columns of positions are x, y and z."""
    if values.ndim == 1:
        return {name: values}
    prefix = "" if name == POSITION else f"{name}_"
    return {f"{prefix}{component}": values[:, k] for k, component in enumerate(COMPONENTS[values.shape[1]])}


class Snapshot:
    """One instant of a run."""

    def __init__(self, series: Mapping[str, Series], number: int) -> None:
        self._series, self.number = series, number

    @property
    def time(self) -> float:
        """[s]"""
        return float(next(iter(self._series.values())).times[self.number])

    def _points(self, kind: str) -> Points:
        if kind not in self._series:
            raise ScreeError(f"the run has no {kind}.vtkhdf")
        return Points(self._series[kind], self.number)

    @property
    def kinds(self) -> tuple[str, ...]:
        """Those of "particles", "bodies", "surfaces", "contacts" and "links" that the run has."""
        return tuple(self._series)

    @property
    def particles(self) -> Points:
        """Throws ScreeError without particles.vtkhdf."""
        return self._points("particles")

    @property
    def bodies(self) -> Points:
        """Discs or spheres of bodies ("kind" 0; 2: visual-only), then centres of mass ("kind" 1, of radius 0). The
        field "body" counts the body_names of the run. Throws ScreeError without bodies."""
        return self._points("bodies")

    @property
    def surfaces(self) -> Points:
        """The triangles of meshes. Throws ScreeError without meshes."""
        return self._points("surfaces")

    @property
    def contacts(self) -> Points:
        """Contacts of particles and of discs and spheres of bodies as lines; `.count` is their number. The fields
        "wall", "body" and "first_body" count the wall_names and body_names of the run. Throws ScreeError unless the
        deck has output.contacts = true."""
        return self._points("contacts")

    @property
    def links(self) -> Points:
        """Joints and force elements as lines; `.count` is their number. The field "link" counts the link_names of the
        run. Throws ScreeError if there are none, or if output.links is false."""
        return self._points("links")

    def to_pyvista(self) -> pyvista.MultiBlock:
        """One block for each of `kinds`."""
        import pyvista

        return pyvista.MultiBlock({kind: self._points(kind).to_pyvista() for kind in self._series})

    def __repr__(self) -> str:
        counts = ", ".join(f"{self._points(kind).count} {'' if series.has_lines else 'points of '}{kind}"
                           for kind, series in self._series.items())
        return f"<snapshot {self.number} at t = {self.time:.9g} s: {counts}>"


class Snapshots(Sequence[Snapshot]):
    """The snapshots of a run in the order of time; negative numbers count from the last one."""

    def __init__(self, series: Mapping[str, Series]) -> None:
        self._series = series
        self.times = next(iter(series.values())).times if series else np.empty(0)  # [s], common to all kinds

    def __len__(self) -> int:
        return len(self.times)

    @overload
    def __getitem__(self, number: int) -> Snapshot: ...
    @overload
    def __getitem__(self, number: slice) -> list[Snapshot]: ...
    def __getitem__(self, number: int | slice) -> Snapshot | list[Snapshot]:
        found = range(len(self))[number]  # index rules of a list
        return Snapshot(self._series, found) if isinstance(found, int) else [self[k] for k in found]

    def at(self, time: float) -> Snapshot:
        """The snapshot nearest to a time [s]."""
        if len(self) == 0:
            raise ScreeError("the run has no snapshots")
        return self[int(np.abs(self.times - time).argmin())]
