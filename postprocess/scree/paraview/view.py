"""Shows the results of a run in ParaView: particles and bodies as lit spheres of true size, meshes, the bars, joints,
springs and cylinders that the pictures of scree-post have, contacts as tubes, the space, time and title, and one colour
scale.

    pvbatch view.py RESULT_DIR -o picture.png [--time T] [--color FIELD] [--no-contacts] [--size WIDTH HEIGHT]
    paraview --script=RESULT_DIR/view.py            # made by scree-post paraview RESULT_DIR; File > Load State, too

As a macro it shows the results that the active source was opened from. ParaView 5.11 or newer; in those before 5.13 the
.xdmf files are read, later the .vtkhdf files. Needs nothing but ParaView's own Python.
"""

import argparse
import json
import math
import os
import sys

import numpy as np
from paraview import simple

if "results" not in sys.modules:  # which what scree-post paraview makes has in it
    sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import results
from colors import BODY, CATEGORIES, FLOOR, FORCES, GRAIN, INK, PALE, PRESSURES, SPEEDS, color_by, letters, paint
from results import (Trouble, box_around, information, largest, open_series, resolved_deck, rounded_up,
                     sampled, times_of)

GLYPHS = 20000  # particles up to which each is a sphere of triangles; more are drawn by a shader, as quickly as points
ROOM = 0.84  # share of the picture for what is shown
STRAYS = 1  # percentage of the particles, at each end of each axis, that need not be in the picture
SEEN_THROUGH = 0.55  # opacity of particles in which contacts are shown
HOLLOW, GLASS = ("drum", "pipe", "funnel", "hopper", "file"), 0.35  # meshes that may hold particles; opacity then
AZIMUTH, ELEVATION = 30, 26  # of the eye in space [degrees]
SLOW = 0.1  # of the speed of a fall by a diameter: the scale of speeds ends no lower, so that what is at rest looks so
LINK_BALL = 0.014  # radius of the balls that show the forces in links, over the longest side of what is shown
NAMED = {"group": "particles", "material": "materials"}  # fields that count the names of a list of the deck's


