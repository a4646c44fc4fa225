"""Geometry of links as a deck's meshes and shapes."""

from __future__ import annotations

import os
import pathlib
import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np

from scree.errors import ScreeError, ScreeWarning
from scree.frames import Pose
from scree.urdf.robot import Geometry

FORMATS = (".stl", ".obj", ".ply")


def find_file(geometry: Geometry, folder: pathlib.Path, packages: Mapping[str, str]) -> pathlib.Path:
    """folder: of the robot's file. packages: their folders by name; one that is not among them may be the name of a
    folder above. Throws ScreeError where there is no such file."""
    name, element = geometry.file, geometry.element
    if name.startswith("package://"):
        package, _, rest = name.removeprefix("package://").partition("/")
        above = next((each for each in (folder, *folder.parents) if each.name == package), None)
        if package not in packages and above is None:
            element.fail(f"{name}: where package {package} is must be said: --package {package}=FOLDER")
        path = pathlib.Path(packages.get(package) or str(above)) / rest
    else:
        path = folder / name.removeprefix("file://")
    if not path.is_file():
        element.fail(f"{name}: no such file: {path}")
    return path.resolve()


def is_open(path: pathlib.Path) -> bool:
    """Whether edges are free or have more than two triangles, once equal places are one."""
    import pyvista

    try:
        mesh = pyvista.read(path).extract_surface(algorithm="dataset_surface").triangulate().clean(tolerance=0.0)
    except Exception as error:  # whatever a reader of VTK throws
        raise ScreeError(f"{path}: cannot be read: {error}") from error
    return not mesh.is_manifold


def scale_of(geometry: Geometry) -> float | None:
    """None where a deck cannot have it."""
    x, y, z = geometry.numbers
    return float(x) if x == y == z > 0 else None


def file_mesh(geometry: Geometry, folder: pathlib.Path, packages: Mapping[str, str]) -> dict[str, Any] | None:
    path = find_file(geometry, folder, packages)
    scale = scale_of(geometry)
    trouble = ""
    if path.suffix.lower() not in FORMATS:
        trouble = "is no STL, OBJ or PLY, and is left out; convert it, and name the new file here"
    elif scale is None:
        trouble = "is left out: a deck's mesh has one scale, above 0, along all axes"
    if trouble:
        warnings.warn(ScreeWarning(f"{geometry.element.place}: {geometry.file} {trouble}"), stacklevel=2)
        return None
    sized = {} if scale == 1 else {"scale": scale}
    sheet = {"sheet": True} if is_open(path) else {}
    return {"kind": "file", "file": os.path.relpath(path, folder), **sized, **sheet}


def mesh_table(geometry: Geometry, pose: Pose, folder: pathlib.Path,
               packages: Mapping[str, str]) -> dict[str, Any] | None:
    """What [[meshes]] says of it, but for the name; None, with a warning, for what a deck cannot have. pose: in the
    frame of its body."""
    table: dict[str, Any] | None
    if geometry.kind == "mesh":
        table = file_mesh(geometry, folder, packages)
    elif geometry.kind == "box":
        table = {"kind": "box", "size": geometry.numbers.tolist()}
    elif geometry.kind == "cylinder":
        table = {"kind": "cylinder", "radius": float(geometry.numbers[0]), "length": float(geometry.numbers[1])}
    else:
        table = {"kind": "sphere", "radius": float(geometry.numbers[0])}
    return None if table is None else table | pose.keys("offset")


def reach(geometry: Geometry) -> float:
    """How far the geometry goes from its frame's origin [m]; of a file, which is not looked into, nothing."""
    if geometry.kind == "box":
        return float(np.linalg.norm(geometry.numbers) / 2)
    return 0.0 if geometry.kind == "mesh" else float(geometry.numbers[0] + geometry.numbers[1:].sum() / 2)
