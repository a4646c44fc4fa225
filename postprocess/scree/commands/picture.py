from __future__ import annotations

import argparse
import pathlib

import numpy as np

from scree.commands.arguments import add_folder, count
from scree.commands.picture_options import add_picture_options, picture_options
from scree.errors import ScreeError
from scree.run import open_run


def describe(parser: argparse.ArgumentParser) -> None:
    add_folder(parser)
    parser.add_argument("--time", type=float, metavar="TIME",
                        help="time of the snapshot [s], the nearest is taken; default: the last")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FILE",
                        help="a .png, .jpg, .pdf or .svg; default RESULT_DIR/picture.png")
    parser.add_argument("--colors", type=palette, default=0, metavar="COUNT",
                        help="number of colours of a .png, up to 256, for a smaller file; default: all")
    parser.add_argument("--width", type=count, metavar="PIXELS",
                        help="width of the picture; default: from its height and shape")
    add_picture_options(parser)


def palette(text: str) -> int:
    value = count(text)
    if value > 256:
        raise argparse.ArgumentTypeError("must be at most 256")
    return value


def run(arguments: argparse.Namespace) -> int:
    """One state of the run

    The pictures are those of `scree-post draw`.
    """
    from scree.pictures.render import DrawnRun, make_picture, save_picture

    drawn, options = DrawnRun(open_run(arguments.folder)), picture_options(arguments)
    times = drawn.particles.times
    snapshot = len(times) - 1 if arguments.time is None else int(np.abs(times - arguments.time).argmin())
    path = arguments.output or arguments.folder / "picture.png"
    options.fit(drawn, [snapshot])
    try:
        save_picture(make_picture(drawn, [snapshot], options, fine=True), snapshot, path, arguments.colors,
                     arguments.width)
    except ValueError as error:  # unknown suffix
        raise ScreeError(f"{path}: {error}") from error
    print(path)
    return 0
