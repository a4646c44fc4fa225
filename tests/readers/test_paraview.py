#!/usr/bin/env pvbatch
"""What postprocess/scree/paraview/view.py shows of a run in the plane, of one with meshes in space and of a linkage
that has neither particles nor meshes.

    xvfb-run -a pvbatch tests/readers/test_paraview.py NET_400 DRUM_LIFTERS SLIDER_CRANK

takes the folders of their results and draws paraview_view.png into each. Needs what read_xdmf.py needs, and .venv for
scree-post. Exits with 1 at the first thing that is wrong, which it names."""

import os
import pathlib
import runpy
import subprocess
import sys

import h5py
import numpy as np
from paraview import servermanager, simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess/scree/paraview"))

import results
import view as shown_view

SIZE = [800, 600]


def require(condition, message):
    if not condition:
        print(f"error: {message}", file=sys.stderr, flush=True)
        os._exit(1)  # pvbatch turns SystemExit into 0


def pixels(path):
    """[height][width][3] of 0 to 255."""
    reader = simple.PNGSeriesReader(FileNames=[str(path)])
    reader.UpdatePipeline()
    image = servermanager.Fetch(reader)
    width, height, _ = image.GetDimensions()
    simple.Delete(reader)
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[..., :3].astype(int)


def times_of(folder):
    with h5py.File(folder / "particles.vtkhdf") as file:
        return file["VTKHDF/Steps/Values"][:]


def shown(folder, **chosen):
    """The scene, and its picture."""
    simple.ResetSession()
    view = simple.CreateView("RenderView")
    view.ViewSize = SIZE
    scene = shown_view.show(str(folder), **chosen)
    path = folder / "paraview_view.png"
    simple.SaveScreenshot(str(path), view, ImageResolution=SIZE)
    return scene, pixels(path)


def check_sources(folder, names):
    found = {name for name, _ in simple.GetSources()}
    require(set(names) <= found, f"{folder}: shows {sorted(found)}, not all of {names}")
    steps = np.array(simple.GetTimeKeeper().TimestepValues)
    require(np.array_equal(steps, times_of(folder)), f"{folder}: the animation has other times than the run")


def is_orange(image):
    return (image[..., 0] > 1.7 * image[..., 1]) & (image[..., 0] > 4 * image[..., 2])


def check_net(folder):
    scene, image = shown(folder)
    check_sources(folder, ["particles", "bodies", "space", "title", "time"])
    view = scene.view
    require(view.ViewTime == times_of(folder)[-1], f"{folder}: not at the last time")
    require(view.CameraParallelProjection and list(view.CameraViewUp) == [0, 1, 0], f"{folder}: not seen along z")
    beside = is_orange(image[:, : int(0.85 * SIZE[0])])  # the scales, which have orange, too
    share = beside.sum() * (2 * view.CameraParallelScale / SIZE[1]) ** 2 / (20 * np.pi * 0.05**2)
    require(0.3 < share < 1.1, f"{folder}: {share} of 20 discs of 5 cm are seen; lines of links lie over them")
    check_scale(scene, folder, "normal_force")
    _, early = shown(folder, time=0.101)
    require(abs(simple.GetActiveView().ViewTime - 0.1) < 1e-9, f"{folder}: not at the snapshot nearest to 0.101 s")
    scene, _ = shown(folder, field="group")
    check_scale(scene, folder, "group")
    names = list(simple.GetColorTransferFunction("group").Annotations)
    require(names == ["0", "block"], f"{folder}: groups have the names {names}")
    scene, _ = shown(folder, contacts=False)
    require("contact forces" not in {name for name, _ in simple.GetSources()}, f"{folder}: shows contacts")
    check_scale(scene, folder, "velocity")
    check_what_fell_out_of_sight(folder)
    require((np.abs(early - image).max(axis=2) > 40).mean() > 0.02, f"{folder}: looks the same at 0.1 s")


def check_scale(scene, folder, field):
    """There is one, of that field, and it is within the picture."""
    require(len(scene.bars) == 1, f"{folder}: {len(scene.bars)} scales")
    title = simple.GetScalarBar(simple.GetColorTransferFunction(field), scene.view).Title
    require(scene.bars[0].Title == title, f"{folder}: the scale is of {scene.bars[0].Title}, not of {field}")
    x, y = scene.bars[0].Position
    require(x < 0.95 and 0 < y < y + scene.bars[0].ScalarBarLength < 1, f"{folder}: the scale stands at {x}, {y}")


def check_what_fell_out_of_sight(folder):
    """The scale of speeds ends where the particles in the picture end, and not where those outside the space do."""
    with h5py.File(folder / "particles.vtkhdf") as file:
        ends = np.append(file["VTKHDF/Steps/PointOffsets"][:], len(file["VTKHDF/Points"]))
        last = slice(*ends[-2:])
        points, speeds = file["VTKHDF/Points"][last], np.linalg.norm(file["VTKHDF/PointData/velocity"][last], axis=1)
    source = simple.FindSource("particles")
    source.UpdatePipeline(times_of(folder)[-1])
    low, high = np.percentile(points, [30, 70], axis=0)
    inside = ((points >= low) & (points <= high)).all(axis=1)
    found = results.largest(source, "POINTS", "velocity", [times_of(folder)[-1]], (low, high))
    require(np.isclose(found, np.percentile(speeds[inside], 99)), f"{folder}: {found} is not of what is in the box")


