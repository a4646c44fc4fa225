from __future__ import annotations

import argparse
import pathlib

from scree.commands.arguments import add_folder
from scree.commands.picture_options import add_picture_options, picture_options
from scree.run import open_run


def describe(parser: argparse.ArgumentParser) -> None:
    add_folder(parser)
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FILE", help="default RESULT_DIR/report.html")
    add_picture_options(parser)


def run(arguments: argparse.Namespace) -> int:
    """One HTML page of the run: record, warnings, last state, energies, forces, timing, deck

    The file is self-contained.
    """
    from scree.report import page

    opened = open_run(arguments.folder)
    path = arguments.output or arguments.folder / "report.html"
    path.write_text(page(opened, picture_options(arguments)), encoding="utf-8")
    print(path)
    return 0
