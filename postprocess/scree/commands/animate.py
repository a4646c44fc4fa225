from __future__ import annotations

import argparse
import pathlib

from scree.commands.arguments import add_folder, add_frames, add_span, count, snapshots_in_span
from scree.commands.picture_options import add_picture_options, picture_options
from scree.errors import ScreeError
from scree.run import open_run


def describe(parser: argparse.ArgumentParser) -> None:
    add_folder(parser)
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FILE",
                        help="a .mp4 (needs ffmpeg), .webp or .gif; default RESULT_DIR/film.mp4, without ffmpeg "
                             "film.gif")
    add_span(parser)
    parser.add_argument("--rate", type=count, default=25, metavar="FRAMES", help="frames per second (default 25)")
    parser.add_argument("--width", type=count, metavar="PIXELS", help="width of the film; default: as pictures")
    parser.add_argument("--quality", type=quality, default=80, metavar="NUMBER",
                        help="quality of a .webp, from 1 (smallest file) to 100 (default 80)")
    add_frames(parser)
    add_picture_options(parser)


def quality(text: str) -> int:
    value = count(text)
    if value > 100:
        raise argparse.ArgumentTypeError(f"{text} is not from 1 to 100")
    return value


def run(arguments: argparse.Namespace) -> int:
    """A film of the snapshots of the run

    The pictures are those of `scree-post draw`.
    """
    from scree.pictures.render import (FILM_FORMATS, DrawnRun, chosen_frames, has_ffmpeg, make_picture,
                                       save_animation)

    path = arguments.output or arguments.folder / ("film.mp4" if has_ffmpeg() else "film.gif")
    if path.suffix[1:] not in FILM_FORMATS:
        raise ScreeError(f"{path}: must end in .{', .'.join(FILM_FORMATS[:-1])} or .{FILM_FORMATS[-1]}")
    drawn, options = DrawnRun(open_run(arguments.folder)), picture_options(arguments)
    within = snapshots_in_span(arguments, drawn.particles.times)
    frames = [within[k] for k in chosen_frames(len(within), arguments.frames)]
    options.fit(drawn, frames)
    save_animation(make_picture(drawn, frames, options), frames, path, arguments.rate, arguments.width,
                   arguments.quality)
    print(path)
    return 0
