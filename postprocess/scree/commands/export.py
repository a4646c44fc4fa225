from __future__ import annotations

import argparse
import pathlib
from collections.abc import Sequence

from scree.cli import add_folder
from scree.errors import ScreeError
from scree.run import Run, open_run
from scree.snapshots import KINDS, Points

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


def save_csv(points: Points, path: pathlib.Path) -> None:
    frame = points.to_dataframe()
    frame.to_csv(path, index=False, header=[header(name, unit) for name, unit in frame.attrs["units"].items()])


def save_history(opened: Run, path: pathlib.Path) -> None:
    frame = opened.to_dataframe()
    frame.to_csv(path, header=[header(name, unit) for name, unit in frame.attrs["units"].items()])


def save_mesh(points: Points, path: pathlib.Path) -> None:
    """Particles and shapes are points in VTK's files, which can have fields, and balls in PLY and STL, which cannot."""
    import pyvista

    mesh = points.to_pyvista()
    if path.suffix in (".ply", ".stl") and not len(points.triangles):
        ball = pyvista.Sphere(radius=1.0, theta_resolution=16, phi_resolution=12)
        sized = mesh.extract_points(mesh["radius"] > 0, include_cells=False)  # centres of mass are points
        mesh = sized.glyph(scale="radius", orient=False, factor=1.0, geom=ball)
    if path.suffix == ".vtu":
        mesh = mesh.cast_to_unstructured_grid()
    mesh.save(path)


def save_collection(names: list[tuple[float, str]], path: pathlib.Path) -> None:
    """A .pvd: the files of a series with their times [s]."""
    rows = "".join(f'    <DataSet timestep="{time!r}" file="{name}"/>\n' for time, name in names)
    path.write_text('<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n  <Collection>\n'
                    f"{rows}  </Collection>\n</VTKFile>\n")


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
    if words.format == "csv" and opened.history.rows:
        save_history(opened, folder / "history.csv")
    elif not snapshots:
        raise ScreeError(f"{words.folder}: holds no snapshots")
    save = save_csv if words.format == "csv" else save_mesh
    for kind in (kind for kind in words.kinds if opened.series(kind)):
        names = []
        for number in snapshots:
            snapshot = opened.snapshots[number]
            points = getattr(snapshot, kind)
            if points.count == 0 or (len(points.lines) and words.format in ("ply", "stl")):
                continue
            path = folder / f"{kind}_{number:04}.{words.format}"
            save(points, path)
            names.append((snapshot.time, path.name))
        if words.format in ("vtp", "vtu") and names:
            save_collection(names, folder / f"{kind}.pvd")
    print(folder)
    return 0
