"""Reads the deck and the snapshots of a run for view.py."""

import json
import math
import os

import numpy as np
from paraview import servermanager, simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

try:
    import tomllib
except ImportError:  # Python before 3.11, in some versions of ParaView
    tomllib = None

FOLDER = None  # default folder of results; scree-post paraview sets this and the following constants
DECK = None  # deck of these results, with all defaults, as JSON
DRAWING = None  # source of the module that draws a mechanism

SAMPLES = 5  # number of times that determine the colour scale and the region of moving bodies


class NothingToShow(Exception):
    """The text has the reason."""


def resolved_deck(folder):
    """The deck with all defaults; empty if the run has not written a record yet, or if this Python cannot read TOML."""
    if DECK and FOLDER and os.path.realpath(folder) == os.path.realpath(FOLDER):
        return json.loads(DECK)
    path = os.path.join(folder, "run_record.json")
    if not os.path.exists(path):
        return {}
    if tomllib is None:
        print(f"{path}: needs Python 3.11 or newer for the deck with walls, joints and names; a view.py made by "
              "scree-post paraview contains the deck")
        return {}
    with open(path, encoding="utf-8") as file:
        return tomllib.loads(json.load(file)["run"]["resolved_deck"])


def drawing():
    """Source of the module that draws a mechanism."""
    if DRAWING:
        return DRAWING
    from parts import DRAWING_FILES, joined

    return joined(DRAWING_FILES)


def open_series(folder, name):
    """The ParaView source of one kind of snapshots; None if the run has none."""
    data, text = (os.path.join(folder, name + suffix) for suffix in (".vtkhdf", ".xdmf"))
    program = servermanager.vtkSMProxyManager
    # From 5.13 on ParaView reads points, lines and triangles over time.
    reads_vtkhdf = (program.GetVersionMajor(), program.GetVersionMinor()) >= (5, 13)
    if reads_vtkhdf and os.path.exists(data):
        source = simple.OpenDataFile(data)
    elif os.path.exists(text) and b"<Time" in open(text, "rb").read(4096):  # ParaView cannot read one without
        source = simple.Xdmf3ReaderS(FileName=[text])
    else:
        return None
    simple.RenameSource(name, source)
    source.UpdatePipelineInformation()
    return source


def times_of(source):
    return np.atleast_1d(source.TimestepValues).tolist()


def information(source, association, field):
    """Metadata of a field, without its values; None if there is no such field."""
    data = source.PointData if association == "POINTS" else source.CellData
    return data.GetArray(field) if field in data.keys() else None


def box_around(source, strays=0):
    """Low and high corner [m] of the box around the points with their radii; low > high without points. strays:
    percentage of the points that may be outside, at each end of each axis."""
    known = source.GetDataInformation()
    if not known.GetNumberOfPoints():
        return np.full(3, np.inf), np.full(3, -np.inf)
    if information(source, "POINTS", "radius") is None:
        bounds = np.array(known.GetBounds())
        return bounds[::2], bounds[1::2]
    data = servermanager.Fetch(source)
    points = vtk_to_numpy(data.GetPoints().GetData())
    radii = vtk_to_numpy(data.GetPointData().GetArray("radius"))
    if strays:
        return tuple(np.percentile(points, [strays, 100 - strays], axis=0) + np.array([[-1], [1]]) * radii.max())
    return (points - radii[:, None]).min(axis=0), (points + radii[:, None]).max(axis=0)


def sampled(times):
    """Some of the times, including the first and the last."""
    return sorted({times[round(k * (len(times) - 1) / (SAMPLES - 1))] for k in range(SAMPLES)})


def rounded_up(value):
    """The value rounded up to a number with few digits."""
    unit = 10.0 ** math.floor(math.log10(value))
    return next(step * unit for step in (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10) if step * unit >= 0.999 * value)


def largest(source, association, field, times, box):
    """Largest 99th percentile of a field (a vector by magnitude) over some of the times; 0 without values. Points count
    inside the box (low corner, high corner)."""
    found = 0.0
    for time in sampled(times):
        source.UpdatePipeline(time)
        data = servermanager.Fetch(source)
        array = (data.GetPointData() if association == "POINTS" else data.GetCellData()).GetArray(field)
        if not array or not array.GetNumberOfTuples():
            continue
        values = vtk_to_numpy(array)
        sizes = np.linalg.norm(values, axis=1) if values.ndim > 1 else values
        if association == "POINTS":
            points = vtk_to_numpy(data.GetPoints().GetData())
            sizes = sizes[((points >= box[0]) & (points <= box[1])).all(axis=1)]
        if (sizes > 0).any():
            found = max(found, float(np.percentile(sizes[sizes > 0], 99)))
    return found
