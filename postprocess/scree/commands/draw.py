from __future__ import annotations

import argparse

from scree.commands import plot
from scree.commands.arguments import add_folder, add_frames
from scree.commands.picture_options import add_picture_options, picture_options
from scree.run import open_run


def describe(parser: argparse.ArgumentParser) -> None:
    add_folder(parser)
    parser.add_argument("--only", choices=["pictures", "history"], help="draw only these")
    parser.add_argument("--no-animation", action="store_true")
    add_frames(parser)
    add_picture_options(parser)
    plot.add_columns(parser)


def run(arguments: argparse.Namespace) -> int:
    """The last state, an animation of the run and its energies over time

    Writes RESULT_DIR/final.png, RESULT_DIR/animation.mp4 (.gif without ffmpeg) and RESULT_DIR/energies.png. Files of
    other commands remain.
    Particles are drawn to scale, as discs in 2D and lit spheres in 3D, and coloured by their speed; bodies are orange.
    Walls, joints and springs are drawn, too; springs with actuators as cylinders. Drums, pipes and meshes from files
    are semi-transparent.
    """
    opened = open_run(arguments.folder)
    if arguments.list:
        return plot.print_columns(opened)
    has_history = opened.history.rows > 0 or arguments.only == "history" or arguments.columns
    if arguments.only != "pictures" and has_history:
        print(plot.save(opened, arguments.columns, True, arguments.folder / "energies.png"))
    if arguments.only == "history":
        return 0

    from scree.pictures.render import (DrawnRun, chosen_frames, has_ffmpeg, make_picture, save_animation,
                                       save_picture)

    drawn, options = DrawnRun(opened), picture_options(arguments)
    last = len(drawn.particles) - 1
    frames = chosen_frames(len(drawn.particles), 1 if arguments.no_animation else arguments.frames)
    options.fit(drawn, [*frames, last])
    save_picture(make_picture(drawn, [last], options, fine=True), last, arguments.folder / "final.png")
    print(arguments.folder / "final.png", flush=True)
    if len(frames) > 1:
        path = arguments.folder / ("animation.mp4" if has_ffmpeg() else "animation.gif")
        save_animation(make_picture(drawn, frames, options), frames, path)
        print(path)
    return 0
