from __future__ import annotations

import argparse
import pathlib
from collections.abc import Sequence

from scree.cli import add_folder
from scree.errors import ScreeError
from scree.history import TIME
from scree.run import Run, open_run


def add_columns(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--columns", nargs="+", default=[], metavar="GROUP/NAME",
                        help="columns of the history to plot below the energies, a panel per group and unit; * stands "
                             "for any text, as in 'reactions/*/fx'")
    parser.add_argument("--list", action="store_true",
                        help="print the history's columns with unit and description, draw nothing")


def describe(parser: argparse.ArgumentParser) -> None:
    add_folder(parser)
    add_columns(parser)
    parser.add_argument("--no-energies", action="store_true", help="plot the columns alone")
    parser.add_argument("--x", default=TIME, metavar="GROUP/NAME",
                        help="the column along the horizontal axis, as in --x bodies/piston/x; default time")
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
    except ValueError as error:  # of a suffix that it does not know
        raise ScreeError(f"{path}: {error}") from error
    plt.close(figure)
    return path


def run(words: argparse.Namespace) -> int:
    """Energies, their balance and other columns of the history, over time or over one of its columns"""
    opened = open_run(words.folder)
    if words.list:
        return print_columns(opened)
    print(save(opened, words.columns, not words.no_energies, words.output or words.folder / "history.png", words.x))
    return 0
