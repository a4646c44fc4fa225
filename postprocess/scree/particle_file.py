"""Particle files of a deck (`kind = "file"`)."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Mapping
from typing import Any

import h5py
import numpy as np


def write_columns(path: str | os.PathLike[str], columns: Mapping[str, np.ndarray]) -> dict[str, Any]:
    """Writes HDF5 if the name ends in .h5 or .hdf5, otherwise CSV with full precision.

    Returns the keys of [[particles]] that read the file. The path is returned as given, relative to the current folder.
    A deck made in Python has such paths, and its write() adapts them; a deck that was read from a file needs paths
    relative to the folder of that file.
    """
    target = pathlib.Path(path)
    if target.suffix in (".h5", ".hdf5"):
        with h5py.File(target, "w") as file:
            for name, values in columns.items():
                file[name] = np.asarray(values, dtype=float)
    else:
        rows = zip(*(np.asarray(values, dtype=float).tolist() for values in columns.values()))
        target.write_text("\n".join([",".join(columns), *(",".join(map(repr, row)) for row in rows)]) + "\n",
                          encoding="utf-8")
    return {"kind": "file", "file": os.fspath(target)}
