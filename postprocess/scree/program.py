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
LINES = 20  # of what it says that are shown where none is an error's


class RefusedError(ScreeError):
    """The program did not begin: bad usage or deck, or a folder with results of another run."""


def find(scree: str | os.PathLike[str] | None = None) -> pathlib.Path | None:
    """The one named, $SCREE, the one on the PATH, or build/release/scree of the repository that this package stands in;
    None where there is none. Throws ScreeError where the one named, or by SCREE, is not there."""
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
        raise ScreeError("the program scree is not there: build it, put it on the PATH, or name it by SCREE")
    return found


def message(said: str) -> str:
    """Of an error among the words of program and launcher."""
    lines = said.strip().splitlines()
    errors = [line.removeprefix("error: ") for line in lines if line.startswith("error: ")]
    return "\n".join(dict.fromkeys(errors)) or "\n".join(lines[-LINES:]) or "it says nothing"


def call(words: Sequence[str | bytes | os.PathLike[str]], names: Mapping[str, str],
         output: int | IO[str] | None = PIPE) -> str:
    """Returns what the program prints, unless it goes elsewhere: to a file, or, None, to be seen. names: what to call
    paths in messages. Throws ScreeError with the program's message, RefusedError where it did not begin."""
    with subprocess.Popen(words, stdout=output, stderr=PIPE, encoding="utf-8", errors="replace") as process:
        try:
            printed, said = process.communicate()
        except KeyboardInterrupt:  # the program has it, too, and ends with a checkpoint
            process.wait()
            raise
    if process.returncode == 0:
        return printed or ""
    text = message(said)
    for path, name in names.items():
        text = text.replace(path, name)
    raise (RefusedError if process.returncode == REFUSED else ScreeError)(text)
