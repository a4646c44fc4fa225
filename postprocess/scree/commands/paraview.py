from __future__ import annotations

import argparse
import json
import pathlib

from scree.commands.arguments import add_folder
from scree.errors import ScreeError
from scree.paraview.parts import bundle
from scree.run import open_run


def describe(parser: argparse.ArgumentParser) -> None:
    add_folder(parser)
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FILE", help="a .py; default RESULT_DIR/view.py")


def run(arguments: argparse.Namespace) -> int:
    """A script that shows the run in ParaView: File > Load State, or pvbatch for a picture

    `paraview --script=RESULT_DIR/view.py` starts ParaView with it, `pvbatch RESULT_DIR/view.py -o picture.png` draws a
    picture. The script contains the deck and names the folder of the results; it needs ParaView 5.11 or newer.
    """
    opened = open_run(arguments.folder)
    if not len(opened.snapshots):
        raise ScreeError(f"{arguments.folder}: holds no snapshots")
    path = arguments.output or arguments.folder / "view.py"
    if path.suffix != ".py":
        raise ScreeError(f"{path}: must end in .py")
    try:
        deck = json.dumps(opened.deck)
    except ScreeError:  # without a record or a checkpoint: no walls, joints and names
        deck = None
    path.write_text(bundle(str(arguments.folder.resolve()), deck), encoding="utf-8")
    print(path)
    return 0
