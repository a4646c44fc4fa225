"""Reading files that a run may be writing.

During a run its HDF5 files are double-buffered: two copies alternate under the name of the file (jobs/using.md,
"Consistency and cost of the files"). An opened file is complete, but may change once the other copy has the name.
A reader therefore reads everything at once, closes the file, and repeats if the name has passed to the other copy.
If the copies alternate faster than that, as with a snapshot every fraction of a millisecond, all bytes are copied into
memory first. The reader takes no lock, because the run would find the lock on its other copy.
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
MOST_BYTES = 2**28  # largest file that is copied into memory
TRIES = 50  # tries of a copy into memory, per attempt


def identity(path: pathlib.Path) -> tuple[int, int, int] | None:
    """Identity and last change of the file that has the name now; None if there is none."""
    try:
        status = os.stat(path)
    except FileNotFoundError:
        return None
    return status.st_ino, status.st_mtime_ns, status.st_size


def image(path: pathlib.Path) -> bytes | None:
    """All bytes of the file at an instant at which it had the name, and was therefore complete; None if it changed
    meanwhile. Two readings with equal results are valid between the two, when the name is checked."""
    try:
        with open(path, "rb") as file:
            own = os.fstat(file.fileno())
            if own.st_size > MOST_BYTES:
                return None
            first = file.read()
            named = os.stat(path).st_ino == own.st_ino
            file.seek(0)
            return first if named and file.read() == first else None
    except FileNotFoundError:  # while the copies swap names
        return None


def read(path: pathlib.Path, extract: Callable[[h5py.File], Found]) -> Found:
    """The result of `extract` for the file at a single instant. Throws ScreeError if the file does not exist or cannot
    be read."""

    def attempt(source: pathlib.Path | io.BytesIO, is_stable: Callable[[], bool]) -> tuple[Found] | None:
        try:
            with h5py.File(source, "r", locking=False) as file:
                found = extract(file)
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
    raise ScreeError(f"{path}: changes faster than it can be read")


def text(value: object) -> str:
    """Text of an attribute or a dataset."""
    if isinstance(value, h5py.Empty):
        return ""
    return value.decode() if isinstance(value, bytes) else str(value)


def label(dataset: h5py.Dataset) -> tuple[str, str]:
    """Unit and description."""
    return text(dataset.attrs["unit"]), text(dataset.attrs["description"])


def datasets(file: h5py.File | h5py.Group) -> dict[str, h5py.Dataset]:
    """All datasets below, by path. A dataset with several names appears once."""
    found: dict[str, h5py.Dataset] = {}

    def add(path: str, item: object) -> None:
        if isinstance(item, h5py.Dataset):
            found[path] = item

    file.visititems(add)
    return found
