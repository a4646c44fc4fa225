"""What a run says of itself: run_record.json, which it writes at its end, and the lock that it holds until then."""

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
    """None where there is none (yet)."""
    path = folder / RECORD
    try:
        record: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        return record
    except FileNotFoundError:
        return None
    except (OSError, ValueError) as error:
        raise ScreeError(f"{path}: cannot be read: {error}") from error


def is_going_on(folder: pathlib.Path) -> bool:
    """Whether a run holds the folder. One on another host counts as alive for as long as its lock is there."""
    try:
        lines = (folder / LOCK).read_text(encoding="utf-8", errors="replace").splitlines()
        owner = dict(line.split(maxsplit=1) for line in lines if " " in line)
    except FileNotFoundError:
        return False
    here = owner.get("host") in (None, socket.gethostname())
    return not here or os.path.exists(f"/proc/{owner.get('process', '')}/stat")


def read_deck(folder: pathlib.Path, record: dict[str, Any] | None) -> dict[str, Any]:
    """The resolved deck: of the record, or while there is none of a checkpoint."""
    if record is not None:
        return tomllib.loads(record["run"]["resolved_deck"])
    for name in CHECKPOINTS:
        if (folder / name).exists():
            return tomllib.loads(files.read(folder / name, lambda file: files.text(file["texts/deck"][()])))
    raise ScreeError(f"{folder}: the run's deck is in {RECORD} and in checkpoints, and neither is there yet")


def came_from(folder: pathlib.Path, record: dict[str, Any] | None) -> pathlib.Path | None:
    """The folder of the checkpoint that the run went on from, where that is another one. The record has the path as the
    run was given it: it is looked for from this folder and those above it, too. Throws ScreeError where it is
    nowhere."""
    said = record["run"]["restarted_from"] if record else ""
    if not said:
        return None
    checkpoint = pathlib.Path(said)
    for base in (pathlib.Path.cwd(), folder, *folder.parents):
        found = (base / checkpoint).resolve().parent
        if found.samefile(folder) if found.is_dir() else False:
            return None
        if (found / "particles.vtkhdf").exists() or (found / "history.h5").exists():
            return found
    raise ScreeError(f"{folder}: went on from {said}, which is not found from here; "
                     "name both folders, or open this one alone with earlier=False")
