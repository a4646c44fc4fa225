"""Draws what a run left in its folder, without a display.

    postprocess/draw RESULT_DIR [options]

Writes RESULT_DIR/final.png, RESULT_DIR/animation.mp4 (.gif where there is no ffmpeg) and RESULT_DIR/history.png,
the energies over time. Particles are drawn to scale and coloured by their speed, bodies in orange, with walls,
joints, springs and, where springs have actuators, cylinders: discs in 2D, lit spheres in 3D. Meshes are see-through,
with their sharp edges. Bodies without shapes are seen where output.history_bodies names them.
"""

import argparse
import pathlib

from results import fail


def share(text):
    value = float(text)
    if not 0 <= value <= 1:
        raise argparse.ArgumentTypeError(f"{text} is not from 0 to 1")
    return value


def speed(text):
    value = float(text)
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return value


def arguments():
    parser = argparse.ArgumentParser(
        prog="postprocess/draw", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("result_directory", type=pathlib.Path, metavar="RESULT_DIR")
    parser.add_argument("--only", choices=["pictures", "history"], help="draw no more than these")
    parser.add_argument("--frames", type=int, default=200, help="largest number of frames (default 200)")
    parser.add_argument(
        "--view",
        type=float,
        nargs=4,
        metavar=("XMIN", "XMAX", "YMIN", "YMAX"),
        help="part of the plane to show, 2D only [m]; default: all but stray particles",
    )
    parser.add_argument(
        "--surfaces",
        metavar="FIELD",
        help="colour meshes by one of the run's output.surface_fields, such as wear_depth; 3D only, with VTK",
    )
    parser.add_argument(
        "--opacity",
        type=share,
        default=0.18,
        metavar="SHARE",
        help="of meshes on bodies, 3D with VTK only: from 0 to 1, where nothing shows through (default 0.18)",
    )
    parser.add_argument(
        "--fastest",
        type=speed,
        metavar="SPEED",
        help="upper end of the colour scale [m/s]; default: of the fastest particles in the pictures",
    )
    parser.add_argument("--no-animation", action="store_true")
    parser.add_argument("--no-vtk", action="store_true", help="draw spheres without VTK, as shaded discs")
    parser.add_argument(
        "--columns",
        nargs="+",
        default=[],
        metavar="GROUP/NAME",
        help="columns of the history to plot below the energies, a panel per unit",
    )
    parser.add_argument(
        "--list", action="store_true", help="print the history's columns with unit and description, draw nothing"
    )
    return parser.parse_args()


def main():
    chosen = arguments()
    directory = chosen.result_directory
    if not directory.is_dir():
        fail(f"{directory}: no such folder")
    # Each of the two takes a second to load.
    if chosen.only != "pictures" or chosen.list:
        from plot_history import list_columns, plot_run

        if chosen.list:
            return list_columns(directory)
        print(plot_run(directory, chosen.columns))
    if chosen.only != "history":
        from render import Look, draw_run

        look = Look(chosen.view, chosen.opacity, chosen.fastest, chosen.surfaces)
        frames = 1 if chosen.no_animation else chosen.frames
        for path in draw_run(directory, frames, not chosen.no_vtk, look):
            print(path, flush=True)


if __name__ == "__main__":
    main()