class Scene:
    """What is shown of one folder, in one view."""

    def __init__(self, folder, view, contacts=True, field=None):
        """contacts: whether these are shown. field: that colours the particles; None: what there is to colour."""
        self.folder, self.view, self.deck, self.bars = folder, view, resolved_deck(folder), []
        self.space = self.deck.get("space", {})
        self.planar = self.space.get("dimension", 3) == 2
        kinds = ("particles", "bodies", "surfaces", "links", *["contacts"] * contacts)
        self.sources = {kind: source for kind in kinds if (source := open_series(folder, kind))}
        if not self.sources:
            raise Trouble(f"{folder}: holds no snapshots of a run that this ParaView can read")
        self.times = sorted({time for source in self.sources.values() for time in times_of(source)})
        self.field = field or "velocity"
        self.to_last()
        self.low, self.high = self.bounds()
        self.scaled, self.limit = self.choose_scale(field)

    def to_last(self):
        """Brings every source to the last time at which it has something, and so knows its fields."""
        for source in self.sources.values():
            for time in reversed(times_of(source)):
                source.UpdatePipeline(time)
                if source.GetDataInformation().GetNumberOfPoints() > 0:
                    break

    def choose_scale(self, field):
        """The one kind whose colours are a scale, and where that ends: of contacts, where these are shown and no field
        of the particles is asked for; else of what there is, particles first, and has values above zero."""
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
        """The least upper end of a scale of speeds [m/s]."""
        radii = information(self.sources["particles"], "POINTS", "radius")
        diameter = sum(radii.GetRange(0)) if radii else 0.0
        return SLOW * math.sqrt(np.linalg.norm(self.deck.get("gravity", [0.0])) * diameter)

    def extent(self):
        return float((self.high - self.low).max())

    def lift(self):
        """In the plane: of joints and what else lies above the bodies' discs, which are spheres here [m]."""
        bodies = self.sources.get("bodies")
        radii = information(bodies, "POINTS", "radius") if bodies and self.planar else None
        return radii.GetRange(0)[1] if radii else 0.0

    def color(self, display, field, colors):
        """By the scale; groups and materials by name, where the deck tells these."""
        tables = self.deck.get(NAMED.get(field))
        names = [table.get("name") or str(number) for number, table in enumerate(tables)] if tables else None
        self.bars.append(color_by(display, self.view, field, self.limit, CATEGORIES if names else colors, names))

    def show_balls(self, kind):
        """Points as spheres of their field radius."""
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
            raise Trouble(f"{self.folder}: particles have no field {self.field}; there are "
                          f"{', '.join(sorted(source.PointData.keys()))}")
        display = self.show_balls("particles")
        if self.scaled == "particles":
            self.color(display, self.field, SPEEDS)
        else:
            paint(display, GRAIN)
        if "contacts" in self.sources:
            display.Opacity = SEEN_THROUGH

    @staticmethod
    def drawn(name, source, call):
        """What rods.py makes of a source: a call there, of its data and an output. Its text is the filter's, so that a
        state that ParaView saves has it in it."""
        made = simple.ProgrammableFilter(registrationName=name, Input=source)
        made.OutputDataSetType = "vtkPolyData"
        made.Script = "import json\n\nspace = {'json': json, 'data': self.GetInputDataObject(0, 0), 'output': " \
                      f"self.GetPolyDataOutput()}}\nexec({results.drawing() + call!r}, space)\n"
        return made

    def show_bodies(self):
        """Their discs and spheres, and what joins them."""
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
        """With their sharp edges; like glass where there are drums or the like, so that these show what they hold."""
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
        """The forces in joints and force elements as balls at their places, where nothing else has colours; else the
        lines are there to be shown."""
        if self.scaled != "links":
            simple.Hide(self.sources["links"], self.view)
            return
        call = f"forces(data, {LINK_BALL * self.extent()!r}, {self.lift()!r}, output)"
        balls = self.drawn("forces in links", self.sources["links"], call)
        balls.UpdatePipeline(self.times[-1])
        self.color(simple.Show(balls, self.view), "reaction", FORCES)

    def show_contacts(self):
        """Tubes that are the thicker the larger the force, up to ten times."""
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
        """Of the space."""
        low, high = self.space.get("min"), self.space.get("max")
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
        """Its edges as far as they go along what is shown, so that they are in the picture, and its floor where that is
        a wall."""
        space = self.corners()
        low, high = np.maximum(space[0], self.low), np.minimum(space[1], self.high)
        if not (high >= low).all():
            return
        self.show_box("space", low, high, PALE, "Outline")
        up = self.up()
        axis = int(np.argmax(np.abs(up)))
        side, level = ("_max", space[1]) if up[axis] < 0 else ("_min", space[0])
        if not self.planar and self.space.get("xyz"[axis] + side) == "wall" and low[axis] <= level[axis] <= high[axis]:
            ends = [np.where(np.arange(3) == axis, level, corner) for corner in (low, high)]
            self.show_box("floor", *ends, FLOOR, "Surface")

    def show_words(self):
        title = simple.Text(registrationName="title", Text=self.deck.get("title") or os.path.basename(self.folder))
        time = simple.AnnotateTimeFilter(registrationName="time", Input=next(iter(self.sources.values())))
        time.Format = "t = {time:.4g} s"
        for source, height, share in ((title, 0.93, 38), (time, 0.885, 50)):
            display = simple.Show(source, self.view)
            display.WindowLocation, display.Position = "Any Location", [0.02, height]
            display.Color, display.FontSize = INK, letters(self.view, share)

    def up(self):
        """Unit vector against gravity; z, or y in the plane, without it."""
        gravity = np.array([*self.deck.get("gravity", []), 0.0, 0.0, 0.0][:3], dtype=float)
        if np.linalg.norm(gravity) > 0:
            return -gravity / np.linalg.norm(gravity)
        return np.eye(3)[1 if self.planar else 2]

    def bounds(self):
        """Of what is shown [m]: particles as far as they are in the space, the rest wherever it is, without particles
        at any time, as mechanisms swing."""
        boxes, space = [], self.corners()
        for kind, source in self.sources.items():
            least, most = box_around(source, STRAYS if kind == "particles" else 0)
            if kind in ("particles", "contacts"):
                least, most = np.maximum(least, space[0]), np.minimum(most, space[1])
            boxes.append((least, most))
        if "particles" not in self.sources:
            boxes += self.swing()
        boxes = [(least, most) for least, most in boxes if (most >= least).all()]
        low = np.min([least for least, _ in boxes], axis=0) if boxes else space[0]
        high = np.max([most for _, most in boxes], axis=0) if boxes else space[1]
        if self.planar:  # its lines reach out of the plane
            low, high = low * [1, 1, 0], high * [1, 1, 0]
        return (low, high) if (high > low).any() else space

    def swing(self):
        """Boxes around bodies, meshes and links at some of the times."""
        boxes = []
        for kind in ("bodies", "surfaces", "links"):
            for time in sampled(times_of(self.sources[kind])) if kind in self.sources else ():
                self.sources[kind].UpdatePipeline(time)
                boxes.append(box_around(self.sources[kind]))
        self.to_last()
        return boxes

    def directions(self):
        """Unit vectors of the picture: right, up and towards the eye; in the plane along z, in space from the front and
        above."""
        if self.planar:
            return np.eye(3)
        up = self.up()
        first = np.eye(3)[0] if abs(up[0]) < 0.9 else np.eye(3)[1]
        first = first - (first @ up) * up
        first /= np.linalg.norm(first)
        second = np.cross(up, first)
        turn, rise = math.radians(AZIMUTH), math.radians(ELEVATION)
        right = math.cos(turn) * first + math.sin(turn) * second
        eye = math.cos(rise) * (math.sin(turn) * first - math.cos(turn) * second) + math.sin(rise) * up
        return np.array([right, np.cross(eye, right), eye])

    def aim(self):
        """So that all that is shown fits beside the words."""
        view, low, high, axes = self.view, self.low, self.high, self.directions()
        center = (low + high) / 2
        corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
        right, up, near = ((corners - center) @ axes.T).T
        half = np.maximum(np.abs(up), 1.25 * np.abs(right) * view.ViewSize[1] / view.ViewSize[0]) / ROOM
        distance = (near + half / math.tan(math.radians(view.CameraViewAngle / 2))).max()
        half = half.max()
        center = center + (1 - ROOM) * half * (0.5 * axes[0] + 0.8 * axes[1])  # words stand above it, the scale beside
        view.CameraParallelProjection, view.CameraParallelScale = int(self.planar), half
        view.InteractionMode = "2D" if self.planar else "3D"
        view.CameraFocalPoint, view.CenterOfRotation, view.CameraViewUp = list(center), list(center), list(axes[1])
        view.CameraPosition = list(center + distance * axes[2])

    def show(self):
        """Everything."""
        for kind in ("particles", "bodies", "surfaces", "links", "contacts"):
            if kind in self.sources:
                getattr(self, f"show_{kind}")()
        self.show_space()
        self.show_words()


