"""Geometry of links as a deck's meshes and shapes."""

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
SHEET = "made a sheet, which particles touch from both sides, as it is no solid's surface as it stands"
LEFT_OUT = "left out, particles pass through it"


def find_file(geometry: Geometry, folder: pathlib.Path, packages: Mapping[str, str]) -> pathlib.Path:
    """folder: of the robot's file. packages: their folders by name; one that is not among them may be the name of a
    folder above. Throws ScreeError where there is no such file."""
    name, element = geometry.file, geometry.element
    scheme = next((each for each in SCHEMES if name.startswith(each)), None)
    if scheme:
        package, _, rest = name.removeprefix(scheme).partition("/")
        above = next((each for each in (folder, *folder.parents) if each.name == package), None)
        if package not in packages and above is None:
            element.fail(f"{name}: where package {package} is must be said: --package {package}=FOLDER")
        path = pathlib.Path(packages.get(package) or str(above)) / rest
    else:
        path = folder / name.removeprefix("file://")
    if not path.is_file():
        path = pathlib.Path(str(path).replace("\\", "/"))  # as Windows has it
    if not path.is_file():
        element.fail(f"{name}: no such file: {path}; --geometry none does without all of them")
    return path.resolve()


def factors_of(scales: np.ndarray) -> dict[str, Any]:
    """What a deck's mesh says of scales along x, y and z."""
    x, y, z = scales.tolist()
    if x == y == z > 0:
        return {} if x == 1 else {"scale": x}
    size = abs(x)
    factors = [x / size, y / size, z / size]
    return ({} if size == 1 else {"scale": size}) | {"stretch": factors}


def surface_of(geometry: Geometry, folder: pathlib.Path, packages: Mapping[str, str],
               notes: Notes) -> tuple[pathlib.Path, surface.Surface] | None:
    """None, with a note, for what a deck cannot have."""
    item = f"{geometry.file} (line {geometry.element.line})"
    if pathlib.PurePath(geometry.file).suffix.lower() not in FORMATS:
        notes.add(f"no STL, OBJ or PLY, {LEFT_OUT}; convert it, and name the new file in the robot's", item)
        return None
    path = find_file(geometry, folder, packages)
    try:
        return path, surface.read(path)
    except ScreeError as error:
        notes.add(f"no mesh, {LEFT_OUT}", f"{item} {error}")
        return None


def file_mesh(geometry: Geometry, folder: pathlib.Path, packages: Mapping[str, str],
              notes: Notes) -> tuple[dict[str, Any], float] | None:
    found = surface_of(geometry, folder, packages, notes)
    if found is None:
        return None
    path, seen = found
    if seen.trouble:
        notes.add(SHEET, f"{geometry.file} (line {geometry.element.line}) {seen.trouble}")
    far = np.maximum(np.abs(seen.low), np.abs(seen.high)) * np.abs(geometry.numbers)
    table = {"kind": "file", "file": os.path.relpath(path, folder), **factors_of(geometry.numbers)}
    return table | ({"sheet": True} if seen.is_open or seen.trouble else {}), float(np.linalg.norm(far))


def mesh_table(geometry: Geometry, pose: Pose, folder: pathlib.Path, packages: Mapping[str, str],
               notes: Notes) -> tuple[dict[str, Any], float] | None:
    """What [[meshes]] says of it, but for the name, and how far it goes from its frame's origin [m]; None, with a note,
    for what a deck cannot have. pose: in the frame of its body."""
    numbers = geometry.numbers.tolist()
    if geometry.kind == "mesh":
        found = file_mesh(geometry, folder, packages, notes)
        if found is None:
            return None
        table, reach = found
    elif geometry.kind == "box":
        table, reach = {"kind": "box", "size": numbers}, float(np.linalg.norm(numbers) / 2)
    elif geometry.kind in ("cylinder", "capsule"):
        table, reach = {"kind": geometry.kind, "radius": numbers[0], "length": numbers[1]}, numbers[0] + numbers[1] / 2
    else:
        table, reach = {"kind": "sphere", "radius": numbers[0]}, numbers[0]
    return table | pose.keys("offset"), reach + float(np.linalg.norm(pose.origin))
