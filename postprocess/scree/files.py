"""Reading files that a run may be writing.

While it goes on, each of its HDF5 files exists twice and the two copies take turns under the file's name
(jobs/using.md, "What a run writes"): what is opened is complete, but may be changed once the other copy has the name.
So a reader takes all it wants at once, closes the file, and takes it again where the name has passed on in between.
It takes no lock: the run would find it on its other copy.
"""

from __future__ import annotations

import os
import pathlib
import time
from collections.abc import Callable
from typing import TypeVar

import h5py

from scree.errors import ScreeError

Found = TypeVar("Found")
ATTEMPTS = 12
WAIT = 0.005  # before the second attempt, twice as long before each further one [s]


def identity(path: pathlib.Path) -> tuple[int, int, int] | None:
    """Of what has the name now and of its last change; None where nothing has it."""
    try:
        status = os.stat(path)
    except FileNotFoundError:
        return None
    return status.st_ino, status.st_mtime_ns, status.st_size


def read(path: pathlib.Path, what: Callable[[h5py.File], Found]) -> Found:
    """What `what` takes from the file, all of one instant. Throws ScreeError where there is no such file, or none that
    can be read."""
    for attempt in range(ATTEMPTS):
        if attempt:
            time.sleep(WAIT * 2 ** (attempt - 1))
        before = identity(path)
        if before is None:
            raise ScreeError(f"{path}: no such file")
        try:
            with h5py.File(path, "r", locking=False) as file:
                found = what(file)
            if identity(path) == before:
                return found
        except (OSError, RuntimeError, KeyError, ValueError) as error:
            if identity(path) == before:
                raise ScreeError(f"{path}: cannot be read: {error}") from error
    raise ScreeError(f"{path}: is written again faster than it can be read")


def text(value: object) -> str:
    """Of an attribute or a dataset of text."""
    if isinstance(value, h5py.Empty):
        return ""
    return value.decode() if isinstance(value, bytes) else str(value)


def label(dataset: h5py.Dataset) -> tuple[str, str]:
    """Unit and description."""
    return text(dataset.attrs["unit"]), text(dataset.attrs["description"])


def datasets(file: h5py.File | h5py.Group) -> dict[str, h5py.Dataset]:
    """All below by their paths, each once: one that has several names, under one of them."""
    found: dict[str, h5py.Dataset] = {}

    def add(path: str, item: object) -> None:
        if isinstance(item, h5py.Dataset):
            found[path] = item

    file.visititems(add)
    return found
