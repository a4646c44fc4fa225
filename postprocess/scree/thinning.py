"""Thinned results: the particles that one sees, with fewer digits, in a folder like that of the run."""

from __future__ import annotations

import contextlib
import pathlib
import shutil
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from typing import Any

import h5py
import numpy as np

from scree import files
from scree.errors import ScreeError
from scree.fields import POSITION
from scree.pictures.framing import picture_axes
from scree.pictures.model import Model
from scree.record import RECORD
from scree.run import Run
from scree.series import COUNTS, Series

CELL = 0.35  # side of the cells of the depth map over the smallest radius
HALF_DIAGONAL = 0.7072  # of a cell over its side
POSITIONS = 1 / 64  # error of positions over the smallest radius
VALUES = 1 / 512  # error of other fields over the 99th percentile of their magnitudes in a snapshot
CHUNK, DEFLATE = 2**15, 4  # rows of a chunk; level of its compression
EMPTY = ("Polygons", "Strips")  # cells that no snapshot of particles has: the same group as Lines
OTHERS = ("bodies", "surfaces", "links")  # kinds that stay as they are; contacts are left out


def views(model: Model, all_sides: bool) -> list[np.ndarray]:
    """Axes [3][3] of pictures: right, up and towards the viewer. That of the pictures of this package, and those along
    the axes."""
    if model.planar:
        return [np.eye(3)]
    along = [sign * np.roll(np.eye(3), shift, axis=0) for sign in (1, -1) for shift in range(3)]
    return [picture_axes(model.up), *(along if all_sides else [])]


def cells_of(flat: np.ndarray, radii: np.ndarray, cell: float, margin: float) \
        -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """The cells of a depth map in which spheres are: arrays of spheres, of cells [n][2], and of the heights of the
    surfaces there above the centres. flat: centres [n][2]. margin: 1 for the cells that a sphere covers entirely, with
    the least height there; -1 for all cells that it touches, with the largest height."""
    home = np.floor(flat / cell).astype(int)
    reach = np.ceil(radii / cell).astype(int) + (margin < 0)
    for size in np.unique(reach):
        some = np.flatnonzero(reach == size)
        apart, squares = (home[some] + 0.5) * cell - flat[some], radii[some] ** 2
        for offset in np.ndindex(2 * size + 1, 2 * size + 1):
            step = np.array(offset) - size
            distances = np.hypot(*(apart + step * cell).T) + margin * HALF_DIAGONAL * cell
            heights = squares - np.square(np.maximum(distances, 0))
            inside = heights > 0
            yield some[inside], home[some[inside]] + step, np.sqrt(heights[inside])


