"""Lit spheres and meshes on a ground plane, rendered off screen by VTK.

Run as a program, it returns 0 if VTK can render here.
"""

import os
import sys

import numpy as np
import vtk
from PIL import Image, ImageFilter
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

if sys.platform == "linux" and not os.environ.get("DISPLAY"):
    os.environ.setdefault(
        "VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow"
    )  # otherwise VTK searches a display and warns

# Directions of the lights to the right, upwards and towards the viewer, and their intensities.
LIGHTS = ((-0.6, 0.9, 1.0, 0.8), (0.9, 0.2, 0.8, 0.25), (0.0, 0.2, 1.0, 0.22))
SUN = np.array([-0.35, 1.0, 0.25])  # direction of the light that casts shadows: right, up, towards the viewer
SHADOW, SOFTNESS = 0.42, 0.02  # opacity of shadows; width of their edge over that of the shadow map
OCCLUSION, SAMPLES = 0.035, 48  # ambient occlusion: radius over the extent of the scene; number of samples
SHARP = 30  # angle between faces above which an edge is not smoothed [degrees]


def polylines(lines):
    """Lines [n][points][3] as vtkPolyData."""
    count, length = lines.shape[:2]
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(lines.reshape(-1, 3)), deep=True))
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    data.SetLines(cells(np.arange(count * length).reshape(count, length)))
    return data


def cells(corners):
    """Cells [n][k] of points as vtkCellArray."""
    found = vtk.vtkCellArray()
    offsets = np.arange(0, corners.size + 1, max(corners.shape[1], 1), dtype=np.int64)
    found.SetData(*(numpy_to_vtk(values, deep=True) for values in (offsets, corners.reshape(-1).astype(np.int64))))
    return found


