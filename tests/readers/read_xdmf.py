#!/usr/bin/env pvbatch
"""Opens the .xdmf files of a result directory in ParaView (5.11 and newer) and renders the last time step.

    xvfb-run -a pvbatch tests/readers/read_xdmf.py RESULT_DIR PICTURE.png

Every XDMF reader that ParaView offers must give, at every time step, the counts and ranges that the reader of the
HDF5 file says. Exits with 1 at the first mismatch, which it names.
"""

import os
import sys

import numpy as np
from paraview import servermanager, simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

FIELDS = {"particles": ["global_id", "radius", "velocity", "force", "contacts"],
          "bodies": ["body", "radius", "velocity", "angle", "angular_velocity", "force", "contacts"]}


def require(condition, message):
    if not condition:
        print(f"error: {message}", file=sys.stderr, flush=True)
        os._exit(1)  # pvbatch turns SystemExit into 0


def readers(path):
    """All that ParaView may choose for the file: its dialog offers the three to the user."""
    return {"Xdmf3ReaderS": simple.Xdmf3ReaderS(FileName=[path]),
            "Xdmf3ReaderT": simple.Xdmf3ReaderT(FileName=[path]),
            "XDMFReader": simple.XDMFReader(FileNames=[path])}


def summary(source, time, fields):
    """Point and cell counts and, per field, the sum over all values, at one time step."""
    source.UpdatePipeline(time)
    data = servermanager.Fetch(source)
    sums = []
    for name in fields:
        array = data.GetPointData().GetArray(name)
        require(array is not None, f"no field {name} at t = {time:g} s")
        sums.append(float(np.sum(vtk_to_numpy(array), dtype=float)))
    points = vtk_to_numpy(data.GetPoints().GetData())
    return [data.GetNumberOfPoints(), data.GetNumberOfCells(), float(points.sum(dtype=float))] + sums


def check_series(directory, name):
    """Compares the readers step by step; returns the one that ParaView takes by default."""
    path = os.path.join(os.path.abspath(directory), name + ".xdmf")
    found = {}
    for kind, source in readers(path).items():
        source.UpdatePipelineInformation()
        times = list(source.TimestepValues)
        require(len(times) > 0, f"{path}: {kind} finds no time steps")
        found[kind] = [(time, summary(source, time, FIELDS[name])) for time in times]
        require(all(s[0] > 0 and s[0] == s[1] for _, s in found[kind]), f"{path}: {kind}: points and cells differ")
    first = found["Xdmf3ReaderS"]
    for kind, steps in found.items():
        require(np.allclose([t for t, _ in steps], [t for t, _ in first], atol=0), f"{path}: {kind}: other times")
        require(np.allclose([s for _, s in steps], [s for _, s in first], rtol=1e-12), f"{path}: {kind}: other values")
    counts = [s[0] for _, s in first]
    print(f"{path}: {len(first)} steps, {min(counts)} to {max(counts)} points, three readers agree", flush=True)
    return simple.OpenDataFile(path), first[-1][0]


def show(source, view, color):
    """As spheres (discs, seen from the front) of the stored radius; color is a field's name or an RGB triple."""
    glyph = simple.Glyph(Input=source, GlyphType="Sphere", ScaleArray=["POINTS", "radius"], ScaleFactor=2.0,
                         GlyphMode="All Points")
    glyph.GlyphType.Radius = 0.5
    glyph.GlyphType.ThetaResolution = 24
    glyph.GlyphType.PhiResolution = 24
    display = simple.Show(glyph, view)
    if isinstance(color, str):
        simple.ColorBy(display, ("POINTS", color, "Magnitude"))
        display.RescaleTransferFunctionToDataRange(True)
        display.SetScalarBarVisibility(view, True)
    else:
        simple.ColorBy(display, None)
        display.DiffuseColor = color


def main():
    require(len(sys.argv) == 3, "usage: pvbatch read_xdmf.py RESULT_DIR PICTURE.png")
    directory, picture = sys.argv[1:]
    particles, last = check_series(directory, "particles")
    view = simple.CreateView("RenderView")
    view.ViewSize = [1200, 900]
    view.ViewTime = last
    show(particles, view, "velocity")
    if os.path.exists(os.path.join(directory, "bodies.xdmf")):
        bodies, _ = check_series(directory, "bodies")
        show(bodies, view, [0.85, 0.37, 0.01])
    simple.Render(view)
    simple.ResetCamera(view)
    simple.SaveScreenshot(picture, view)
    require(os.path.getsize(picture) > 5000, f"{picture}: an empty picture")


main()
