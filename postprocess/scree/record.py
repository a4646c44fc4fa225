"""The record of a run (run_record.json), written at its end, and the lock that the run holds until then."""

from __future__ import annotations

import json
import os
import pathlib
import socket
import tomllib
from typing import Any

from scree import files
from scree.errors import ScreeError

RECORD, LOCK = "run_record.json", "scree.lock"
CHECKPOINTS = ("checkpoint.h5", "checkpoint_end.h5", "checkpoint_failed.h5")


def read_record(folder: pathlib.Path) -> dict[str, Any] | None:
    """None if there is none (yet)."""
    path = folder / RECORD
    try:
        record: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        return record
    except FileNotFoundError:
        return None
    except (OSError, ValueError) as error:
        raise ScreeError(f"{path}: cannot be read: {error}") from error


def is_going_on(folder: pathlib.Path) -> bool:
    """Whether a run holds the folder. A run on another host counts as alive as long as its lock exists."""
    try:
        lines = (folder / LOCK).read_text(encoding="utf-8", errors="replace").splitlines()
        owner = dict(line.split(maxsplit=1) for line in lines if " " in line)
    except FileNotFoundError:
        return False
    here = owner.get("host") in (None, socket.gethostname())
    return not here or os.path.exists(f"/proc/{owner.get('process', '')}/stat")


def read_deck(folder: pathlib.Path, record: dict[str, Any] | None) -> dict[str, Any]:
    """The resolved deck, from the record or, as long as there is none, from a checkpoint."""
    if record is not None:
        return tomllib.loads(record["run"]["resolved_deck"])
    for name in CHECKPOINTS:
        if (folder / name).exists():
            return tomllib.loads(files.read(folder / name, lambda file: files.text(file["texts/deck"][()])))
    raise ScreeError(f"{folder}: there is no deck yet: neither {RECORD} nor a checkpoint exists")


def earlier_folder(folder: pathlib.Path, record: dict[str, Any] | None) -> pathlib.Path | None:
    """The folder of the checkpoint from which the run continued, if that is another folder. The record has the path as
    given on the command line; it is resolved from the current folder, this folder and the folders above it. Throws
    ScreeError if it is not found."""
    given = record["run"]["restarted_from"] if record else ""
    if not given:
        return None
    checkpoint = pathlib.Path(given)
    for base in (pathlib.Path.cwd(), folder, *folder.parents):
        found = (base / checkpoint).resolve().parent
        if found.samefile(folder) if found.is_dir() else False:
            return None
        if (found / "particles.vtkhdf").exists() or (found / "history.h5").exists():
            return found
    raise ScreeError(f"{folder}: continued from {given}, which is not found from here; "
                     "name both folders, or open this one alone with earlier=False")
