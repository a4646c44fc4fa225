"""Shows the results of a run in ParaView: particles and bodies as lit spheres of true size, meshes, bars, joints,
springs and cylinders as in the pictures of scree-post, contacts as tubes, the domain, time and title, and one colour
scale.

    pvbatch view.py RESULT_DIR -o picture.png [--time T] [--color FIELD] [--no-contacts] [--size WIDTH HEIGHT]
    paraview --script=RESULT_DIR/view.py            # made by scree-post paraview RESULT_DIR; or File > Load State

As a macro it shows the results of the active source. Needs ParaView 5.11 or newer and only ParaView's own Python. It
reads the .xdmf files before version 5.13, and the .vtkhdf files from 5.13 on.
"""

import argparse
import json
import math
import os
import sys

import numpy as np
from paraview import simple

if "results" not in sys.modules:  # contained in the file that scree-post paraview makes
    sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import results
from colors import BODY, CATEGORIES, FLOOR, FORCES, INK, PALE, PARTICLE, PRESSURES, SPEEDS, color_by, font_size, paint
from results import (NothingToShow, box_around, information, largest, open_series, resolved_deck, rounded_up,
                     sampled, times_of)

GLYPHS = 20000  # number of particles up to which spheres are triangles; more are points shaded as spheres
ROOM = 0.84  # fraction of the picture for the scene
STRAYS = 1  # percentage of particles that may be outside the picture, at each end of each axis
SEEN_THROUGH = 0.55  # opacity of particles if contacts are shown
HOLLOW, GLASS = ("drum", "pipe", "funnel", "hopper", "file"), 0.35  # meshes that may hold particles; their opacity
AZIMUTH, ELEVATION = 30, 26  # direction of view in 3D [degrees]
SLOW = 0.1  # smallest end of the speed scale over sqrt(g d): particles at rest have the lowest colour
LINK_BALL = 0.014  # radius of the balls for forces in links over the longest side of the scene
NAMED = {"group": "particles", "material": "materials"}  # fields that count the elements of a list of the deck