def check_framed(scene, folder):
    """The corners of what is shown, and of the box of the space, are in the picture."""
    renderer = scene.view.GetRenderer()
    boxes = [(scene.low, scene.high)]
    if simple.FindSource("space"):
        bounds = np.array(simple.FindSource("space").GetDataInformation().GetBounds())
        boxes.append((bounds[::2], bounds[1::2]))
    for low, high in boxes:
        for corner in range(8):
            point = np.where([corner & 1, corner & 2, corner & 4], high, low)
            renderer.SetWorldPoint(*point, 1.0)
            renderer.WorldToDisplay()
            x, y = np.array(renderer.GetDisplayPoint()[:2]) / SIZE
            require(0 < x < 0.9 and 0 < y < 1, f"{folder}: {point} is at {x:.2f}, {y:.2f} of the picture")


def check_crank(folder):
    """A linkage alone: its bars, with as much length as they have, and forces in its joints."""
    scene, image = shown(folder, time=0.3)
    check_sources(folder, ["bodies", "links", "mechanism", "forces in links", "title", "time"])
    check_scale(scene, folder, "reaction")
    check_framed(scene, folder)
    require(scene.limit > 0, f"{folder}: a scale without an end")
    drawn = servermanager.Fetch(simple.FindSource("mechanism"))
    colors = vtk_to_numpy(drawn.GetCellData().GetArray("color"))
    require((colors == [0xe6, 0x61, 0x00]).all(axis=1).sum() >= 3 * 16, f"{folder}: no bars among the tubes")
    bounds = np.array(drawn.GetBounds())
    with h5py.File(folder / "bodies.vtkhdf") as file:
        steps = file["VTKHDF/Steps"]
        k = int(np.abs(steps["Values"][:] - 0.3).argmin())
        first, part = steps["PointOffsets"][k], steps["PartOffsets"][k]
        points = file["VTKHDF/Points"][first : first + file["VTKHDF/NumberOfPoints"][part]]
    within = (points[:, :2] >= bounds[:4:2] - 1e-6) & (points[:, :2] <= bounds[1:4:2] + 1e-6)
    require(within.all(), f"{folder}: the bars reach from {bounds[::2]} to {bounds[1::2]}, not to all of {points}")
    balls = servermanager.Fetch(simple.FindSource("forces in links"))
    forces = vtk_to_numpy(balls.GetPointData().GetArray("reaction"))
    require(len(np.unique(forces.round(6))) >= 3 and forces.max() > 0, f"{folder}: forces are {np.unique(forces)}")
    require((image.min(axis=2) < 250).mean() > 0.02, f"{folder}: next to nothing is drawn")


def check_drum(folder):
    scene, image = shown(folder)
    check_scale(scene, folder, "velocity")
    check_framed(scene, folder)
    check_sources(folder, ["particles", "surfaces", "edges of surfaces", "space", "title", "time"])
    up, eye = np.array(scene.view.CameraViewUp), np.array(scene.view.CameraPosition) - scene.view.CameraFocalPoint
    require(up[2] > 0.8 and eye[2] > 0, f"{folder}: gravity does not point down")
    drawn = (image.min(axis=2) < 250).mean()
    require(0.15 < drawn < 0.7, f"{folder}: a share of {drawn} of the picture is drawn")
    try:
        shown_view.show(str(folder), field="colour")
        require(False, f"{folder}: takes a field that is not there")
    except shown_view.NothingToShow as trouble:
        require("no field colour; there are " in str(trouble), trouble)


def check_file(folder):
    """What scree-post makes, as pvbatch and ParaView run it."""
    words = [ROOT / "postprocess/scree-post", "paraview", folder]
    environment = {name: os.environ[name] for name in ("PATH", "HOME")}  # without ParaView's paths of Python
    made = pathlib.Path(subprocess.run(words, env=environment, capture_output=True, text=True).stdout.strip())
    require(made == folder / "view.py", f"{folder}: scree-post paraview made {made}")
    picture = folder / "paraview_view.png"
    picture.unlink()
    for words in ([str(made), "-o", str(picture), "--size", *map(str, SIZE)], ["paraview"]):
        simple.ResetSession()
        sys.argv = words
        runpy.run_path(str(made), run_name="__main__")
        check_sources(folder, ["particles", "surfaces"])
    image = pixels(picture)
    require(image.shape[:2] == tuple(SIZE[::-1]), f"{picture}: of {image.shape}")


def main():
    require(len(sys.argv) == 4, "usage: pvbatch test_paraview.py NET_400 DRUM_LIFTERS SLIDER_CRANK")
    net, drum, crank = (pathlib.Path(path).resolve() for path in sys.argv[1:])
    check_crank(crank)
    check_net(net)
    check_drum(drum)
    check_file(drum)
    print("what ParaView shows of them is right", flush=True)


if __name__ == "__main__":  # once more: programmable filters put numpy's functions in place of those of this module
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
    import test_paraview

    test_paraview.main()
