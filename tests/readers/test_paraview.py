#!/usr/bin/env pvbatch
"""What postprocess/scree/paraview/view.py shows of a run in the plane and of one with meshes in space.

    xvfb-run -a pvbatch tests/readers/test_paraview.py NET_400 DRUM_LIFTERS

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
    _, early = shown(folder, time=0.101)
    require(abs(simple.GetActiveView().ViewTime - 0.1) < 1e-9, f"{folder}: not at the snapshot nearest to 0.101 s")
    scene, _ = shown(folder, field="group")
    places = [bar.Position[1] for bar in scene.bars]
    require(len(places) == 3 and min(places) > 0, f"{folder}: scales stand at {places}")
    names = list(simple.GetColorTransferFunction("group").Annotations)
    require(names == ["0", "block"], f"{folder}: groups have the names {names}")
    scene, _ = shown(folder, contacts=False)
    require("contact forces" not in {name for name, _ in simple.GetSources()}, f"{folder}: shows contacts")
    require((np.abs(early - image).max(axis=2) > 40).mean() > 0.02, f"{folder}: looks the same at 0.1 s")


def check_drum(folder):
    scene, image = shown(folder)
    check_sources(folder, ["particles", "surfaces", "edges of surfaces", "space", "title", "time"])
    up, eye = np.array(scene.view.CameraViewUp), np.array(scene.view.CameraPosition) - scene.view.CameraFocalPoint
    require(up[2] > 0.8 and eye[2] > 0, f"{folder}: gravity does not point down")
    drawn = (image.min(axis=2) < 250).mean()
    require(0.15 < drawn < 0.7, f"{folder}: a share of {drawn} of the picture is drawn")
    try:
        shown_view.show(str(folder), field="colour")
        require(False, f"{folder}: takes a field that is not there")
    except shown_view.Trouble as trouble:
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
    require(len(sys.argv) == 3, "usage: pvbatch test_paraview.py NET_400 DRUM_LIFTERS")
    net, drum = (pathlib.Path(path).resolve() for path in sys.argv[1:])
    check_net(net)
    check_drum(drum)
    check_file(drum)
    print("what ParaView shows of both is right", flush=True)


main()
