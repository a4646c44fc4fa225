"""Geometry of links as meshes and shapes of a deck."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from scree.errors import ScreeError
from scree.frames import Pose
from scree.urdf import surface
from scree.urdf.notes import Notes
from scree.urdf.robot import Geometry

FORMATS = (".stl", ".obj", ".ply")
SCHEMES = ("package://", "model://")
SHEET = "imported as an open surface (sheet) with contact on both sides, because it does not bound a solid"
LEFT_OUT = "left out: no contact"


def find_file(geometry: Geometry, folder: pathlib.Path, packages: Mapping[str, str]) -> pathlib.Path:
    """folder: of the robot's file. packages: folders by package name; other packages may be folders above. Throws
    ScreeError if the file does not exist."""
    name, element = geometry.file, geometry.element
    scheme = next((each for each in SCHEMES if name.startswith(each)), None)
    if scheme:
        package, _, rest = name.removeprefix(scheme).partition("/")
        above = next((each for each in (folder, *folder.parents) if each.name == package), None)
        if package not in packages and above is None:
            element.fail(f"{name}: the folder of package {package} is unknown: --package {package}=FOLDER")
        path = pathlib.Path(packages.get(package) or str(above)) / rest
    else:
        path = folder / name.removeprefix("file://")
    if not path.is_file():
        path = pathlib.Path(str(path).replace("\\", "/"))  # path of Windows
    if not path.is_file():
        element.fail(f"{name}: no such file: {path}; --geometry none imports without meshes")
    return path.resolve()


def factors_of(scales: np.ndarray) -> dict[str, Any]:
    """Keys of a mesh for scales along x, y and z."""
    x, y, z = scales.tolist()
    if x == y == z > 0:
        return {} if x == 1 else {"scale": x}
    size = abs(x)
    factors = [x / size, y / size, z / size]
    return ({} if size == 1 else {"scale": size}) | {"stretch": factors}


def surface_of(geometry: Geometry, folder: pathlib.Path, packages: Mapping[str, str],
               notes: Notes) -> tuple[pathlib.Path, surface.Surface] | None:
    """None, with a note, if a deck cannot have the geometry."""
    item = f"{geometry.file} (line {geometry.element.line})"
    if pathlib.PurePath(geometry.file).suffix.lower() not in FORMATS:
        notes.add(f"not STL, OBJ or PLY, {LEFT_OUT}; convert the file and name the new one in the robot's file", item)
        return None
    path = find_file(geometry, folder, packages)
    try:
        return path, surface.read(path)
    except ScreeError as error:
        notes.add(f"unreadable mesh, {LEFT_OUT}", f"{item} {error}")
        return None


def file_mesh(geometry: Geometry, folder: pathlib.Path, packages: Mapping[str, str],
              notes: Notes) -> tuple[dict[str, Any], float] | None:
    found = surface_of(geometry, folder, packages, notes)
    if found is None:
        return None
    path, mesh = found
    if mesh.defect:
        notes.add(SHEET, f"{geometry.file} (line {geometry.element.line}) {mesh.defect}")
    corner = np.maximum(np.abs(mesh.low), np.abs(mesh.high)) * np.abs(geometry.numbers)
    table = {"kind": "file", "file": os.path.relpath(path, folder), **factors_of(geometry.numbers)}
    return table | ({"sheet": True} if mesh.is_open or mesh.defect else {}), float(np.linalg.norm(corner))


def mesh_table(geometry: Geometry, pose: Pose, folder: pathlib.Path, packages: Mapping[str, str],
               notes: Notes) -> tuple[dict[str, Any], float] | None:
    """Keys of [[meshes]] without the name, and the largest distance from the origin of the body's frame [m]; None, with
    a note, if a deck cannot have the geometry. pose: in the frame of the body."""
    numbers = geometry.numbers.tolist()
    if geometry.kind == "mesh":
        found = file_mesh(geometry, folder, packages, notes)
        if found is None:
            return None
        table, extent = found
    elif geometry.kind == "box":
        table, extent = {"kind": "box", "size": numbers}, float(np.linalg.norm(numbers) / 2)
    elif geometry.kind in ("cylinder", "capsule"):
        table, extent = {"kind": geometry.kind, "radius": numbers[0], "length": numbers[1]}, numbers[0] + numbers[1] / 2
    else:
        table, extent = {"kind": "sphere", "radius": numbers[0]}, numbers[0]
    return table | pose.keys("offset"), extent + float(np.linalg.norm(pose.origin))
