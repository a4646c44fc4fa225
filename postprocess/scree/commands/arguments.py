"""Arguments that several commands have."""

from __future__ import annotations

import argparse
import pathlib

import numpy as np

from scree.errors import ScreeError


def add_folder(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", type=pathlib.Path, metavar="RESULT_DIR",
                        help="results of a run; if the run was restarted from another folder, both are joined")


def add_frames(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--frames", type=count, default=200, help="largest number of frames (default 200)")


def add_span(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--from", type=float, dest="begin", default=-float("inf"), metavar="TIME",
                        help="first snapshot [s]")
    parser.add_argument("--to", type=float, dest="end", default=float("inf"), metavar="TIME", help="last snapshot [s]")


def snapshots_in_span(arguments: argparse.Namespace, times: np.ndarray) -> list[int]:
    """Throws ScreeError if there are none."""
    found = [k for k, time in enumerate(times) if arguments.begin <= time <= arguments.end]
    if not found:
        raise ScreeError(f"{arguments.folder}: no snapshot from {arguments.begin:g} to {arguments.end:g} s" + (
            f"; they go from {times[0]:g} to {times[-1]:g} s" if len(times) else ""))
    return found


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
