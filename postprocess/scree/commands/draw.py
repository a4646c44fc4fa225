from __future__ import annotations

import argparse

from scree.cli import add_folder
from scree.commands import plot
from scree.commands.look import add_frames, add_look, chosen_look
from scree.run import open_run


def describe(parser: argparse.ArgumentParser) -> None:
    add_folder(parser)
    parser.add_argument("--only", choices=["pictures", "history"], help="draw no more than these")
    parser.add_argument("--no-animation", action="store_true")
    add_frames(parser)
    add_look(parser)
    plot.add_columns(parser)


def run(words: argparse.Namespace) -> int:
    """The last state, an animation of the run and its energies over time

    Writes RESULT_DIR/final.png, RESULT_DIR/animation.mp4 (.gif where there is no ffmpeg) and RESULT_DIR/energies.png,
    and leaves what the other commands have written.
    Particles are drawn to scale and coloured by their speed, bodies in orange, with walls, joints, springs and, where
    springs have actuators, cylinders: discs in 2D, lit spheres in 3D. One looks through drums, pipes and meshes from
    files.
    """
    opened = open_run(words.folder)
    if words.list:
        return plot.print_columns(opened)
    has_history = opened.history.rows > 0 or words.only == "history" or words.columns
    if words.only != "pictures" and has_history:
        print(plot.save(opened, words.columns, True, words.folder / "energies.png"))
    if words.only == "history":
        return 0

    from scree.pictures.render import (DrawnRun, chosen_frames, has_ffmpeg, make_picture, save_animation,
                                       save_picture)

    drawn, look = DrawnRun(opened), chosen_look(words)
    last = len(drawn.particles) - 1
    frames = chosen_frames(len(drawn.particles), 1 if words.no_animation else words.frames)
    look.fit(drawn, [*frames, last])
    save_picture(make_picture(drawn, [last], look, fine=True), last, words.folder / "final.png")
    print(words.folder / "final.png", flush=True)
    if len(frames) > 1:
        path = words.folder / ("animation.mp4" if has_ffmpeg() else "animation.gif")
        save_animation(make_picture(drawn, frames, look), frames, path)
        print(path)
    return 0