class Scene:
    """The objects of one folder in one view."""

    def __init__(self, folder, view, contacts=True, field=None):
        """contacts: whether they are shown. field: that colours the particles; None: chosen automatically."""
        self.folder, self.view, self.deck, self.bars = folder, view, resolved_deck(folder), []
        self.domain = self.deck.get("space", {})
        self.planar = self.domain.get("dimension", 3) == 2
        kinds = ("particles", "bodies", "surfaces", "links", *["contacts"] * contacts)
        self.sources = {kind: source for kind in kinds if (source := open_series(folder, kind))}
        if not self.sources:
            raise NothingToShow(f"{folder}: holds no snapshots of a run that this ParaView can read")
        self.times = sorted({time for source in self.sources.values() for time in times_of(source)})
        self.field = field or "velocity"
        self.to_last()
        self.low, self.high = self.bounds()
        self.scaled, self.limit = self.choose_scale(field)

    def to_last(self):
        """Updates every source to the last time with points, so that its fields are known."""
        for source in self.sources.values():
            for time in reversed(times_of(source)):
                source.UpdatePipeline(time)
                if source.GetDataInformation().GetNumberOfPoints() > 0:
                    break

    def choose_scale(self, field):
        """The kind of objects that gets the colour scale, and the end of the scale: contacts if they are shown and no
        field of particles is requested, otherwise the first of particles, surfaces and links with positive values."""
        choices = [("particles", "POINTS", self.field), ("surfaces", "CELLS", "pressure"),
                   ("links", "CELLS", "reaction")]
        if field is None:
            choices.insert(0, ("contacts", "CELLS", "normal_force"))
        for kind, association, name in choices:
            source = self.sources.get(kind)
            if source is None or information(source, association, name) is None:
                continue
            limit = largest(source, association, name, times_of(source), (self.low, self.high))
            if kind == "particles":
                limit = max(limit, self.slow() if name == "velocity" else 0.0) or 1.0
            if limit > 0:
                self.to_last()
                return kind, rounded_up(limit)
        self.to_last()
        return None, 1.0

    def slow(self):
        """Smallest upper end of the speed scale [m/s]."""
        radii = information(self.sources["particles"], "POINTS", "radius")
        diameter = sum(radii.GetRange(0)) if radii else 0.0
        return SLOW * math.sqrt(np.linalg.norm(self.deck.get("gravity", [0.0])) * diameter)

    def extent(self):
        return float((self.high - self.low).max())

    def lift(self):
        """Planar runs: offset [m] of joints and lines above the discs of bodies, which are spheres here."""
        bodies = self.sources.get("bodies")
        radii = information(bodies, "POINTS", "radius") if bodies and self.planar else None
        return radii.GetRange(0)[1] if radii else 0.0

    def color(self, display, field, colors):
        """Colours by the scale; groups and materials by name if the deck is known."""
        tables = self.deck.get(NAMED.get(field))
        names = [table.get("name") or str(number) for number, table in enumerate(tables)] if tables else None
        self.bars.append(color_by(display, self.view, field, self.limit, CATEGORIES if names else colors, names))

    def show_balls(self, kind):
        """Points as spheres with the radius in their field."""
        source = self.sources[kind]
        display = simple.Show(source, self.view)
        if source.GetDataInformation().GetNumberOfPoints() <= GLYPHS:
            display.SetRepresentationType("3D Glyphs")
            display.GlyphType = "Sphere"
            ball = display.GlyphType
            ball.Radius, ball.ThetaResolution, ball.PhiResolution = 1.0, 24, 18
            display.Scaling, display.ScaleMode, display.ScaleFactor = 1, "Magnitude", 1.0
            display.SelectScaleArray = "radius"
        else:
            display.SetRepresentationType("Point Gaussian")
            display.ShaderPreset, display.GaussianRadius = "Sphere", 1.0
            display.ScaleByArray, display.SetScaleArray, display.UseScaleFunction = 1, ["POINTS", "radius"], 0
        display.Specular, display.SpecularPower = 0.15, 30
        return display

    def show_particles(self):
        source = self.sources["particles"]
        if not source.GetDataInformation().GetNumberOfPoints():
            return
        if information(source, "POINTS", self.field) is None:
            raise NothingToShow(f"{self.folder}: particles have no field {self.field}; there are "
                                f"{', '.join(sorted(source.PointData.keys()))}")
        display = self.show_balls("particles")
        if self.scaled == "particles":
            self.color(display, self.field, SPEEDS)
        else:
            paint(display, PARTICLE)
        if "contacts" in self.sources:
            display.Opacity = SEEN_THROUGH

    @staticmethod
    def drawn(name, source, call):
        """A filter that calls a function of rods.py with the data of a source and an output. The filter contains the
        source code, so that a saved state of ParaView includes it."""
        made = simple.ProgrammableFilter(registrationName=name, Input=source)
        made.OutputDataSetType = "vtkPolyData"
        made.Script = "import json\n\nnames = {'json': json, 'data': self.GetInputDataObject(0, 0), 'output': " \
                      f"self.GetPolyDataOutput()}}\nexec({results.drawing() + call!r}, names)\n"
        return made

    def show_bodies(self):
        """Discs and spheres of bodies, and the mechanism."""
        source = self.sources["bodies"]
        paint(self.show_balls("bodies"), BODY)
        if not self.deck:
            return
        rods = self.drawn("mechanism", source, f"drawn(data, json.loads({json.dumps(self.deck)!r}), {self.extent()!r}, "
                          f"{self.lift()!r}, output)")
        display = simple.Show(rods, self.view)
        simple.ColorBy(display, ("CELLS", "color"))
        display.MapScalars, display.Specular, display.SpecularPower = 0, 0.15, 30

    def show_surfaces(self):
        """Meshes with their sharp edges; semi-transparent if there are drums or similar meshes that hold particles."""
        source = self.sources["surfaces"]
        display = simple.Show(source, self.view)
        display.SetRepresentationType("Surface")
        hollow = not self.deck or any(mesh["kind"] in HOLLOW for mesh in self.deck.get("meshes", []))
        display.Opacity, display.Ambient, display.Diffuse = GLASS if hollow else 1.0, 0.3, 0.7
        if self.scaled == "surfaces":
            self.color(display, "pressure", PRESSURES)
        else:
            paint(display, BODY)
        triangles = simple.ExtractSurface(registrationName="triangles of surfaces", Input=source)
        edges = simple.FeatureEdges(registrationName="edges of surfaces", Input=triangles, FeatureAngle=30)
        paint(simple.Show(edges, self.view, LineWidth=1.5), INK)

    def show_links(self):
        """Forces in joints and force elements as balls, if they have the colour scale; otherwise hidden lines."""
        if self.scaled != "links":
            simple.Hide(self.sources["links"], self.view)
            return
        call = f"forces(data, {LINK_BALL * self.extent()!r}, {self.lift()!r}, output)"
        balls = self.drawn("forces in links", self.sources["links"], call)
        balls.UpdatePipeline(self.times[-1])
        self.color(simple.Show(balls, self.view), "reaction", FORCES)

    def show_contacts(self):
        """Tubes with a thickness that grows with the normal force, up to tenfold."""
        source = self.sources["contacts"]
        if information(source, "CELLS", "normal_force") is None:
            return
        box = (self.low, self.high)
        limit = largest(source, "CELLS", "normal_force", times_of(source), box) or 1.0
        self.to_last()
        lines = simple.ExtractSurface(registrationName="lines of contacts", Input=source)
        of_points = simple.CellDatatoPointData(registrationName="forces at their ends", Input=lines)
        thickness = simple.Calculator(registrationName="thickness of contacts", Input=of_points)
        thickness.AttributeType, thickness.ResultArrayName = "Point Data", "thickness"
        thickness.Function = f"{1.5e-3 * self.extent()}*(1+9*min(1,max(0,normal_force/{limit})))"
        tubes = simple.Tube(registrationName="contact forces", Input=thickness)
        tubes.Scalars, tubes.VaryRadius, tubes.Radius = ["POINTS", "thickness"], "By Absolute Scalar", 1.0
        display = simple.Show(tubes, self.view)
        if self.scaled == "contacts":
            self.color(display, "normal_force", FORCES)
        else:
            paint(display, INK)

    def corners(self):
        """Low and high corner of the domain."""
        low, high = self.domain.get("min"), self.domain.get("max")
        if low is None or high is None:
            bounds = np.array(next(iter(self.sources.values())).GetDataInformation().GetBounds())
            return bounds[::2], bounds[1::2]
        return np.array([*low, 0.0][:3], dtype=float), np.array([*high, 0.0][:3], dtype=float)

    def show_box(self, name, low, high, color, kind):
        box = simple.Box(registrationName=name, Center=list((low + high) / 2))
        box.XLength, box.YLength, box.ZLength = map(float, high - low)
        display = simple.Show(box, self.view)
        display.SetRepresentationType(kind)
        paint(display, color)

    def show_space(self):
        """Edges of the domain, clipped to the scene, and its floor if that is a wall."""
        domain = self.corners()
        low, high = np.maximum(domain[0], self.low), np.minimum(domain[1], self.high)
        if not (high >= low).all():
            return
        self.show_box("space", low, high, PALE, "Outline")
        up = self.up()
        axis = int(np.argmax(np.abs(up)))
        side, level = ("_max", domain[1]) if up[axis] < 0 else ("_min", domain[0])
        if not self.planar and self.domain.get("xyz"[axis] + side) == "wall" and low[axis] <= level[axis] <= high[axis]:
            ends = [np.where(np.arange(3) == axis, level, corner) for corner in (low, high)]
            self.show_box("floor", *ends, FLOOR, "Surface")

    def show_text(self):
        title = simple.Text(registrationName="title", Text=self.deck.get("title") or os.path.basename(self.folder))
        time = simple.AnnotateTimeFilter(registrationName="time", Input=next(iter(self.sources.values())))
        time.Format = "t = {time:.4g} s"
        for source, height, lines in ((title, 0.93, 38), (time, 0.885, 50)):
            display = simple.Show(source, self.view)
            display.WindowLocation, display.Position = "Any Location", [0.02, height]
            display.Color, display.FontSize = INK, font_size(self.view, lines)

    def up(self):
        """Unit vector opposite to gravity; without gravity z, in planar runs y."""
        gravity = np.array([*self.deck.get("gravity", []), 0.0, 0.0, 0.0][:3], dtype=float)
        if np.linalg.norm(gravity) > 0:
            return -gravity / np.linalg.norm(gravity)
        return np.eye(3)[1 if self.planar else 2]

    def bounds(self):
        """Box around the scene [m]: particles inside the domain, and all other objects. Without particles the box
        covers the motion of the mechanism over time."""
        boxes, domain = [], self.corners()
        for kind, source in self.sources.items():
            least, most = box_around(source, STRAYS if kind == "particles" else 0)
            if kind in ("particles", "contacts"):
                least, most = np.maximum(least, domain[0]), np.minimum(most, domain[1])
            boxes.append((least, most))
        if "particles" not in self.sources:
            boxes += self.swept_boxes()
        boxes = [(least, most) for least, most in boxes if (most >= least).all()]
        low = np.min([least for least, _ in boxes], axis=0) if boxes else domain[0]
        high = np.max([most for _, most in boxes], axis=0) if boxes else domain[1]
        if self.planar:  # lines of planar runs have an offset along z
            low, high = low * [1, 1, 0], high * [1, 1, 0]
        return (low, high) if (high > low).any() else domain

    def swept_boxes(self):
        """Boxes around bodies, meshes and links at some of the times."""
        boxes = []
        for kind in ("bodies", "surfaces", "links"):
            for time in sampled(times_of(self.sources[kind])) if kind in self.sources else ():
                self.sources[kind].UpdatePipeline(time)
                boxes.append(box_around(self.sources[kind]))
        self.to_last()
        return boxes

    def directions(self):
        """Unit vectors of the picture: right, up and towards the viewer; planar runs along z, 3D runs from the front
        and above."""
        if self.planar:
            return np.eye(3)
        up = self.up()
        first = np.eye(3)[0] if abs(up[0]) < 0.9 else np.eye(3)[1]
        first = first - (first @ up) * up
        first /= np.linalg.norm(first)
        second = np.cross(up, first)
        azimuth, elevation = math.radians(AZIMUTH), math.radians(ELEVATION)
        right = math.cos(azimuth) * first + math.sin(azimuth) * second
        front = math.sin(azimuth) * first - math.cos(azimuth) * second
        eye = math.cos(elevation) * front + math.sin(elevation) * up
        return np.array([right, np.cross(eye, right), eye])

    def aim(self):
        """Places the camera so that the scene fits beside the text."""
        view, low, high, axes = self.view, self.low, self.high, self.directions()
        center = (low + high) / 2
        corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
        right, up, near = ((corners - center) @ axes.T).T
        half = np.maximum(np.abs(up), 1.25 * np.abs(right) * view.ViewSize[1] / view.ViewSize[0]) / ROOM
        distance = (near + half / math.tan(math.radians(view.CameraViewAngle / 2))).max()
        half = half.max()
        # The title is above the scene, the colour scale beside it.
        center = center + (1 - ROOM) * half * (0.5 * axes[0] + 0.8 * axes[1])
        view.CameraParallelProjection, view.CameraParallelScale = int(self.planar), half
        view.InteractionMode = "2D" if self.planar else "3D"
        view.CameraFocalPoint, view.CenterOfRotation, view.CameraViewUp = list(center), list(center), list(axes[1])
        view.CameraPosition = list(center + distance * axes[2])

    def show(self):
        """Shows all objects."""
        for kind in ("particles", "bodies", "surfaces", "links", "contacts"):
            if kind in self.sources:
                getattr(self, f"show_{kind}")()
        self.show_space()
        self.show_text()