class SphereRenderer:
    def __init__(self, pixels, center, axes_of_picture, half_height, extent):
        """pixels: width, height; axes_of_picture: right, up, towards the viewer; extent: of the scene [m]."""
        self._center, self._axes, self._extent = center, axes_of_picture, extent
        self._renderer = renderer = vtk.vtkRenderer()
        renderer.SetBackground(1, 1, 1)
        self._add_spheres()
        self._lines, self._triangles, self._without_shadow = {}, {}, []
        self._ground = None
        self._aim(half_height)
        self._light()
        self._window = vtk.vtkRenderWindow()
        self._window.SetOffScreenRendering(1)
        self._window.SetMultiSamples(0)
        self._window.SetSize(int(pixels[0]), int(pixels[1]))
        self._window.AddRenderer(renderer)

    def _add_spheres(self):
        """Spheres are points that the graphics card shades as spheres."""
        self._data = vtk.vtkPolyData()
        mapper = vtk.vtkOpenGLSphereMapper()
        mapper.SetInputData(self._data)
        mapper.SetScaleArray("radius")
        mapper.SelectColorArray("color")
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SetColorModeToDirectScalars()
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().SetAmbient(0.22)
        actor.GetProperty().SetDiffuse(0.85)
        actor.GetProperty().SetSpecular(0.12)
        actor.GetProperty().SetSpecularPower(30)
        self._renderer.AddActor(actor)

    def _aim(self, half_height):
        camera = self._camera = self._renderer.GetActiveCamera()
        camera.ParallelProjectionOn()
        camera.SetParallelScale(half_height)
        camera.SetFocalPoint(*self._center)
        camera.SetPosition(*(self._center + 5 * self._extent * self._axes[2]))
        camera.SetViewUp(*self._axes[1])
        camera.SetClippingRange(self._extent, 9 * self._extent)

    def _light(self):
        renderer = self._renderer
        renderer.AutomaticLightCreationOff()
        for *position, intensity in LIGHTS:
            light = vtk.vtkLight()
            light.SetLightTypeToCameraLight()
            light.SetPosition(*position)
            light.SetIntensity(intensity)
            renderer.AddLight(light)
        renderer.SetUseSSAO(True)
        renderer.SetSSAORadius(OCCLUSION * self._extent)
        renderer.SetSSAOBias(0.005 * self._extent)
        renderer.SetSSAOKernelSize(SAMPLES)
        renderer.SetSSAOBlur(True)

    def _add(self, source, color):
        """An unlit actor for a VTK algorithm or data set."""
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
        actor = self._add(source, (0.72, 0.72, 0.72))
        actor.GetProperty().SetOpacity(0.8)
        self._without_shadow.append(actor)

    def add_face(self, polygon, color, opacity):
        """A plane polygon [n][3]."""
        data = polylines(polygon[None])
        data.SetPolys(data.GetLines())
        data.SetLines(None)
        self._add(data, color).GetProperty().SetOpacity(opacity)

    def add_ground(self, up, height):
        """A ground plane that shows only shadows. height: along the unit vector up [m]."""
        right, top, _ = self._sun_axes(up)
        self._half_width = 1.5 * self._extent  # half width of the shadow map [m]
        middle = self._center + (height - self._center @ up) * up
        sides = np.array([right - (right @ up) * up, top - (top @ up) * up])
        sides /= np.linalg.norm(sides, axis=1)[:, None]
        signs = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
        corners = middle + self._half_width * signs @ sides
        data = polylines(corners[None])
        data.SetPolys(data.GetLines())
        data.SetLines(None)
        texture = 0.5 + (corners - middle) @ np.array([right, top]).T / (2 * self._half_width)
        data.GetPointData().SetTCoords(numpy_to_vtk(np.ascontiguousarray(texture), deep=True))
        self._ground = self._add(data, (1, 1, 1))
        self._ground.ForceTranslucentOn()
        self._texture = vtk.vtkTexture()
        self._texture.InterpolateOn()
        self._texture.RepeatOff()
        self._ground.SetTexture(self._texture)
        self._middle, self._up = middle, up
        self._without_shadow.append(self._ground)

    def _sun_axes(self, up):
        """Unit vectors of the shadow map: right, up, and towards the light."""
        sun = SUN[0] * self._axes[0] + SUN[1] * up + SUN[2] * np.cross(self._axes[0], up)
        sun /= np.linalg.norm(sun)
        right = np.cross(self._axes[1], sun)
        right /= np.linalg.norm(right)
        return np.array([right, np.cross(sun, right), sun])

    def set_lines(self, style, lines, color, radius):
        """Lines [n][points][3] as tubes; they replace lines of the same style."""
        if style in self._lines:
            self._renderer.RemoveActor(self._lines.pop(style))
        if len(lines) == 0:
            return
        tube = vtk.vtkTubeFilter()
        tube.SetInputData(polylines(lines))
        tube.SetRadius(radius)
        tube.SetNumberOfSides(12)
        tube.CappingOn()
        self._lines[style] = self._add(tube, color)
        self._lines[style].GetProperty().LightingOn()
        self._lines[style].GetProperty().SetAmbient(0.2)
        self._lines[style].GetProperty().SetDiffuse(0.85)

    def set_triangles(self, style, points, triangles, color, opacity, colors=None):
        """Replaces triangles of the same style. colors: [triangles][4] of 0 to 255, instead of `color`."""
        if style in self._triangles:
            self._renderer.RemoveActor(self._triangles.pop(style))
        if len(triangles) == 0:
            return
        corners = vtk.vtkPoints()
        corners.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
        data = vtk.vtkPolyData()
        data.SetPoints(corners)
        data.SetPolys(cells(triangles))
        if colors is not None:
            data.GetCellData().SetScalars(numpy_to_vtk(np.ascontiguousarray(colors), deep=True))
        normals = vtk.vtkPolyDataNormals()
        normals.SetInputData(data)
        normals.SetFeatureAngle(SHARP)
        normals.ConsistencyOff()
        actor = self._triangles[style] = self._add(normals, color)
        if colors is not None:
            actor.GetMapper().ScalarVisibilityOn()
            if (colors[:, 3] < 255).any():
                actor.ForceTranslucentOn()
            opacity = 1
        actor.GetProperty().LightingOn()
        actor.GetProperty().SetAmbient(0.35)  # faces away from the light are not black
        actor.GetProperty().SetDiffuse(0.8)
        actor.GetProperty().SetOpacity(opacity)

    def _cast_shadows(self):
        """Shadows of opaque objects on the ground: the area visible from the light, with soft edges."""
        sun, renderer = self._sun_axes(self._up), self._renderer
        camera = vtk.vtkCamera()
        camera.ParallelProjectionOn()
        camera.SetParallelScale(self._half_width)
        camera.SetFocalPoint(*self._middle)
        camera.SetPosition(*(self._middle + 5 * self._extent * sun[2]))
        camera.SetViewUp(*sun[1])
        camera.SetClippingRange(self._extent, 9 * self._extent)
        for actor in self._without_shadow:
            actor.VisibilityOff()
        renderer.SetUseSSAO(False)
        renderer.SetActiveCamera(camera)
        self._window.Render()
        width, height = self._window.GetSize()
        depths = vtk.vtkFloatArray()
        self._window.GetZbufferData(0, 0, width - 1, height - 1, depths)
        covered = vtk_to_numpy(depths).reshape(height, width) < 1
        for actor in self._without_shadow:
            actor.VisibilityOn()
        renderer.SetUseSSAO(True)
        renderer.SetActiveCamera(self._camera)
        self._set_shadows(covered)

    def _set_shadows(self, covered):
        """covered: [height][width]; the texture shows the central square, whose side is the height."""
        height, width = covered.shape
        size = min(height, 512)
        image = Image.fromarray((255 * covered).astype(np.uint8))
        image = image.resize((round(size * width / height), size), Image.Resampling.BOX)
        pad = (size - image.width) // 2
        square = Image.new("L", (size, size))
        square.paste(image, (pad, 0))
        soft = np.asarray(square.filter(ImageFilter.GaussianBlur(SOFTNESS * size)), dtype=float)
        pixels = np.zeros((size, size, 4), dtype=np.uint8)
        pixels[..., :3] = 30
        pixels[..., 3] = (SHADOW * soft).round()
        data = vtk.vtkImageData()
        data.SetDimensions(size, size, 1)
        data.GetPointData().SetScalars(numpy_to_vtk(pixels.reshape(-1, 4), deep=True))
        self._texture.SetInputData(data)

    def image(self, points, radii, colors):
        """Pixels [height][width][3], 0..255; colors [n][3] in 0..1."""
        coordinates = vtk.vtkPoints()
        coordinates.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
        self._data.SetPoints(coordinates)
        self._data.SetVerts(cells(np.arange(len(points)).reshape(-1, 1)))
        # The mapper expects radii in single precision.
        for name, values in (("radius", radii.astype(np.float32)), ("color", np.round(255 * colors).astype(np.uint8))):
            array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
            array.SetName(name)
            self._data.GetPointData().AddArray(array)
        self._data.Modified()
        if self._ground:
            self._cast_shadows()
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
    sys.exit(0 if drawn[32, 32, 2] > drawn[32, 32, 0] else 1)  # the centre must be blue
