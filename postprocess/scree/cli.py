"""The program scree-post."""

from __future__ import annotations

import argparse
import io
import os
import sys
from collections.abc import Sequence

from scree.commands import COMMANDS
from scree.errors import ScreeError

INTERRUPTED = 130  # as shells report a program that SIGINT ends


def main(words: Sequence[str] | None = None) -> int:
    """Returns the exit code: 0 done, 1 if `compare` finds differences or a search fails, 2 if the command cannot be
    carried out, 130 if it is interrupted."""
    parser = argparse.ArgumentParser(prog="scree-post", description="Evaluates the results of a run of Scree.")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    for name, (describe, run) in COMMANDS.items():
        short, *more = (run.__doc__ or "").strip().splitlines()
        described = commands.add_parser(name, help=short, description="\n".join([f"{short}.", *more]))
        describe(described)
        described.set_defaults(run=run)
    arguments = parser.parse_args(words)
    refuse_empty(parser, list(sys.argv[1:] if words is None else words))
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")  # for names with characters outside the locale's encoding
    try:
        return int(arguments.run(arguments))
    except BrokenPipeError:  # the reader of the output has gone
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return INTERRUPTED
    except (ScreeError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


def refuse_empty(parser: argparse.ArgumentParser, words: list[str]) -> None:
    """Ends the program if an argument is empty: an empty path would mean the current folder."""
    for before, word in zip(["", *words], words):
        if not word.strip():
            option = f"argument {before}: " if before.startswith("-") else ""
            parser.error(f"{option}a name or path is empty; is a variable of a script not set?")
