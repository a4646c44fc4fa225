"""What view.py reads of a run: its deck and its snapshots."""

import json
import math
import os

import numpy as np
from paraview import servermanager, simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

try:
    import tomllib
except ImportError:  # of Python before 3.11, which some ParaViews have
    tomllib = None

FOLDER = None  # the results to show where none are named; scree-post paraview sets this and what follows
DECK = None  # of these results, with every default, as JSON
DRAWING = None  # what draws a mechanism: the text of a module

SAMPLES = 5  # times that are looked at for the colour scale and for how far bodies swing


class Trouble(Exception):
    """Says why there is nothing to show."""


def resolved_deck(folder):
    """With every default; empty where nothing tells it: the run has written no record yet, or this Python reads no
    TOML."""
    if DECK and FOLDER and os.path.realpath(folder) == os.path.realpath(FOLDER):
        return json.loads(DECK)
    path = os.path.join(folder, "run_record.json")
    if not os.path.exists(path):
        return {}
    if tomllib is None:
        print(f"{path}: Python 3.11 or newer reads the deck in it, for walls, joints and names; a view.py that "
              "scree-post paraview makes holds it")
        return {}
    with open(path, encoding="utf-8") as file:
        return tomllib.loads(json.load(file)["run"]["resolved_deck"])


def drawing():
    """The text of what draws a mechanism."""
    if DRAWING:
        return DRAWING
    from parts import DRAWING_FILES, joined

    return joined(DRAWING_FILES)


def open_series(folder, name):
    """The source of one kind of snapshots; None where the run has none."""
    data, text = (os.path.join(folder, name + suffix) for suffix in (".vtkhdf", ".xdmf"))
    program = servermanager.vtkSMProxyManager
    reads = (program.GetVersionMajor(), program.GetVersionMinor()) >= (5, 13)  # points, lines and triangles over time
    if reads and os.path.exists(data):
        source = simple.OpenDataFile(data)
    elif os.path.exists(text) and b"<Time" in open(text, "rb").read(4096):  # one without snapshots cannot be read
        source = simple.Xdmf3ReaderS(FileName=[text])
    else:
        return None
    simple.RenameSource(name, source)
    source.UpdatePipelineInformation()
    return source


def times_of(source):
    return np.atleast_1d(source.TimestepValues).tolist()


def information(source, association, field):
    """What is known of a field, without its values; None where there is none."""
    data = source.PointData if association == "POINTS" else source.CellData
    return data.GetArray(field) if field in data.keys() else None


def box_around(source, strays=0):
    """Its low and its high corner [m], with the points' field radius; the low one is above the other where there are no
    points. strays: percentage of the points, at each end of each axis, that may lie outside."""
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
    """Some of the times, the first and the last among them."""
    return sorted({times[round(k * (len(times) - 1) / (SAMPLES - 1))] for k in range(SAMPLES)})


def rounded_up(value):
    """To a number that reads well."""
    unit = 10.0 ** math.floor(math.log10(value))
    return next(step * unit for step in (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10) if step * unit >= 0.999 * value)


def largest(source, association, field, times, box):
    """The field's largest value, of a vector its length, but for the last percent, at some of the times; 0 where there
    is none. Of points those in the box: its low and its high corner."""
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
