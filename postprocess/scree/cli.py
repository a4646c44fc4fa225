"""The commands of scree-post."""

from __future__ import annotations

import argparse
import io
import os
import pathlib
import sys
from collections.abc import Sequence

from scree.errors import ScreeError


def main(words: Sequence[str] | None = None) -> int:
    """Returns the exit code: 0 done, 1 for `compare` where runs differ, 2 for what cannot be done."""
    from scree.commands import COMMANDS

    parser = argparse.ArgumentParser(prog="scree-post", description="Looks at what a run of Scree left in its folder.")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for name, (describe, run) in COMMANDS.items():
        short, *more = (run.__doc__ or "").strip().splitlines()
        described = commands.add_parser(name, help=short, description="\n".join([f"{short}.", *more]))
        describe(described)
        described.set_defaults(run=run)
    chosen = parser.parse_args(words)
    refuse_empty(parser, list(sys.argv[1:] if words is None else words))
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")  # of names that the locale's letters cannot say
    try:
        return int(chosen.run(chosen))
    except BrokenPipeError:  # whoever reads the words has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except (ScreeError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


def refuse_empty(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Ends the program where a word names nothing: an empty path would be the current folder."""
    for before, word in zip(["", *words], words):
        if not word.strip():
            option = f"argument {before}: " if before.startswith("-") else ""
            parser.error(f"{option}a name or path is empty; is a variable of a script not set?")


def add_folder(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("folder", type=pathlib.Path, metavar="RESULT_DIR",
                        help="results of a run; those before a restart from another folder are joined to them")
