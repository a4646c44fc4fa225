"""Calling the program itself."""

from __future__ import annotations

import os
import pathlib
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from subprocess import PIPE
from typing import IO

from scree.errors import ScreeError

HERE = pathlib.Path(__file__).resolve()
REFUSED = 2  # exit code of the program: usage or deck
LINES = 20  # last lines of the output that are shown if none begins with "error: "


class RefusedError(ScreeError):
    """The program did not start the run: wrong usage or deck, or a folder with results of another run."""


def find(scree: str | os.PathLike[str] | None = None) -> pathlib.Path | None:
    """The given program, else $SCREE, else scree on the PATH, else build/release/scree of the repository that contains
    this package; None if there is none. Throws ScreeError if the given program or $SCREE does not exist."""
    named = scree or os.environ.get("SCREE")
    if named:
        path = shutil.which(named)
        if path is None:
            raise ScreeError(f"{os.fspath(named)}: no such program")
        return pathlib.Path(path).resolve()
    built = HERE.parents[2] / "build/release/scree"
    path = shutil.which("scree") or shutil.which(built)
    return pathlib.Path(path) if path else None


def required(scree: str | os.PathLike[str] | None = None) -> pathlib.Path:
    found = find(scree)
    if found is None:
        raise ScreeError("the program scree is not found: build it, put it on the PATH, or name it by SCREE")
    return found


def message(output: str) -> str:
    """The error message in the output of program and launcher."""
    lines = output.strip().splitlines()
    errors = [line.removeprefix("error: ") for line in lines if line.startswith("error: ")]
    return "\n".join(dict.fromkeys(errors)) or "\n".join(lines[-LINES:]) or "no message"


def call(command: Sequence[str | bytes | os.PathLike[str]], names: Mapping[str, str],
         output: int | IO[str] | None = PIPE) -> str:
    """Returns the standard output of the program, unless `output` is a file or None (the terminal). names: replacements
    for paths in messages. Throws ScreeError with the program's message, RefusedError if no run was started."""
    with subprocess.Popen(command, stdout=output, stderr=PIPE, encoding="utf-8", errors="replace") as process:
        try:
            printed, errors = process.communicate()
        except KeyboardInterrupt:  # the program gets the signal, too, and ends with a checkpoint
            process.wait()
            raise
    if process.returncode == 0:
        return printed or ""
    text = message(errors)
    for path, name in names.items():
        text = text.replace(path, name)
    raise (RefusedError if process.returncode == REFUSED else ScreeError)(text)
