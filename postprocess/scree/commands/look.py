"""The options of pictures, for every command that draws some."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from scree.pictures.render import Look


def share(text: str) -> float:
    value = float(text)
    if not 0 <= value <= 1:
        raise argparse.ArgumentTypeError(f"{text} is not from 0 to 1")
    return value


def positive(text: str) -> float:
    value = float(text)
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return value


def count(text: str) -> int:
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return value


def add_look(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--view", type=float, nargs=4, metavar=("XMIN", "XMAX", "YMIN", "YMAX"),
                        help="part of the plane to show, 2D only [m]; default: all but stray particles")
    parser.add_argument("--axes", action="store_true", help="coordinates in place of a scale bar, 2D only")
    parser.add_argument("--surfaces", metavar="FIELD",
                        help="colour meshes by one of the run's output.surface_fields, such as wear_depth; 3D only, "
                             "with VTK")
    parser.add_argument("--opacity", type=share, metavar="SHARE",
                        help="of meshes on bodies, 3D with VTK only: from 0 to 1, where nothing shows through; "
                             "default: 0.1 of drums, pipes and meshes from files, else 1")
    parser.add_argument("--color", metavar="FIELD",
                        help="of the particles, such as group, material, radius or force, of a vector its length; "
                             "default: their speed")
    parser.add_argument("--fastest", type=positive, metavar="SPEED",
                        help="upper end of the colour scale [m/s]; default: of the fastest particles in the pictures")
    parser.add_argument("--no-vtk", action="store_true", help="draw spheres without VTK, as shaded discs")


def add_frames(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--frames", type=count, default=200, help="largest number of frames (default 200)")


def chosen_look(words: argparse.Namespace) -> Look:
    from scree.pictures.render import Look

    chosen = {"color": words.color} if words.color else {}
    return Look(**chosen, view=words.view, axes=words.axes, opacity=words.opacity, fastest=words.fastest,
                surfaces=words.surfaces, with_vtk=not words.no_vtk)
