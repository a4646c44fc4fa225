from __future__ import annotations

import argparse
import pathlib
from collections.abc import Sequence

from scree.commands.arguments import add_folder
from scree.errors import ScreeError
from scree.history import TIME
from scree.run import Run, open_run


def add_columns(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--columns", nargs="+", default=[], metavar="GROUP/NAME",
                        help="columns of the history to plot below the energies, one panel per group and unit; * "
                             "matches any text, as in 'reactions/*/fx'")
    parser.add_argument("--list", action="store_true",
                        help="print the columns of the history with unit and description; draw nothing")


def describe(parser: argparse.ArgumentParser) -> None:
    add_folder(parser)
    add_columns(parser)
    parser.add_argument("--no-energies", action="store_true", help="plot only the columns")
    parser.add_argument("--x", default=TIME, metavar="GROUP/NAME",
                        help="column on the horizontal axis, as in --x bodies/piston/x; default: time")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FILE",
                        help="a .png, .pdf or .svg; default RESULT_DIR/history.png")


def print_columns(opened: Run) -> int:
    for name, column in opened.history.items():
        print(f"{name} [{column.unit}]: {column.description}")
    return 0


def save(opened: Run, columns: Sequence[str], energies: bool, path: pathlib.Path, x: str = TIME) -> pathlib.Path:
    import matplotlib.pyplot as plt

    from scree.plots import history_figure

    figure = history_figure(opened.history, opened.title, columns, energies, x)
    try:
        figure.savefig(path)
    except ValueError as error:  # unknown suffix
        raise ScreeError(f"{path}: {error}") from error
    plt.close(figure)
    return path


def run(arguments: argparse.Namespace) -> int:
    """Energies, their balance and other columns of the history, over time or over another column"""
    opened = open_run(arguments.folder)
    if arguments.list:
        return print_columns(opened)
    path = arguments.output or arguments.folder / "history.png"
    print(save(opened, arguments.columns, not arguments.no_energies, path, arguments.x))
    return 0
