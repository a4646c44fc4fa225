from __future__ import annotations

import argparse
import pathlib

from scree.cli import add_folder
from scree.differences import common_rows, common_snapshots, differences
from scree.run import Run, open_run


def tolerance(text: str) -> float:
    value = float(text)
    if not value >= 0:
        raise argparse.ArgumentTypeError(f"{text} is below 0")
    return value


def describe(parser: argparse.ArgumentParser) -> None:
    add_folder(parser)
    parser.add_argument("other", type=pathlib.Path, metavar="OTHER_DIR")
    parser.add_argument("--tolerance", type=tolerance, metavar="SHARE",
                        help="let differences pass up to this share of a column's or a field's largest value")


def state_hash(opened: Run) -> str:
    return str(opened.record["run"]["state_hash"]) if opened.record else ""


def run(words: argparse.Namespace) -> int:
    """Whether two runs have the same results, bit for bit

    Compares all columns of the history and all fields of the snapshots at the times that both runs have, and prints a
    line for each that differs: the largest difference, its share of the largest value in the first run, and when that
    is; and a line for what one run has alone. The exit code is 1 where there is a line, or, with --tolerance, one past
    it.
    """
    one, other = open_run(words.folder), open_run(words.other)
    found = differences(one, other)
    if words.tolerance is not None:
        passed = [each for each in found if not each.text and each.relative <= words.tolerance]
        found = [each for each in found if each not in passed]
        if passed:
            print(f"within the tolerance: {len(passed)} columns and fields")
    for each in found:
        print(each)
    compared = f"{len(common_rows(one, other)[0])} rows of the history, " \
               f"{len(common_snapshots(one, other)[0])} snapshots"
    hashes = state_hash(one), state_hash(other)
    if all(hashes):
        print(f"state of the last checkpoint: {'the same' if hashes[0] == hashes[1] else 'different'}")
    if found:
        print(f"{len(found)} {'difference' if len(found) == 1 else 'differences'} ({compared})")
        return 1
    print(f"{'the same' if words.tolerance is not None else 'the same bits'} ({compared})")
    return 0
