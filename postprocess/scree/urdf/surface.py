"""Checks whether the triangles of a file can bound a solid."""

from __future__ import annotations

import contextlib
import functools
import pathlib
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from scree.errors import ScreeError

LEAST_HEIGHT = 1e-12  # smallest height of a triangle over its longest side; below it is degenerate
DEPTH = 1e-5  # depth of the test points behind a triangle over the extent
POINTS = 16  # number of test points per part
MOST_WORK = 3e8  # largest number of pairs of a test point and a triangle


@dataclass(frozen=True)
class Surface:
    """low, high: bounding box [unit of the file]. is_open: has free edges. defect: why it is neither an open surface
    nor the surface of a solid; "": it is one of them."""

    low: np.ndarray
    high: np.ndarray
    is_open: bool
    defect: str


def edges_of(triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Number and direction (1 or -1) of the edges of all triangles: first all first sides, then second, third."""
    sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    _, edge = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True)
    return edge.reshape(-1), np.where(sides[:, 0] < sides[:, 1], 1, -1)


def parts_of(edge: np.ndarray) -> np.ndarray:
    """For each triangle of a closed surface the number of its connected part."""
    pairs = np.argsort(edge, kind="stable").reshape(-1, 2) % (len(edge) // 3)  # pairs of triangles
    part = np.arange(len(edge) // 3)
    while True:
        before = part.copy()
        lowest = np.minimum(part[pairs[:, 0]], part[pairs[:, 1]])
        for side in (0, 1):
            np.minimum.at(part, part[pairs[:, side]], lowest)
            np.minimum.at(part, pairs[:, side], lowest)
        part = part[part]
        if (part == before).all():
            return np.unique(part, return_inverse=True)[1].reshape(-1)


def winding_number(point: np.ndarray, corners: np.ndarray) -> float:
    """Winding number of triangles [n][3][3]: van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30, 1983."""
    a, b, c = (corners - point).transpose(1, 0, 2)
    la, lb, lc = (np.linalg.norm(each, axis=1) for each in (a, b, c))
    up = np.einsum("ij,ij->i", a, np.cross(b, c))
    down = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
    return float(np.arctan2(up, down).sum() / (2 * np.pi))


def has_misplaced_parts(corners: np.ndarray, part: np.ndarray) -> bool:
    """Whether parts of a closed surface are inside or intersect each other, except cavities; true if the test would
    take too long. corners: [triangles][3][3]."""
    count = int(part.max()) + 1
    if count == 1:
        return False
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    about = corners - corners[0, 0]
    volumes = np.bincount(part, np.einsum("ij,ij->i", about[:, 0], np.cross(about[:, 1], about[:, 2]))) / 6
    areas = np.bincount(part, np.linalg.norm(normals, axis=1)) / 2
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(low, part, corners.min(axis=1))
    np.maximum.at(high, part, corners.max(axis=1))
    extent = float(np.ptp(corners.reshape(-1, 3), axis=0).max())
    work = 0.0
    for k in range(count):
        near = ((low <= high[k]) & (low[k] <= high)).all(axis=1)
        near[k] = False
        around = 1 if volumes[k] < 0 else 0  # winding number of the other parts behind the triangles
        if not near.any():
            if around:
                return True
            continue
        others = corners[near[part]]
        own = np.flatnonzero(part == k)
        largest = own[np.argsort(np.linalg.norm(normals[own], axis=1))[::-1][:POINTS]]
        work += float(len(others)) * len(largest)
        if work > MOST_WORK:
            return True
        depth = min(DEPTH * extent, 0.01 * abs(volumes[k]) / areas[k])
        for t in largest:
            behind = corners[t].mean(axis=0) - depth * normals[t] / np.linalg.norm(normals[t])
            if abs(winding_number(behind, others) - around) > 0.5:
                return True
    return False


def find_defect(points: np.ndarray, triangles: np.ndarray) -> tuple[bool, str]:
    """Whether the surface is open, and its defect. points: without duplicates."""
    corners = points[triangles]
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    doubled = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    edge, direction = edges_of(triangles)
    count = np.bincount(edge)
    is_open = bool((count == 1).any())
    if not (doubled > LEAST_HEIGHT * sides.max(axis=1) ** 2).all():
        return is_open, "has triangles without area"
    if len(np.unique(np.sort(triangles, axis=1), axis=0)) < len(triangles):
        return is_open, "has triangles twice"
    if (np.bincount(edge, direction)[count == 2] != 0).any():
        return is_open, "has triangles that are wound both ways"
    if is_open:
        return True, ""
    if (count > 2).any():
        return False, "has edges of more than two triangles"
    about = corners - points[0]
    volume = float(np.einsum("ij,ij->i", about[:, 0], np.cross(about[:, 1], about[:, 2])).sum() / 6)
    if volume <= LEAST_HEIGHT * (doubled.sum() / 2) ** 1.5:
        return False, "is inside out or encloses nothing"
    if has_misplaced_parts(corners, parts_of(edge)):
        return False, "has parts inside others or through each other"
    return False, ""


@contextlib.contextmanager
def silent_vtk() -> Iterator[None]:
    """Suppresses messages of VTK; the messages of this module are more specific."""
    from vtkmodules.vtkCommonCore import vtkLogger

    before = vtkLogger.GetCurrentVerbosityCutoff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    try:
        yield
    finally:
        vtkLogger.SetStderrVerbosity(before)


def triangles_of(path: pathlib.Path) -> tuple[np.ndarray, np.ndarray]:
    """Points and triangles of the file, degenerate ones included. Throws ScreeError without the path."""
    import pyvista

    try:
        with silent_vtk():
            reader = pyvista.get_reader(path)
            if hasattr(reader.reader, "MergingOff"):  # merging drops triangles
                reader.reader.MergingOff()
            mesh = reader.read().extract_surface(algorithm="dataset_surface").triangulate()
    except Exception as error:  # any exception of a VTK reader
        raise ScreeError(f"cannot be read: {error}") from error
    if mesh.n_cells == 0:
        raise ScreeError("has no triangles")
    return np.asarray(mesh.points, dtype=float), np.asarray(mesh.faces).reshape(-1, 4)[:, 1:]


@functools.lru_cache(maxsize=256)
def read(path: pathlib.Path) -> Surface:
    """Throws ScreeError without the path if the file is not a mesh."""
    with path.open("rb") as file:
        if file.read(40).startswith(b"version https://git-lfs"):
            raise ScreeError("is a Git LFS pointer: git lfs pull fetches the mesh")
    points, triangles = triangles_of(path)
    if not np.isfinite(points).all():
        raise ScreeError("has coordinates that are no finite numbers")
    unique_points, welded = np.unique(points, axis=0, return_inverse=True)
    defect = find_defect(unique_points, welded.reshape(-1)[triangles])
    return Surface(unique_points.min(axis=0), unique_points.max(axis=0), *defect)
