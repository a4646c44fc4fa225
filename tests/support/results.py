"""A run's results for tests, read by the package of postprocess: of the folder alone, not of one that the run
went on from."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "postprocess"))

import scree  # noqa: E402
from scree import files  # noqa: E402


def opened(folder):
    """The run as an object of the package."""
    return scree.open(folder, earlier=False)


def columns(folder):
    """Columns of the history by path: arrays [rows]."""
    history = opened(folder).history.read()
    return {name: column.values for name, column in history.items()}


def rows(folder):
    """Rows of the history: a dictionary of numbers by path for each."""
    table = {name: values.tolist() for name, values in columns(folder).items()}
    return [dict(zip(table, row)) for row in zip(*table.values())]


def snapshots(folder):
    """For each snapshot its time [s] and the particles' fields by name, "position" among them: rows in the order of the
    ids."""
    for snapshot in opened(folder).snapshots:
        yield snapshot.time, {name: field.values for name, field in snapshot.particles.items()}


def datasets(path):
    """All values of an HDF5 file by their paths."""
    return files.read(path, lambda file: {name: item[()] for name, item in files.datasets(file).items()})
