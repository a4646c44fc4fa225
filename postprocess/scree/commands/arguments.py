"""Arguments that several commands have."""

from __future__ import annotations

import argparse
import pathlib


def add_folder(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", type=pathlib.Path, metavar="RESULT_DIR",
                        help="results of a run; if the run was restarted from another folder, both are joined")


def add_frames(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--frames", type=count, default=200, help="largest number of frames (default 200)")


def count(text: str) -> int:
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return value


def fraction(text: str) -> float:
    value = float(text)
    if not 0 <= value <= 1:
        raise argparse.ArgumentTypeError(f"{text} is not from 0 to 1")
    return value


def positive(text: str) -> float:
    value = float(text)
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text} is not above 0")
    return value
