from __future__ import annotations

import argparse
import pathlib

from scree.cli import add_folder
from scree.commands.look import add_look, chosen_look
from scree.run import open_run


def describe(parser: argparse.ArgumentParser) -> None:
    add_folder(parser)
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FILE", help="default RESULT_DIR/report.html")
    add_look(parser)


def run(words: argparse.Namespace) -> int:
    """One HTML page of the run: record, warnings, last state, energies, forces, timing, deck

    Everything is in the one file, so that it can be sent.
    """
    from scree.report import page

    opened = open_run(words.folder)
    path = words.output or words.folder / "report.html"
    path.write_text(page(opened, chosen_look(words)), encoding="utf-8")
    print(path)
    return 0
