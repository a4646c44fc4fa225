from __future__ import annotations

import argparse
import pathlib

from scree.commands.arguments import add_folder
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
    parser.add_argument("--tolerance", type=tolerance, metavar="FRACTION",
                        help="accept differences up to this fraction of the largest value of a column or field")


def state_hash(opened: Run) -> str:
    return str(opened.record["run"]["state_hash"]) if opened.record else ""


def run(arguments: argparse.Namespace) -> int:
    """Whether two runs have the same results, bit for bit

    Compares all columns of the history and all fields of the snapshots at the times that both runs have. Prints one
    line per difference: the largest difference, its ratio to the largest value in the first run, and its time. Data of
    only one run have a line, too. The exit code is 1 if there are lines, with --tolerance lines beyond the tolerance.
    """
    one, other = open_run(arguments.folder), open_run(arguments.other)
    found = differences(one, other)
    if arguments.tolerance is not None:
        accepted = [each for each in found if not each.text and each.relative <= arguments.tolerance]
        found = [each for each in found if each not in accepted]
        if accepted:
            print(f"within the tolerance: {len(accepted)} columns and fields")
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
    print(f"{'the same' if arguments.tolerance is not None else 'the same bits'} ({compared})")
    return 0
