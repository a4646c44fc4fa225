from __future__ import annotations

import argparse
import pathlib
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from scree.commands.arguments import add_folder
from scree.errors import MissingError, ScreeError
from scree.run import Run, open_run
from scree.snapshots import KINDS, Points

if TYPE_CHECKING:
    import pyvista

MESHES = ("vtp", "vtu", "ply", "stl")


def describe(parser: argparse.ArgumentParser) -> None:
    add_folder(parser)
    parser.add_argument("--format", choices=("csv", *MESHES), default="csv")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FOLDER", help="default RESULT_DIR/export")
    parser.add_argument("--times", type=float, nargs="+", metavar="TIME",
                        help="export the snapshots nearest to these times [s]; default: all")
    parser.add_argument("--kinds", choices=KINDS, nargs="+", default=KINDS, help="kinds to export; default: all")


def chosen_snapshots(opened: Run, times: Sequence[float] | None) -> list[int]:
    if times is None:
        return list(range(len(opened.snapshots)))
    return sorted({opened.snapshots.at(time).number for time in times})


def header(column: str, unit: str) -> str:
    return column if unit == "1" else f"{column} [{unit}]"


def save_csv(points: Points, path: pathlib.Path) -> bool:
    frame = points.to_dataframe()
    frame.to_csv(path, index=False, header=[header(name, unit) for name, unit in frame.attrs["units"].items()])
    return True


def save_history(opened: Run, path: pathlib.Path) -> None:
    frame = opened.to_dataframe()
    frame.to_csv(path, header=[header(name, unit) for name, unit in frame.attrs["units"].items()])


def balls_of(points: Points) -> pyvista.PolyData | None:
    """Spheres instead of points; None if all radii are 0, as those of centres of mass. Throws MissingError if the
    snapshot has no radius."""
    import pyvista

    if not (points["radius"].values > 0).any():
        return None
    mesh = points.to_pyvista()
    sized = mesh.extract_points(mesh["radius"] > 0, include_cells=False)
    ball = pyvista.Sphere(radius=1.0, theta_resolution=16, phi_resolution=12)
    return sized.glyph(scale="radius", orient=False, factor=1.0, geom=ball)


def save_mesh(points: Points, path: pathlib.Path) -> bool:
    """Particles and shapes are points with fields in VTK files, and spheres in PLY and STL files, which have neither
    fields nor lines. Returns whether a file was written."""
    geometry_only = path.suffix in (".ply", ".stl")
    if geometry_only and len(points.lines):
        return False
    mesh = balls_of(points) if geometry_only and not len(points.triangles) else points.to_pyvista()
    if mesh is None:
        return False
    (mesh.cast_to_unstructured_grid() if path.suffix == ".vtu" else mesh).save(path)
    return True


def save_collection(names: list[tuple[float, str]], path: pathlib.Path) -> None:
    """Writes a .pvd, which lists the files of a series with their times [s]."""
    rows = "".join(f'    <DataSet timestep="{time!r}" file="{name}"/>\n' for time, name in names)
    path.write_text('<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n  <Collection>\n'
                    f"{rows}  </Collection>\n</VTKFile>\n", encoding="utf-8")


def save_kind(opened: Run, kind: str, snapshots: Sequence[int], folder: pathlib.Path, format: str) -> bool:
    """Writes one file per snapshot. Returns whether a file was written. Throws MissingError for a missing field."""
    save = save_csv if format == "csv" else save_mesh
    names = []
    for number in snapshots:
        snapshot = opened.snapshots[number]
        points, path = getattr(snapshot, kind), folder / f"{kind}_{number:04}.{format}"
        if points.count > 0 and save(points, path):
            names.append((snapshot.time, path.name))
    if format in ("vtp", "vtu") and names:
        save_collection(names, folder / f"{kind}.pvd")
    return bool(names)


def run(arguments: argparse.Namespace) -> int:
    """History and snapshots as CSV, snapshots for VTK, Blender and CAD programs

    csv: history.csv and a table per snapshot, with units in the headers. vtp, vtu: a VTK file per snapshot, and a .pvd
    with their times. ply, stl: geometry only, particles as spheres of true size, no lines. File names have the kind and
    the number of the snapshot: particles_0012.csv.
    """
    opened = open_run(arguments.folder)
    folder = arguments.output or arguments.folder / "export"
    folder.mkdir(parents=True, exist_ok=True)
    snapshots = chosen_snapshots(opened, arguments.times)
    has_history = arguments.format == "csv" and opened.history.rows > 0
    if has_history:
        save_history(opened, folder / "history.csv")
    elif not snapshots:
        raise ScreeError(f"{arguments.folder}: holds no snapshots")
    left_out, written = [], False
    for kind in (kind for kind in arguments.kinds if opened.series(kind)):
        try:
            written = save_kind(opened, kind, snapshots, folder, arguments.format) or written
        except MissingError as error:
            left_out.append(f"{kind}.{arguments.format}: left out: {error}")
    for line in left_out:
        print(f"warning: {line}", file=sys.stderr)
    if not written and not has_history:
        raise ScreeError(f"{arguments.folder}: no snapshot can be written as {arguments.format}: "
                         f"{'fields are missing' if left_out else 'there are neither meshes nor spheres'}")
    print(folder)
    return 0