def show(folder, field=None, time=None, contacts=True):
    """Shows a folder in the active view, at the snapshot nearest to a time [s] or at the last one, with or without
    contacts. field: that colours the particles; None: speed, or, if contacts are shown, these by their force. Returns
    the Scene."""
    view = simple.GetActiveViewOrCreate("RenderView")
    simple._DisableFirstRenderCameraReset()  # it would move the camera
    view.UseColorPaletteForBackground, view.OrientationAxesLabelColor = 0, INK
    view.BackgroundColorMode, view.Background = "Single Color", [1.0, 1.0, 1.0]
    if hasattr(view, "UseSSAO"):  # ambient occlusion
        view.UseSSAO = 1
    scene = Scene(os.path.abspath(folder), view, contacts, field)
    scene.show()
    wanted, animation = scene.times[-1] if time is None else time, simple.GetAnimationScene()
    animation.UpdateAnimationUsingDataTimeSteps()
    animation.AnimationTime = min(scene.times, key=lambda each: abs(each - wanted))
    scene.aim()
    simple.Render(view)
    return scene


def folder_at_hand():
    """The folder in the constant of this file, of the active source, or the current folder."""
    source = simple.GetActiveSource()
    name = getattr(source, "FileName", None) or getattr(source, "FileNames", None) or ""
    opened = name if isinstance(name, str) else name[0]
    for folder in (results.FOLDER, os.path.dirname(opened), os.getcwd()):
        if os.path.isdir(folder or "") and any(name.endswith((".vtkhdf", ".xdmf")) for name in os.listdir(folder)):
            return folder
    raise NothingToShow("no results to show: open particles.xdmf or particles.vtkhdf of a run first, or use a view.py "
                        "made by scree-post paraview RESULT_DIR")


