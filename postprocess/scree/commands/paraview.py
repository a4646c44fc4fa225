from __future__ import annotations

import argparse
import json
import pathlib

from scree.cli import add_folder
from scree.errors import ScreeError
from scree.paraview.parts import bundle
from scree.run import open_run


def describe(parser: argparse.ArgumentParser) -> None:
    add_folder(parser)
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FILE", help="a .py; default RESULT_DIR/view.py")


def run(words: argparse.Namespace) -> int:
    """A file that shows the run in ParaView: File > Load State, or pvbatch for a picture

    `paraview --script=RESULT_DIR/view.py` starts with it, `pvbatch RESULT_DIR/view.py -o picture.png` draws a picture.
    The file needs ParaView 5.11 or newer and the results, whose folder it names, and nothing else: the deck is in it.
    """
    opened = open_run(words.folder)
    if not len(opened.snapshots):
        raise ScreeError(f"{words.folder}: holds no snapshots")
    path = words.output or words.folder / "view.py"
    if path.suffix != ".py":
        raise ScreeError(f"{path}: must end in .py")
    try:
        deck = json.dumps(opened.deck)
    except ScreeError:  # neither a record nor a checkpoint is there yet: without walls, joints and names
        deck = None
    path.write_text(bundle(str(words.folder.resolve()), deck), encoding="utf-8")
    print(path)
    return 0
