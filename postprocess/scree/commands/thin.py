from __future__ import annotations

import argparse
import pathlib

from scree.commands.arguments import add_folder, add_span, count, snapshots_in_span
from scree.errors import ScreeError
from scree.run import open_run


def describe(parser: argparse.ArgumentParser) -> None:
    add_folder(parser)
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FOLDER", help="default RESULT_DIR/thin")
    add_span(parser)
    parser.add_argument("--all-sides", action="store_true",
                        help="keep the particles that are seen from above, below and each side, too")
    parser.add_argument("--at-once", type=count, default=1, metavar="SNAPSHOTS",
                        help="number of snapshots at once, each on a core with its own memory (default 1)")


def run(arguments: argparse.Namespace) -> int:
    """Results of a few percent of the size, which look alike, for pictures on another machine

    Writes a folder of results that all other commands read. Of the particles it has those that are visible from the
    side of the pictures, whatever bodies hide; positions are rounded to 1/64 of the smallest radius, other fields to
    1/512 of their largest values. Bodies, meshes, links, history and record are the same; contacts are left out.
    """
    from scree.thinning import thin

    opened = open_run(arguments.folder, earlier=False)
    folder = arguments.output or arguments.folder / "thin"
    if folder.resolve() == opened.folder:
        raise ScreeError(f"{folder}: holds the results themselves; choose another folder")
    thin(opened, folder, snapshots_in_span(arguments, opened.snapshots.times), arguments.all_sides, arguments.at_once)
    print(folder)
    return 0