def main():
    if not os.path.basename(sys.argv[0]).endswith(".py"):  # ParaView itself: its output window shows errors
        show(folder_at_hand())
        return
    parser = argparse.ArgumentParser(prog="view.py")
    parser.add_argument("folder", nargs="?", metavar="RESULT_DIR")
    parser.add_argument("-o", "--output", metavar="FILE", help="a picture to save: .png, .jpg, .tif")
    parser.add_argument("--time", type=float, metavar="T", help="time of the snapshot [s]; default: the last")
    parser.add_argument("--color", metavar="FIELD", help="field that colours the particles; default: velocity, or none "
                                                         "if contacts are shown, which have the colours then")
    parser.add_argument("--no-contacts", action="store_true", help="omit contacts; particles are opaque")
    parser.add_argument("--size", type=int, nargs=2, default=[1600, 1200], metavar=("WIDTH", "HEIGHT"))
    arguments = parser.parse_args()
    try:
        simple.GetActiveViewOrCreate("RenderView").ViewSize = arguments.size
        show(arguments.folder or folder_at_hand(), arguments.color, arguments.time, not arguments.no_contacts)
        if arguments.output:
            simple.SaveScreenshot(arguments.output, simple.GetActiveView(), ImageResolution=arguments.size)
    except NothingToShow as error:
        print(f"error: {error}", file=sys.stderr, flush=True)
        os._exit(2)  # pvbatch returns 0 for SystemExit


if __name__ == "__main__":
    import view  # again, as a module: programmable filters replace max, all and others in __main__

    view.main()
