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


def polylines(lines):
    """VTK's form of lines [n][points][3]."""
    count, length = lines.shape[:2]
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(lines.reshape(-1, 3)), deep=True))
    cells = vtk.vtkCellArray()
    for i in range(count):
        cells.InsertNextCell(length, range(i * length, (i + 1) * length))
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    data.SetLines(cells)
    return data


class SphereRenderer:
    def __init__(self, pixels, center, axes_of_picture, half_height, extent):
        """pixels: width, height; axes_of_picture: right, up, towards the eye; extent: of the scene [m]."""
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

        self._renderer = renderer = vtk.vtkRenderer()
        renderer.SetBackground(1, 1, 1)
        renderer.AddActor(actor)
        self._lines, self._triangles = {}, {}
        self._aim(renderer, center, axes_of_picture, half_height, extent)
        self._window = vtk.vtkRenderWindow()
        self._window.SetOffScreenRendering(1)
        self._window.SetMultiSamples(0)
        self._window.SetSize(int(pixels[0]), int(pixels[1]))
        self._window.AddRenderer(renderer)

    def _add(self, source, color):
        """An actor without light, of what a VTK algorithm or data set gives."""
        mapper = vtk.vtkPolyDataMapper()
        if isinstance(source, vtk.vtkPolyData):
            mapper.SetInputData(source)
        else:
            mapper.SetInputConnection(source.GetOutputPort())
        mapper.ScalarVisibilityOff()
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(*color)
        actor.GetProperty().LightingOff()
        self._renderer.AddActor(actor)
        return actor

    def add_box(self, low, high):
        source = vtk.vtkOutlineSource()
        source.SetBounds(low[0], high[0], low[1], high[1], low[2], high[2])
        self._add(source, (0.6, 0.6, 0.6))

    def add_face(self, polygon, color, opacity):
        """A plane polygon [n][3]."""
        data = polylines(polygon[None])
        data.SetPolys(data.GetLines())
        data.SetLines(None)
        self._add(data, color).GetProperty().SetOpacity(opacity)

    def set_lines(self, style, lines, color, radius):
        """Lines [n][points][3] as tubes, in place of those of the same style."""
        if style in self._lines:
            self._renderer.RemoveActor(self._lines.pop(style))
        if len(lines) == 0:
            return
        tube = vtk.vtkTubeFilter()
        tube.SetInputData(polylines(lines))
        tube.SetRadius(radius)
        tube.SetNumberOfSides(10)
        tube.CappingOn()
        self._lines[style] = self._add(tube, color)
        self._lines[style].GetProperty().LightingOn()

    def set_triangles(self, style, points, triangles, color, opacity, colors=None):
        """In place of those of the same style. colors: [triangles][4] of 0 to 255, in place of the one."""
        if style in self._triangles:
            self._renderer.RemoveActor(self._triangles.pop(style))
        if len(triangles) == 0:
            return
        corners = vtk.vtkPoints()
        corners.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
        cells = vtk.vtkCellArray()
        offsets = np.arange(0, 3 * len(triangles) + 1, 3, dtype=np.int64)
        cells.SetData(*(numpy_to_vtk(values, deep=True) for values in (offsets, triangles.reshape(-1))))
        data = vtk.vtkPolyData()
        data.SetPoints(corners)
        data.SetPolys(cells)
        self._triangles[style] = self._add(data, color)
        if colors is not None:
            data.GetCellData().SetScalars(numpy_to_vtk(np.ascontiguousarray(colors), deep=True))
            self._triangles[style].GetMapper().ScalarVisibilityOn()
            self._triangles[style].ForceTranslucentOn()
            opacity = 1
        self._triangles[style].GetProperty().LightingOn()
        self._triangles[style].GetProperty().SetAmbient(0.3)  # what is turned from the light is not black
        self._triangles[style].GetProperty().SetDiffuse(0.7)
        self._triangles[style].GetProperty().SetInterpolationToFlat()
        self._triangles[style].GetProperty().SetOpacity(opacity)

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
    sphere = SphereRenderer((64, 64), np.zeros(3), np.eye(3), 1.0, 2.0)
    drawn = sphere.image(np.zeros((1, 3)), np.full(1, 0.5), np.array([[0.0, 0.0, 1.0]]))
    sys.exit(0 if drawn[32, 32, 2] > drawn[32, 32, 0] else 1)  # blue in the middle