def show(folder, field=None, time=None, contacts=True):
    """Shows a folder in the active view, at the snapshot nearest to a time [s] or the last one, with its contacts or
    without. field: that colours the particles; None: their speed, or the contacts by their force where these are shown.
    Returns the Scene."""
    view = simple.GetActiveViewOrCreate("RenderView")
    simple._DisableFirstRenderCameraReset()  # which would undo where the eye is put
    view.UseColorPaletteForBackground, view.OrientationAxesLabelColor = 0, INK
    view.BackgroundColorMode, view.Background = "Single Color", [1.0, 1.0, 1.0]
    if hasattr(view, "UseSSAO"):  # shadows where spheres are close to each other
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
    """Of this file's constant, the active source, or the current folder."""
    source = simple.GetActiveSource()
    name = getattr(source, "FileName", None) or getattr(source, "FileNames", None) or ""
    opened = name if isinstance(name, str) else name[0]
    for folder in (results.FOLDER, os.path.dirname(opened), os.getcwd()):
        if os.path.isdir(folder or "") and any(name.endswith((".vtkhdf", ".xdmf")) for name in os.listdir(folder)):
            return folder
    raise Trouble("no results to show: open a run's particles.xdmf or particles.vtkhdf first, or show a view.py that "
                  "scree-post paraview RESULT_DIR makes")


def main():
    if not os.path.basename(sys.argv[0]).endswith(".py"):  # ParaView itself: its output window shows what is wrong
        show(folder_at_hand())
        return
    parser = argparse.ArgumentParser(prog="view.py")
    parser.add_argument("folder", nargs="?", metavar="RESULT_DIR")
    parser.add_argument("-o", "--output", metavar="FILE", help="a picture to save: .png, .jpg, .tif")
    parser.add_argument("--time", type=float, metavar="T", help="of the snapshot [s]; default: the last one")
    parser.add_argument("--color", metavar="FIELD", help="that colours the particles; default: velocity, or none where "
                                                         "contacts are shown, which have colours then")
    parser.add_argument("--no-contacts", action="store_true", help="leave them out; particles are opaque")
    parser.add_argument("--size", type=int, nargs=2, default=[1600, 1200], metavar=("WIDTH", "HEIGHT"))
    words = parser.parse_args()
    try:
        simple.GetActiveViewOrCreate("RenderView").ViewSize = words.size
        show(words.folder or folder_at_hand(), words.color, words.time, not words.no_contacts)
        if words.output:
            simple.SaveScreenshot(words.output, simple.GetActiveView(), ImageResolution=words.size)
    except Trouble as trouble:
        print(f"error: {trouble}", file=sys.stderr, flush=True)
        os._exit(2)  # pvbatch turns SystemExit into 0


if __name__ == "__main__":
    import view  # once more: programmable filters put numpy's max, all and others in place of those of this module

    view.main()
