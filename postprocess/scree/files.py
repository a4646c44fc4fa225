"""Reading files that a run may be writing.

While it goes on, each of its HDF5 files exists twice and the two copies take turns under the file's name
(jobs/using.md, "What a run writes"): what is opened is complete, but may be changed once the other copy has the name.
So a reader takes all it wants at once, closes the file, and takes it again where the name has passed on in between.
Where that is faster, as with snapshots every fraction of a millisecond, all bytes are taken at once and read from
memory. It takes no lock: the run would find it on its other copy.
"""

from __future__ import annotations

import io
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
MOST_BYTES = 2**28  # that are taken at once
TRIES = 50  # of that in each attempt


def identity(path: pathlib.Path) -> tuple[int, int, int] | None:
    """Of what has the name now and of its last change; None where nothing has it."""
    try:
        status = os.stat(path)
    except FileNotFoundError:
        return None
    return status.st_ino, status.st_mtime_ns, status.st_size


def image(path: pathlib.Path) -> bytes | None:
    """All bytes of the file at an instant at which it had the name, and so was complete; None where it was changed
    meanwhile. What is read twice with the same result was so between the two, when the name is looked at."""
    try:
        with open(path, "rb") as file:
            own = os.fstat(file.fileno())
            if own.st_size > MOST_BYTES:
                return None
            first = file.read()
            named = os.stat(path).st_ino == own.st_ino
            file.seek(0)
            return first if named and file.read() == first else None
    except FileNotFoundError:  # between two names
        return None


def read(path: pathlib.Path, what: Callable[[h5py.File], Found]) -> Found:
    """What `what` takes from the file, all of one instant. Throws ScreeError where there is no such file, or none that
    can be read."""

    def attempt(source: pathlib.Path | io.BytesIO, is_stable: Callable[[], bool]) -> tuple[Found] | None:
        try:
            with h5py.File(source, "r", locking=False) as file:
                found = what(file)
            return (found,) if is_stable() else None
        except (OSError, RuntimeError, KeyError, ValueError) as error:
            if is_stable():
                raise ScreeError(f"{path}: cannot be read: {error}") from error
            return None

    for number in range(ATTEMPTS):
        before = identity(path)
        if before is None:
            raise ScreeError(f"{path}: no such file")
        found = attempt(path, lambda: identity(path) == before)
        if found is None:
            bytes_at_once = next(filter(None, (image(path) for _ in range(TRIES))), None)
            found = attempt(io.BytesIO(bytes_at_once), lambda: True) if bytes_at_once else None
        if found is not None:
            return found[0]
        time.sleep(WAIT * 2**number)
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
