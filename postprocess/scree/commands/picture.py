from __future__ import annotations

import argparse
import pathlib

import numpy as np

from scree.cli import add_folder
from scree.commands.look import add_look, chosen_look
from scree.errors import ScreeError
from scree.run import open_run


def describe(parser: argparse.ArgumentParser) -> None:
    add_folder(parser)
    parser.add_argument("--time", type=float, metavar="TIME",
                        help="of the snapshot [s], the nearest; default: the last")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FILE",
                        help="a .png, .jpg, .pdf or .svg; default RESULT_DIR/picture.png")
    add_look(parser)


def run(words: argparse.Namespace) -> int:
    """One state of the run

    The pictures are those of `scree-post draw`.
    """
    from scree.pictures.render import DrawnRun, make_picture, save_picture

    drawn, look = DrawnRun(open_run(words.folder)), chosen_look(words)
    times = drawn.particles.times
    snapshot = len(times) - 1 if words.time is None else int(np.abs(times - words.time).argmin())
    path = words.output or words.folder / "picture.png"
    look.fit(drawn, [snapshot])
    try:
        save_picture(make_picture(drawn, [snapshot], look, fine=True), snapshot, path)
    except ValueError as error:  # of a suffix that it does not know
        raise ScreeError(f"{path}: {error}") from error
    print(path)
    return 0
