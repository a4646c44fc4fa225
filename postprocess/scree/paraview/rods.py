"""Bodies, joints, springs and cylinders as tubes and balls, as in the pictures of scree-post. Runs in a programmable
filter of ParaView on the points of bodies."""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkAppendPolyData, vtkGlyph3D, vtkTubeFilter
from vtkmodules.vtkFiltersSources import vtkSphereSource

from scree.fields import POSITION
from scree.pictures.mechanism import Mechanism
from scree.pictures.model import Model
from scree.pictures.styles import BALL, EDGE_COLOR, JOINTS, LINES, SMALL, TUBE


BETWEEN_POINTS = (1, 2)  # kinds of links: spring-dampers without and with an actuator


class Bodies:
    """One snapshot in VTK data, with the interface of scree.series.Series."""

    def __init__(self, data):
        self._data = data

    def has(self, name):
        return bool(self._data.GetPointData().HasArray(name))

    def rows(self, snapshot, name):
        array = self._data.GetPoints().GetData() if name == POSITION else self._data.GetPointData().GetArray(name)
        return vtk_to_numpy(array)


def points_of(positions):
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(positions, dtype=float).reshape(-1, 3), deep=True))
    return points


def tubes(lines, radius):
    """Lines [n][points][3] as a VTK algorithm."""
    count, length = lines.shape[:2]
    cells = vtkCellArray()
    offsets, corners = np.arange(0, count * length + 1, length), np.arange(count * length)
    cells.SetData(numpy_to_vtk(offsets.astype(np.int64), deep=True), numpy_to_vtk(corners.astype(np.int64), deep=True))
    data = vtkPolyData()
    data.SetPoints(points_of(lines))
    data.SetLines(cells)
    tube = vtkTubeFilter()
    tube.SetInputData(data)
    tube.SetRadius(radius)
    tube.SetNumberOfSides(16)
    tube.CappingOn()
    return tube


def balls(positions, radius):
    """Points [n][3] as a VTK algorithm."""
    data, ball, glyphs = vtkPolyData(), vtkSphereSource(), vtkGlyph3D()
    data.SetPoints(points_of(positions))
    ball.SetRadius(radius)
    ball.SetThetaResolution(20)
    ball.SetPhiResolution(14)
    glyphs.SetInputData(data)
    glyphs.SetSourceConnection(ball.GetOutputPort())
    glyphs.ScalingOff()
    return glyphs


def colored(algorithm, color):
    """Output of the algorithm with a colour (#rrggbb) on each cell."""
    algorithm.Update()
    data = algorithm.GetOutput()
    red_green_blue = np.array([int(color[k : k + 2], 16) for k in (1, 3, 5)], dtype=np.uint8)
    array = numpy_to_vtk(np.tile(red_green_blue, (data.GetNumberOfCells(), 1)), deep=True)
    array.SetName("color")
    data.GetCellData().AddArray(array)
    return data


def drawn(bodies, deck, extent, lift, output):
    """bodies, output: VTK data of an instant; deck: resolved; extent: longest side of the scene [m]; lift: offset along
    z of objects above the shapes [m]."""
    model = Model(deck)
    series = Bodies(bodies) if bodies.GetNumberOfPoints() else None
    lines, joints = Mechanism(model, lambda snapshot: model.motion(series, snapshot), SMALL * extent).draw(0)
    parts = vtkAppendPolyData()
    parts.AddInputData(vtkPolyData())
    for style, (color, width, above) in LINES.items():
        if len(lines[style] if style in lines else ()):
            raised = lines[style] + np.array([0.0, 0.0, lift if above else 0.0])
            parts.AddInputData(colored(tubes(raised, TUBE * width * extent), color))
    pins = np.concatenate([joints[kind] for kind in JOINTS]) + np.array([0.0, 0.0, lift])
    if len(pins):
        parts.AddInputData(colored(balls(pins, BALL * extent), EDGE_COLOR))
    parts.Update()
    output.ShallowCopy(parts.GetOutput())


def forces(links, radius, lift, output):
    """Balls with the force of links, at pins and bushings, and in the middle of elements between two points. links,
    output: VTK data of an instant; radius [m]; lift: as above."""
    if not links.GetNumberOfCells():
        return
    ends = vtk_to_numpy(links.GetPoints().GetData()).reshape(-1, 2, 3)
    kinds = vtk_to_numpy(links.GetCellData().GetArray("kind"))
    positions = np.where(np.isin(kinds, BETWEEN_POINTS)[:, None], ends.mean(axis=1), ends[:, 0])
    positions = positions + np.array([0.0, 0.0, lift])
    ball = balls(positions, radius)
    sizes = np.linalg.norm(vtk_to_numpy(links.GetCellData().GetArray("reaction")), axis=1)
    array = numpy_to_vtk(np.ascontiguousarray(sizes), deep=True)
    array.SetName("reaction")
    ball.GetInput().GetPointData().AddArray(array)
    ball.Update()
    output.ShallowCopy(ball.GetOutput())