def seen(points: np.ndarray, radii: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """For each sphere, whether it may be visible between the others, looking along axes[2] from infinity."""
    found = np.zeros(len(points), dtype=bool)
    if len(points) == 0:
        return found
    projected = points @ axes.T
    cell, most = CELL * float(radii.min()), float(radii.max())
    flat = projected[:, :2] - projected[:, :2].min(axis=0) + most + 2 * cell
    depths = np.full(np.ceil((flat.max(axis=0) + most) / cell).astype(int) + 2, -np.inf)
    by_cell = depths.reshape(-1)
    for spheres, cells, heights in cells_of(flat, radii, cell, 1):
        np.maximum.at(by_cell, cells[:, 0] * depths.shape[1] + cells[:, 1], projected[spheres, 2] + heights)
    for spheres, cells, heights in cells_of(flat, radii, cell, -1):
        found[spheres[depths[cells[:, 0], cells[:, 1]] <= projected[spheres, 2] + heights]] = True
    return found


def rounded(values: np.ndarray, error: float) -> np.ndarray:
    """Rounded to multiples of a power of two, whose last digits are zeros that need no bytes once compressed."""
    if error <= 0:
        return values
    unit = 2.0 ** np.floor(np.log2(2 * error))
    return np.asarray(np.round(values / unit) * unit)


def kept_rows(series: Series, box: tuple[np.ndarray, np.ndarray], axes: Sequence[np.ndarray],
              snapshot: int) -> dict[str, np.ndarray]:
    """Position and fields of the particles to keep. box: lower and upper corner; particles outside of it are kept."""
    points, radii = series.rows(snapshot, POSITION), series.rows(snapshot, "radius")
    inside = ((points >= box[0]) & (points <= box[1])).all(axis=1)
    keep = np.asarray(~inside)
    for each in axes:
        keep[inside] |= seen(points[inside], radii[inside], each)
    found = {name: series.rows(snapshot, name)[keep] for name in series.fields(snapshot)}
    for name, values in found.items():
        if values.dtype.kind == "f" and len(values):
            error = POSITIONS * radii.min() if name == POSITION else VALUES * np.percentile(np.abs(values), 99)
            found[name] = rounded(values, error)
    return found


def create(target: h5py.Group, name: str, source: h5py.Dataset) -> None:
    """Empty rows, like those of another file."""
    width = source.shape[1:]
    made = target.create_dataset(name, (0, *width), source.dtype, maxshape=(None, *width), chunks=(CHUNK, *width),
                                 compression=DEFLATE, shuffle=True)
    for key, text in source.attrs.items():
        made.attrs[key] = text


def append(rows: h5py.Dataset, values: np.ndarray | Sequence[int]) -> None:
    if len(values):
        rows.resize(len(rows) + len(values), axis=0)
        rows[-len(values):] = values


def select_steps(file: h5py.File, chosen: Sequence[int]) -> None:
    """Only these snapshots remain. Rows of others stay, without use."""
    steps = file["VTKHDF/Steps"]
    for rows in files.datasets(steps).values():
        values = rows[:][list(chosen)]
        rows.resize(len(chosen), axis=0)
        rows[:] = values
    steps.attrs["NSteps"] = len(chosen)


def copy_snapshots(source: h5py.File, target: h5py.File, chosen: Sequence[int]) -> None:
    for name in source:
        source.copy(name, target)
    select_steps(target, chosen)


def lay_out(source: h5py.File, target: h5py.File, chosen: Sequence[int]) -> None:
    """A file of particles without rows, where each snapshot will have a part of its own."""
    root, made = source["VTKHDF"], target.create_group("VTKHDF")
    for key, value in root.attrs.items():
        made.attrs.create(key, value, dtype=root.attrs.get_id(key).dtype)
    for name in ("Steps", "Lines", "FieldData"):
        if name in root:
            root.copy(name, made)
    source.copy("Scree", target)
    select_steps(target, chosen)
    for name in EMPTY:
        made[name] = made["Lines"]
    for name in ("NumberOfCells", "Offsets"):
        made["Lines"][name].resize(len(chosen), axis=0)
        made["Lines"][name][:] = 0
    for path in ("Points", "NumberOfPoints", "Vertices/Connectivity", "Vertices/Offsets",
                 *(f"PointData/{name}" for name in root.get("PointData", {}))):
        create(made, path, root[path])
    for name in ("NumberOfCells", "NumberOfConnectivityIds"):
        made["Vertices"][name] = made["NumberOfPoints"]
    made["Steps/PartOffsets"][:] = range(len(chosen))


def append_snapshot(root: h5py.Group, number: int, rows: dict[str, np.ndarray]) -> None:
    first, count = len(root["Points"]), len(rows[POSITION])
    for name in {"PointOffsets", "ConstantOffsets"} & set(root["Steps"]):
        root["Steps"][name][number] = first
    root["Steps/CellOffsets"][number, 0] = first
    append(root["NumberOfPoints"], [count])
    append(root["Vertices/Connectivity"], np.arange(count))
    append(root["Vertices/Offsets"], np.arange(count + 1))
    for name, values in rows.items():
        append(root["Points" if name == POSITION else f"PointData/{name}"], values)


def thin(run: Run, folder: pathlib.Path, chosen: Sequence[int], all_sides: bool = False,
         at_once: int = 1) -> None:
    """Writes these snapshots of a finished run of one folder into another folder, with its history and its record.
    at_once: number of snapshots. Throws ScreeError if the run has no snapshots of particles with radii."""
    particles = run.series("particles")
    if particles is None or not particles.has("radius"):
        raise ScreeError(f"{run.folder}: holds no particles with the field radius")
    if run.record is None:
        raise ScreeError(f"{run.folder}: has no {RECORD}, which a run writes at its end")
    folder.mkdir(parents=True, exist_ok=True)
    model = Model(run.deck)
    rows_of: Any = partial(kept_rows, particles, (model.low, model.high), views(model, all_sides))
    with contextlib.ExitStack() as opened:
        target = opened.enter_context(h5py.File(folder / "particles.vtkhdf", "w"))
        files.read(run.folder / "particles.vtkhdf", lambda source: lay_out(source, target, chosen))
        each = opened.enter_context(ProcessPoolExecutor(at_once)).map if at_once > 1 else map
        for number, rows in enumerate(each(rows_of, chosen)):
            append_snapshot(target["VTKHDF"], number, rows)
        target[COUNTS] = [particles.whole_count(snapshot) for snapshot in chosen]
    for kind in OTHERS:
        if run.series(kind):
            with h5py.File(folder / f"{kind}.vtkhdf", "w") as target:
                files.read(run.folder / f"{kind}.vtkhdf", lambda source: copy_snapshots(source, target, chosen))
    for name in ("history.h5", RECORD):
        if (run.folder / name).exists():
            shutil.copy(run.folder / name, folder)
