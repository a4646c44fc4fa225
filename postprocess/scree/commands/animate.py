from __future__ import annotations

import argparse
import pathlib

from scree.cli import add_folder
from scree.commands.look import add_frames, add_look, chosen_look, count
from scree.errors import ScreeError
from scree.run import open_run


def describe(parser: argparse.ArgumentParser) -> None:
    add_folder(parser)
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FILE",
                        help="a .mp4 (needs ffmpeg), .webp or .gif; default RESULT_DIR/film.mp4, .gif without "
                             "ffmpeg")
    parser.add_argument("--from", type=float, dest="begin", default=-float("inf"), metavar="TIME",
                        help="first snapshot [s]")
    parser.add_argument("--to", type=float, dest="end", default=float("inf"), metavar="TIME", help="last snapshot [s]")
    parser.add_argument("--rate", type=count, default=25, metavar="FRAMES", help="frames per second (default 25)")
    parser.add_argument("--width", type=count, metavar="PIXELS", help="of the film; default: that of the pictures")
    parser.add_argument("--quality", type=quality, default=80, metavar="NUMBER",
                        help="of a .webp, from 1, the smallest file, to 100 (default 80)")
    add_frames(parser)
    add_look(parser)


def quality(text: str) -> int:
    value = count(text)
    if value > 100:
        raise argparse.ArgumentTypeError(f"{text} is not from 1 to 100")
    return value


def run(words: argparse.Namespace) -> int:
    """A film of the run's snapshots

    The pictures are those of `scree-post draw`.
    """
    from scree.pictures.render import (FILM_FORMATS, DrawnRun, chosen_frames, has_ffmpeg, make_picture,
                                               save_animation)

    path = words.output or words.folder / ("film.mp4" if has_ffmpeg() else "film.gif")
    if path.suffix[1:] not in FILM_FORMATS:
        raise ScreeError(f"{path}: must end in .{', .'.join(FILM_FORMATS[:-1])} or .{FILM_FORMATS[-1]}")
    drawn, look = DrawnRun(open_run(words.folder)), chosen_look(words)
    within = [k for k, time in enumerate(drawn.particles.times) if words.begin <= time <= words.end]
    if not within:
        raise ScreeError(f"{words.folder}: no snapshot from {words.begin:g} to {words.end:g} s; they go from "
                         f"{drawn.particles.times[0]:g} to {drawn.particles.times[-1]:g} s")
    frames = [within[k] for k in chosen_frames(len(within), words.frames)]
    look.fit(drawn, frames)
    save_animation(make_picture(drawn, frames, look), frames, path, words.rate, words.width,
                   words.quality)
    print(path)
    return 0
