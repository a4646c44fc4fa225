#!/usr/bin/env pvbatch
"""Opens the .xdmf files of a result directory in ParaView (5.11 and newer) and renders the last time step.

    xvfb-run -a pvbatch tests/readers/read_xdmf.py RESULT_DIR PICTURE.png

Needs Debian's paraview, python3-paraview, xvfb, xauth and python3-h5py. Each of the three XDMF readers that ParaView
offers must give, at every time step, the raw HDF5 data. Exits with 1 at the first mismatch, which it names.
"""

import os
import sys

import h5py
import numpy as np
from paraview import servermanager, simple
from paraview.vtk.util.numpy_support import vtk_to_numpy


def require(condition, message):
    if not condition:
        print(f"error: {message}", file=sys.stderr, flush=True)
        os._exit(1)  # pvbatch turns SystemExit into 0


def raw_snapshots(path):
    """[(time, {name: values})] of the snapshots that have points: the .xdmf leaves out the others. With the fields of
    points or, of lines, of these."""
    snapshots = []
    with h5py.File(path, "r") as file:
        root, steps = file["VTKHDF"], file["VTKHDF/Steps"]
        offsets = {name: rows[:] for name, rows in steps.get("PointDataOffsets", {}).items()}
        for step, (time, part, first) in enumerate(zip(steps["Values"][:], steps["PartOffsets"][:],
                                                       steps["PointOffsets"][:])):
            count = root["NumberOfPoints"][part]
            rows = slice(first, first + count)
            data = {name: root["PointData"][name][of[step] : of[step] + count] for name, of in offsets.items()}
            if "LineOffsets" in steps:
                of_lines = slice(rows.start // 2, rows.stop // 2)
                data |= {name: field[of_lines] for name, field in root["CellData"].items()}
            data["Points"] = root["Points"][rows]
            if rows.stop > rows.start:
                snapshots.append((time, data))
    return snapshots


def raw_triangles(path, snapshot):
    """{name: values} per triangle."""
    with h5py.File(path, "r") as file:
        root = file["VTKHDF"]
        count = root["Polygons/NumberOfCells"][0]
        first = {name: offsets[snapshot] for name, offsets in root["Steps/CellDataOffsets"].items()}
        return {name: field[first[name] : first[name] + count] for name, field in root["CellData"].items()}


def readers(path):
    """All that ParaView may take for the file: its dialog offers the three to the user."""
    return {
        "Xdmf3ReaderS": simple.Xdmf3ReaderS(FileName=[path]),
        "Xdmf3ReaderT": simple.Xdmf3ReaderT(FileName=[path]),
        "XDMFReader": simple.XDMFReader(FileNames=[path]),
    }


def check_step(where, data, raw):
    count = len(raw["Points"])
    require(data.GetNumberOfPoints() == count, f"{where}: {data.GetNumberOfPoints()} points for {count}")
    require(data.GetNumberOfCells() == count, f"{where}: {data.GetNumberOfCells()} cells for {count}")
    require(
        np.array_equal(vtk_to_numpy(data.GetPoints().GetData()), raw["Points"]), f"{where}: Points differ"
    )
    for name, values in raw.items():
        if name == "Points":
            continue
        array = data.GetPointData().GetArray(name)
        require(array is not None, f"{where}: no field {name}")
        require(np.array_equal(vtk_to_numpy(array), values), f"{where}: {name} differs")


def check_series(directory, name):
    """Returns the reader that ParaView takes by default, and the last time."""
    path = os.path.join(os.path.abspath(directory), name + ".xdmf")
    snapshots = raw_snapshots(os.path.join(directory, name + ".vtkhdf"))
    for kind, source in readers(path).items():
        source.UpdatePipelineInformation()
        times = list(source.TimestepValues)
        require(times == [time for time, _ in snapshots], f"{path}: {kind}: other times than in the data")
        for time, raw in snapshots:
            source.UpdatePipeline(time)
            check_step(f"{path}, {kind}, t = {time:g} s", servermanager.Fetch(source), raw)
    counts = [len(raw["Points"]) for _, raw in snapshots]
    print(
        f"{path}: {len(counts)} steps, {min(counts)} to {max(counts)} points: right in three readers",
        flush=True,
    )
    return simple.OpenDataFile(path), snapshots[-1][0]


def check_lines(directory, name):
    path = os.path.join(os.path.abspath(directory), name + ".xdmf")
    snapshots = raw_snapshots(os.path.join(directory, name + ".vtkhdf"))
    for kind, source in readers(path).items():
        for time, raw in snapshots:
            source.UpdatePipeline(time)
            data, where = servermanager.Fetch(source), f"{path}, {kind}, t = {time:g} s"
            count = data.GetNumberOfCells()
            require(2 * count == len(raw["Points"]), f"{where}: {count} lines")
            ends = [data.GetCell(k).GetPointId(end) for k in range(count) for end in range(2)]
            points = vtk_to_numpy(data.GetPoints().GetData())
            require(np.array_equal(points[ends], raw["Points"]), f"{where}: other ends")
            require({data.GetCell(k).GetNumberOfPoints() for k in range(count)} == {2}, f"{where}: no lines")
            for name, values in raw.items():
                if name == "Points":
                    continue
                array = data.GetCellData().GetArray(name)
                require(array is not None, f"{where}: no field {name}")
                require(np.array_equal(vtk_to_numpy(array), values), f"{where}: {name} differs")
    print(f"{path}: {len(snapshots)} steps: right in three readers", flush=True)


def check_surfaces(directory):
    path = os.path.join(os.path.abspath(directory), "surfaces.xdmf")
    data_path = os.path.join(directory, "surfaces.vtkhdf")
    snapshots = raw_snapshots(data_path)
    for kind, source in readers(path).items():
        for step, (time, raw) in enumerate(snapshots):
            source.UpdatePipeline(time)
            data, where = servermanager.Fetch(source), f"{path}, {kind}, t = {time:g} s"
            points = vtk_to_numpy(data.GetPoints().GetData())
            require(np.array_equal(points, raw["Points"]), f"{where}: Points differ")
            for name, values in raw_triangles(data_path, step).items():
                array = data.GetCellData().GetArray(name)
                require(array is not None, f"{where}: no field {name}")
                require(np.array_equal(vtk_to_numpy(array), values), f"{where}: {name} differs")
            require({data.GetCellType(k) for k in range(data.GetNumberOfCells())} == {5}, f"{where}: no triangles")
    print(f"{path}: {len(snapshots)} steps: right in three readers", flush=True)


def show(source, view, color):
    """As spheres of the stored radius; color is a field's name or an RGB triple."""
    glyph = simple.Glyph(
        Input=source,
        GlyphType="Sphere",
        ScaleArray=["POINTS", "radius"],
        ScaleFactor=2.0,
        GlyphMode="All Points",
    )
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


def colors_in(picture):
    """Number of different colours in a PNG file."""
    reader = simple.PNGSeriesReader(FileNames=[picture])
    reader.UpdatePipeline()
    return len(np.unique(vtk_to_numpy(servermanager.Fetch(reader).GetPointData().GetScalars()), axis=0))


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
    if os.path.exists(os.path.join(directory, "surfaces.xdmf")):
        check_surfaces(directory)
    for lines in ("contacts", "links"):
        if os.path.exists(os.path.join(directory, lines + ".xdmf")):
            check_lines(directory, lines)
    simple.Render(view)
    simple.ResetCamera(view)
    simple.SaveScreenshot(picture, view)
    require(colors_in(picture) > 20, f"{picture}: an empty picture")


main()
