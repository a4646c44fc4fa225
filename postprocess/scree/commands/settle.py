from __future__ import annotations

import argparse
import os
import pathlib
import sys
import warnings

from scree.commands.arguments import add_folder
from scree.errors import ScreeWarning
from scree.run import open_run


def describe(parser: argparse.ArgumentParser) -> None:
    add_folder(parser)
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FOLDER", help="default RESULT_DIR/settled")
    parser.add_argument("--time", type=float, metavar="TIME",
                        help="time of the snapshot [s], the nearest is taken; default: the last")


def run(arguments: argparse.Namespace) -> int:
    """The particles of a state as files and tables for the start of another deck

    Writes FOLDER/settled_MATERIAL.h5 with positions, velocities, spins, radii and masses, and FOLDER/particles.toml
    with the [[particles]] that read them; copy these into a deck in FOLDER. The contact history is not transferred.
    """
    from scree.deck import Deck
    from scree.packing import settled

    opened = open_run(arguments.folder)
    folder = arguments.output or arguments.folder / "settled"
    number = -1 if arguments.time is None else opened.snapshots.at(arguments.time).number
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always", ScreeWarning)
        tables = settled(opened, folder, number)
    for each in warned:
        print(f"warning: {each.message}", file=sys.stderr)
    for table in tables:
        table["file"] = os.path.relpath(table["file"], folder)
    path = folder / "particles.toml"
    path.write_text(str(Deck(particles=tables)), encoding="utf-8")
    print(path)
    return 0
