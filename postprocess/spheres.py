"""Lit spheres through VTK, rendered off screen.

Run as a program, it tells by its exit code whether VTK can do so here.
"""

import os
import sys

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

if sys.platform == "linux" and not os.environ.get("DISPLAY"):
    os.environ.setdefault(
        "VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow"
    )  # else it looks for a display and warns


class SphereRenderer:
    def __init__(self, pixels, center, axes_of_picture, half_height, box):
        """pixels: width, height; axes_of_picture: right, up, towards the eye; box: outline's corners [m]."""
        self._data = vtk.vtkPolyData()
        ball = vtk.vtkSphereSource()
        ball.SetRadius(1.0)
        ball.SetThetaResolution(20)
        ball.SetPhiResolution(14)
        mapper = vtk.vtkGlyph3DMapper()
        mapper.SetInputData(self._data)
        mapper.SetSourceConnection(ball.GetOutputPort())
        mapper.SetScaleModeToScaleByMagnitude()
        mapper.SetScaleArray("radius")
        mapper.SelectColorArray("color")
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SetColorModeToDirectScalars()
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().SetAmbient(0.25)
        actor.GetProperty().SetDiffuse(0.75)
        actor.GetProperty().SetSpecular(0.15)
        actor.GetProperty().SetSpecularPower(30)

        renderer = vtk.vtkRenderer()
        renderer.SetBackground(1, 1, 1)
        renderer.AddActor(actor)
        renderer.AddActor(self._outline(box))
        self._aim(renderer, center, axes_of_picture, half_height, np.ptp(box, axis=0).max())
        self._window = vtk.vtkRenderWindow()
        self._window.SetOffScreenRendering(1)
        self._window.SetMultiSamples(0)
        self._window.SetSize(int(pixels[0]), int(pixels[1]))
        self._window.AddRenderer(renderer)

    @staticmethod
    def _outline(box):
        source = vtk.vtkOutlineSource()
        low, high = box.min(axis=0), box.max(axis=0)
        source.SetBounds(low[0], high[0], low[1], high[1], low[2], high[2])
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputConnection(source.GetOutputPort())
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(0.6, 0.6, 0.6)
        actor.GetProperty().LightingOff()
        return actor

    @staticmethod
    def _aim(renderer, center, axes_of_picture, half_height, extent):
        camera = renderer.GetActiveCamera()
        camera.ParallelProjectionOn()
        camera.SetParallelScale(half_height)
        camera.SetFocalPoint(*center)
        camera.SetPosition(*(center + 5 * extent * axes_of_picture[2]))
        camera.SetViewUp(*axes_of_picture[1])
        camera.SetClippingRange(extent, 9 * extent)
        renderer.AutomaticLightCreationOff()
        light = vtk.vtkLight()
        light.SetLightTypeToCameraLight()
        light.SetPosition(-0.5, 0.7, 1)
        renderer.AddLight(light)

    def image(self, points, radii, colors):
        """Pixels [height][width][3], 0..255; colors [n][3] in 0..1."""
        coordinates = vtk.vtkPoints()
        coordinates.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
        self._data.SetPoints(coordinates)
        for name, values in (("radius", radii), ("color", np.round(255 * colors).astype(np.uint8))):
            array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
            array.SetName(name)
            self._data.GetPointData().AddArray(array)
        self._data.Modified()
        self._window.Render()
        grab = vtk.vtkWindowToImageFilter()
        grab.SetInput(self._window)
        grab.ReadFrontBufferOff()
        grab.Update()
        width, height, _ = grab.GetOutput().GetDimensions()
        return vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).reshape(height, width, 3)[::-1]


if __name__ == "__main__":
    corners = np.array([[-1.0, -1, -1], [1, 1, 1]])
    sphere = SphereRenderer((64, 64), np.zeros(3), np.eye(3), 1.0, corners)
    drawn = sphere.image(np.zeros((1, 3)), np.full(1, 0.5), np.array([[0.0, 0.0, 1.0]]))
    sys.exit(0 if drawn[32, 32, 2] > drawn[32, 32, 0] else 1)  # blue in the middle
