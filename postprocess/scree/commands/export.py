from __future__ import annotations

import argparse
import pathlib
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from scree.cli import add_folder
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
                        help="the snapshots nearest to these times [s]; default: all")
    parser.add_argument("--kinds", choices=KINDS, nargs="+", default=KINDS, help="default: all that there are")


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
    """Spheres in place of points; None where no point has a size, as centres of mass. Throws MissingError where the
    radius is no field."""
    import pyvista

    if not (points["radius"].values > 0).any():
        return None
    mesh = points.to_pyvista()
    sized = mesh.extract_points(mesh["radius"] > 0, include_cells=False)
    ball = pyvista.Sphere(radius=1.0, theta_resolution=16, phi_resolution=12)
    return sized.glyph(scale="radius", orient=False, factor=1.0, geom=ball)


def save_mesh(points: Points, path: pathlib.Path) -> bool:
    """Particles and shapes are points in VTK's files, which can have fields, and balls in PLY and STL, which cannot,
    and have no lines. Returns whether there was something to write."""
    alone = path.suffix in (".ply", ".stl")
    if alone and len(points.lines):
        return False
    mesh = balls_of(points) if alone and not len(points.triangles) else points.to_pyvista()
    if mesh is None:
        return False
    (mesh.cast_to_unstructured_grid() if path.suffix == ".vtu" else mesh).save(path)
    return True


def save_collection(names: list[tuple[float, str]], path: pathlib.Path) -> None:
    """A .pvd: the files of a series with their times [s]."""
    rows = "".join(f'    <DataSet timestep="{time!r}" file="{name}"/>\n' for time, name in names)
    path.write_text('<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n  <Collection>\n'
                    f"{rows}  </Collection>\n</VTKFile>\n", encoding="utf-8")


def save_kind(opened: Run, kind: str, snapshots: Sequence[int], folder: pathlib.Path, format: str) -> bool:
    """A file for each snapshot. Returns whether there is one. Throws MissingError for a field that it needs."""
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


def run(words: argparse.Namespace) -> int:
    """History and snapshots as CSV, snapshots for VTK, Blender and CAD programs

    csv: history.csv and a table per snapshot, with units in the headers. vtp, vtu: a file of VTK per snapshot, and a
    .pvd with their times. ply, stl: meshes alone, particles as balls of their size, no lines. Files are named after
    kind and number of the snapshot: particles_0012.csv.
    """
    opened = open_run(words.folder)
    folder = words.output or words.folder / "export"
    folder.mkdir(parents=True, exist_ok=True)
    snapshots = chosen_snapshots(opened, words.times)
    has_history = words.format == "csv" and opened.history.rows > 0
    if has_history:
        save_history(opened, folder / "history.csv")
    elif not snapshots:
        raise ScreeError(f"{words.folder}: holds no snapshots")
    left_out, written = [], False
    for kind in (kind for kind in words.kinds if opened.series(kind)):
        try:
            written = save_kind(opened, kind, snapshots, folder, words.format) or written
        except MissingError as error:
            left_out.append(f"{kind}.{words.format}: left out: {error}")
    for line in left_out:
        print(f"warning: {line}", file=sys.stderr)
    if not written and not has_history:
        raise ScreeError(f"{words.folder}: nothing of its snapshots can be written as {words.format}: "
                         f"{'fields are missing' if left_out else 'there are no meshes and no balls'}")
    print(folder)
    return 0
