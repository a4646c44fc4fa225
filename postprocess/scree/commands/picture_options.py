"""Options of all commands that draw pictures."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from scree.commands.arguments import fraction, positive

if TYPE_CHECKING:
    from scree.pictures.render import PictureOptions


def add_picture_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--view", type=float, nargs=4, metavar=("XMIN", "XMAX", "YMIN", "YMAX"),
                        help="part of the plane to show, 2D only [m]; default: everything but stray particles")
    parser.add_argument("--axes", action="store_true", help="coordinates instead of a scale bar, 2D only")
    parser.add_argument("--surfaces", metavar="FIELD",
                        help="colour meshes by one of the run's output.surface_fields, such as wear_depth; 3D only, "
                             "with VTK")
    parser.add_argument("--opacity", type=fraction, metavar="FRACTION",
                        help="opacity of meshes on bodies from 0 to 1, 3D with VTK only; default: 0.1 for drums, "
                             "pipes and meshes from files, else 1")
    parser.add_argument("--color", metavar="FIELD",
                        help="field that colours the particles, such as group, material, radius or force (the "
                             "magnitude of a vector); default: their speed")
    parser.add_argument("--fastest", type=positive, metavar="SPEED",
                        help="upper end of the speed scale [m/s]; default: speed of the fastest particles shown")
    parser.add_argument("--no-vtk", action="store_true", help="draw spheres without VTK, as shaded discs")


def picture_options(arguments: argparse.Namespace) -> PictureOptions:
    from scree.pictures.render import PictureOptions

    chosen = {"color": arguments.color} if arguments.color else {}
    return PictureOptions(**chosen, view=arguments.view, axes=arguments.axes, opacity=arguments.opacity,
                          fastest=arguments.fastest, surfaces=arguments.surfaces, with_vtk=not arguments.no_vtk)
