from __future__ import annotations

import argparse
import os
import pathlib
import sys
import warnings

from scree.cli import add_folder
from scree.errors import ScreeWarning
from scree.run import open_run


def describe(parser: argparse.ArgumentParser) -> None:
    add_folder(parser)
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FOLDER", help="default RESULT_DIR/settled")
    parser.add_argument("--time", type=float, metavar="TIME",
                        help="of the snapshot [s], the nearest; default: the last")


def run(words: argparse.Namespace) -> int:
    """The particles of a state as files and tables with which another deck begins

    Writes FOLDER/settled_MATERIAL.h5 with positions, velocities, spins, radii and masses, and FOLDER/particles.toml
    with the [[particles]] that read them, to be copied into a deck in FOLDER. Springs of contacts begin anew.
    """
    from scree.deck import Deck
    from scree.packing import settled

    opened = open_run(words.folder)
    folder = words.output or words.folder / "settled"
    number = -1 if words.time is None else opened.snapshots.at(words.time).number
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always", ScreeWarning)
        tables = settled(opened, folder, number)
    for each in said:
        print(f"warning: {each.message}", file=sys.stderr)
    for table in tables:
        table["file"] = os.path.relpath(table["file"], folder)
    path = folder / "particles.toml"
    path.write_text(str(Deck(particles=tables)), encoding="utf-8")
    print(path)
    return 0
