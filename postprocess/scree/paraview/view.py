"""Shows the results of a run in ParaView: particles and bodies as lit spheres of true size, meshes with the pressure on
them, joints and force elements coloured by force, contacts as tubes, the space, time and title.

    pvbatch view.py RESULT_DIR -o picture.png [--time T] [--color FIELD] [--no-contacts] [--size WIDTH HEIGHT]
    paraview --script=RESULT_DIR/view.py            # made by scree-post paraview RESULT_DIR; File > Load State, too

As a macro it shows the results that the active source was opened from. ParaView 5.11 or newer; in those before 5.13 the
.xdmf files are read, later the .vtkhdf files. Needs nothing but ParaView's own Python.
"""

import argparse
import json
import math
import os
import re
import sys

import numpy as np
from paraview import servermanager, simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

FOLDER = None  # the results to show where none are named; scree-post paraview sets it

GLYPHS = 20000  # particles up to which each is a sphere of triangles; more are drawn by a shader, as quickly as points
SAMPLES = 5  # times that are looked at for the colour scales
ROOM = 0.84  # share of the picture for what is shown
STRAYS = 1  # percentage of the particles, at each end of each axis, that need not be in the picture
SEEN_THROUGH = 0.55  # opacity of particles in which contacts are shown
HOLLOW, GLASS = ("drum", "pipe", "funnel", "hopper", "file"), 0.35  # meshes that may hold particles; opacity then
AZIMUTH, ELEVATION = 30, 26  # of the eye in space [degrees]
SPEEDS = "ead9ae a9cdb0 45a3b3 2364a8 1b2560"  # of particles, from rest on; each step is darker
FORCES = "d9d9d9 f6c37c ee8a3a cc3d26 7a0c1e"
PRESSURES = "f3b27a e66100 b52b10 5c0a14"  # of meshes: from the colour of bodies on
CATEGORIES = "0072b2 f0e442 009e73 cc79a7 56b4e9 e69f00 606060 d55e00"  # of groups and materials, then the same again
NAMED = {"group": "particles", "material": "materials"}  # fields that count the names of a list of the deck's
BODY, INK, PALE, FLOOR = (0.90, 0.38, 0.0), (0.15, 0.15, 0.15), (0.6, 0.6, 0.6), (0.85, 0.85, 0.85)
UNITS = {"velocity": "m/s", "angular_velocity": "rad/s", "force": "N", "reaction": "N", "normal_force": "N",
         "pressure": "Pa", "shear": "Pa", "radius": "m", "mass": "kg", "impact_work": "J", "sliding_work": "J",
         "wear_depth": "m"}
NAMES = {"velocity": "speed", "angular_velocity": "angular speed", "reaction": "link force"}


class Trouble(Exception):
    """Says why there is nothing to show."""


def resolved_deck(folder):
    """Of the deck's first lines and its table [space], {key: value}, whether a mesh may hold particles ("hollow"), and
    the names or numbers of its [[particles]] and [[materials]]; empty while the run has written no record."""
    path, found, table = os.path.join(folder, "run_record.json"), {}, ""
    if not os.path.exists(path):
        return {}
    for line in json.load(open(path, encoding="utf-8"))["run"]["resolved_deck"].splitlines():
        if line.startswith("["):
            table = line.strip("[] ")
            if table in NAMED.values():
                found[table] = [*found.get(table, []), str(len(found.get(table, [])))]
        pair = re.fullmatch(r"(\w+) *= *(.*)", line)
        if pair and table in ("", "space"):
            try:
                found[pair[1]] = json.loads(pair[2])
            except ValueError:  # a text that TOML writes in another way
                found[pair[1]] = pair[2].strip("'")
        if pair and table in NAMED.values() and pair[1] == "name":
            found[table][-1] = pair[2].strip("\"'")
        if pair and table == "meshes" and pair[1] == "kind":
            found["hollow"] = found.get("hollow", False) or json.loads(pair[2]) in HOLLOW
    return found


def open_series(folder, name):
    """The source of one kind of snapshots; None where the run has none."""
    data, text = (os.path.join(folder, name + suffix) for suffix in (".vtkhdf", ".xdmf"))
    program = servermanager.vtkSMProxyManager
    reads = (program.GetVersionMajor(), program.GetVersionMinor()) >= (5, 13)  # points, lines and triangles over time
    if reads and os.path.exists(data):
        source = simple.OpenDataFile(data)
    elif os.path.exists(text) and b"<Time" in open(text, "rb").read(4096):  # one without snapshots cannot be read
        source = simple.Xdmf3ReaderS(FileName=[text])
    else:
        return None
    simple.RenameSource(name, source)
    source.UpdatePipelineInformation()
    return source


def times_of(source):
    return np.atleast_1d(source.TimestepValues).tolist()


def information(source, association, field):
    """What is known of a field, without its values; None where there is none."""
    data = source.PointData if association == "POINTS" else source.CellData
    return data.GetArray(field) if field in data.keys() else None


def largest(source, association, field, times):
    """Upper end of a colour scale: of the field, of a vector its length, at some of the times."""
    found = 0.0
    for time in sorted({times[round(k * (len(times) - 1) / (SAMPLES - 1))] for k in range(SAMPLES)}):
        source.UpdatePipeline(time)
        data = servermanager.Fetch(source)
        array = (data.GetPointData() if association == "POINTS" else data.GetCellData()).GetArray(field)
        values = vtk_to_numpy(array) if array else np.empty(0)
        sizes = np.linalg.norm(values, axis=1) if values.ndim > 1 else values
        found = max([found, *np.percentile(sizes[sizes > 0], [99])]) if (sizes > 0).any() else found
    if found <= 0:
        return 1.0
    unit = 10.0 ** math.floor(math.log10(found))
    return next(step * unit for step in (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10) if step * unit >= 0.999 * found)


def letters(view, share):
    """Size of letters, so many of which are as high as the picture."""
    return max(12, round(view.ViewSize[1] / share))


def color_by(display, view, field, limit, colors, names):
    """By a field, of a vector its length: from 0 to limit, or a colour for each name. Returns the bar of the scale."""
    association = "CELLS" if information(display.Input, "CELLS", field) else "POINTS"
    array = information(display.Input, association, field)  # none where there are no points at this time
    vector = array is not None and array.GetNumberOfComponents() > 1
    simple.ColorBy(display, (association, field, "Magnitude") if vector else (association, field))
    function = simple.GetColorTransferFunction(field)
    steps = [[int(color[k : k + 2], 16) / 255 for k in (0, 2, 4)] for color in colors.split()]
    if names:
        function.InterpretValuesAsCategories = 1
        function.Annotations = [word for number, name in enumerate(names) for word in (str(number), name)]
        function.IndexedColors = [x for number in range(len(names)) for x in steps[number % len(steps)]]
    else:
        function.RGBPoints = [x for k, step in enumerate(steps) for x in (limit * k / (len(steps) - 1), *step)]
        function.ColorSpace, function.AutomaticRescaleRangeMode = "Lab", "Never"
    bar = simple.GetScalarBar(function, view)
    bar.Title = NAMES.get(field, field.replace("_", " ")) + (f" [{UNITS[field]}]" if field in UNITS else "")
    bar.ComponentTitle, bar.TitleColor, bar.LabelColor, bar.HorizontalTitle = "", INK, INK, 1
    bar.TitleFontSize, bar.LabelFontSize = letters(view, 55), letters(view, 60)
    bar.Orientation, bar.WindowLocation, bar.ScalarBarThickness = "Vertical", "Any Location", 14
    bar.AutomaticLabelFormat, bar.LabelFormat, bar.RangeLabelFormat = 0, "%-.3g", "%-.3g"
    display.SetScalarBarVisibility(view, True)
    return bar


def paint(display, color):
    display.ColorArrayName, display.AmbientColor, display.DiffuseColor = ["POINTS", ""], color, color


class Scene:
    """What is shown of one folder, in one view."""

    def __init__(self, folder, view, contacts=True):
        """contacts: whether these are shown."""
        self.folder, self.view, self.deck, self.bars = folder, view, resolved_deck(folder), []
        self.planar = self.deck.get("dimension", 3) == 2
        kinds = ("particles", "bodies", "surfaces", "links", *["contacts"] * contacts)
        self.sources = {kind: source for kind in kinds if (source := open_series(folder, kind))}
        if not self.sources:
            raise Trouble(f"{folder}: holds no snapshots of a run that this ParaView can read")
        self.times = sorted({time for source in self.sources.values() for time in times_of(source)})

    def color(self, display, kind, association, field, colors):
        """Of groups and materials by name, where the record tells these; else from 0 to the largest value."""
        names = self.deck.get(NAMED.get(field))
        limit = largest(self.sources[kind], association, field, times_of(self.sources[kind]))
        self.bars.append(color_by(display, self.view, field, limit, CATEGORIES if names else colors, names))
        step = 0.93 / max(3, len(self.bars))  # one below the other, the shorter the more there are
        for place, bar in enumerate(self.bars):
            bar.ScalarBarLength = step - 0.07  # the rest is for the title
            bar.Position = [0.88, 0.90 - bar.ScalarBarLength - step * place]

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

    def show_particles(self, field):
        source = self.sources["particles"]
        if not source.GetDataInformation().GetNumberOfPoints():
            return
        if information(source, "POINTS", field) is None:
            raise Trouble(f"{self.folder}: particles have no field {field}; there are "
                          f"{', '.join(sorted(source.PointData.keys()))}")
        display = self.show_balls("particles")
        self.color(display, "particles", "POINTS", field, SPEEDS)
        if "contacts" in self.sources:
            display.Opacity = SEEN_THROUGH

    def show_bodies(self):
        paint(self.show_balls("bodies"), BODY)

    def show_surfaces(self):
        """With their sharp edges; like glass where there are drums or the like, so that these show what they hold."""
        source = self.sources["surfaces"]
        display = simple.Show(source, self.view)
        display.SetRepresentationType("Surface")
        display.Opacity, display.Ambient, display.Diffuse = GLASS if self.deck.get("hollow", True) else 1.0, 0.3, 0.7
        if information(source, "CELLS", "pressure"):
            self.color(display, "surfaces", "CELLS", "pressure", PRESSURES)
        else:
            paint(display, BODY)
        triangles = simple.ExtractSurface(registrationName="triangles of surfaces", Input=source)
        edges = simple.FeatureEdges(registrationName="edges of surfaces", Input=triangles, FeatureAngle=30)
        paint(simple.Show(edges, self.view, LineWidth=1.5), INK)

    def show_links(self):
        """Joints and force elements."""
        source = self.sources["links"]
        display = simple.Show(source, self.view)
        display.SetRepresentationType("Surface")
        display.LineWidth, display.RenderLinesAsTubes = 6.0, 1
        if information(source, "CELLS", "reaction"):  # whose length knows no push and pull
            self.color(display, "links", "CELLS", "reaction", FORCES)

    def show_contacts(self):
        """Tubes that are the thicker the larger the force, up to ten times."""
        source = self.sources["contacts"]
        if information(source, "CELLS", "normal_force") is None:
            return
        limit = largest(source, "CELLS", "normal_force", times_of(source))
        thin = 1.5e-3 * float(np.ptp(self.bounds(), axis=0).max())
        lines = simple.ExtractSurface(registrationName="lines of contacts", Input=source)
        of_points = simple.CellDatatoPointData(registrationName="forces at their ends", Input=lines)
        thickness = simple.Calculator(registrationName="thickness of contacts", Input=of_points)
        thickness.AttributeType, thickness.ResultArrayName = "Point Data", "thickness"
        thickness.Function = f"{thin}*(1+9*min(1,max(0,normal_force/{limit})))"
        tubes = simple.Tube(registrationName="contact forces", Input=thickness)
        tubes.Scalars, tubes.VaryRadius, tubes.Radius = ["POINTS", "thickness"], "By Absolute Scalar", 1.0
        self.color(simple.Show(tubes, self.view), "contacts", "CELLS", "normal_force", FORCES)

    def corners(self):
        low, high = self.deck.get("min"), self.deck.get("max")
        if low is None or high is None:
            bounds = np.array(next(iter(self.sources.values())).GetDataInformation().GetBounds())
            return bounds[::2], bounds[1::2]
        return np.array([*low, 0.0][:3]), np.array([*high, 0.0][:3])

    def show_box(self, name, low, high, color, kind):
        box = simple.Box(registrationName=name, Center=list((low + high) / 2))
        box.XLength, box.YLength, box.ZLength = map(float, high - low)
        display = simple.Show(box, self.view)
        display.SetRepresentationType(kind)
        paint(display, color)

    def show_space(self):
        """Its edges, and its floor where that is a wall."""
        low, high = self.corners()
        self.show_box("space", low, high, PALE, "Outline")
        up = self.up()
        axis = int(np.argmax(np.abs(up)))
        if not self.planar and self.deck.get("xyz"[axis] + ("_max" if up[axis] < 0 else "_min")) == "wall":
            level = high if up[axis] < 0 else low
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
        """Of what is shown, but for the space: particles as far as they are in it [m]."""
        low, high, space = np.full(3, np.inf), np.full(3, -np.inf), self.corners()
        for kind, source in self.sources.items():
            box = np.array(source.GetDataInformation().GetBounds())
            if kind == "particles" and source.GetDataInformation().GetNumberOfPoints() > 0:
                points = vtk_to_numpy(servermanager.Fetch(source).GetPoints().GetData())
                reach = information(source, "POINTS", "radius").GetRange(0)[1] * np.array([[-1], [1]])
                box = (np.percentile(points, [STRAYS, 100 - STRAYS], axis=0) + reach).T.reshape(-1)
            inside = (np.maximum(box[::2], space[0]), np.minimum(box[1::2], space[1]))
            least, most = inside if kind in ("particles", "contacts") else (box[::2], box[1::2])
            if (most >= least).all():
                low, high = np.minimum(low, least), np.maximum(high, most)
        if "particles" not in self.sources:  # bodies swing in it
            return np.minimum(low, space[0]), np.maximum(high, space[1])
        return (low, high) if (high > low).any() else space

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
        view, (low, high), axes = self.view, self.bounds(), self.directions()
        center = (low + high) / 2
        corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
        right, up, near = ((corners - center) @ axes.T).T
        half = np.maximum(np.abs(up), 1.15 * np.abs(right) * view.ViewSize[1] / view.ViewSize[0]) / ROOM
        distance = (near + half / math.tan(math.radians(view.CameraViewAngle / 2))).max()
        half = half.max()
        center = center + (1 - ROOM) * half * (0.5 * axes[0] + 0.8 * axes[1])  # words stand above it, scales beside
        view.CameraParallelProjection, view.CameraParallelScale = int(self.planar), half
        view.InteractionMode = "2D" if self.planar else "3D"
        view.CameraFocalPoint, view.CenterOfRotation, view.CameraViewUp = list(center), list(center), list(axes[1])
        view.CameraPosition = list(center + distance * axes[2])

    def show(self, field):
        """Everything. field: that colours the particles."""
        for source in self.sources.values():
            for time in reversed(times_of(source)):  # to the last one that shows which fields there are
                source.UpdatePipeline(time)
                if source.GetDataInformation().GetNumberOfPoints() > 0:
                    break
        if "particles" in self.sources:
            self.show_particles(field)
        for kind in ("bodies", "surfaces", "links", "contacts"):
            if kind in self.sources:
                getattr(self, f"show_{kind}")()
        self.show_space()
        self.show_words()


def show(folder, field="velocity", time=None, contacts=True):
    """Shows a folder in the active view, at the snapshot nearest to a time [s] or the last one, with its contacts or
    without. Returns the Scene."""
    view = simple.GetActiveViewOrCreate("RenderView")
    simple._DisableFirstRenderCameraReset()  # which would undo where the eye is put
    view.UseColorPaletteForBackground, view.OrientationAxesLabelColor = 0, INK
    view.BackgroundColorMode, view.Background = "Single Color", [1.0, 1.0, 1.0]
    if hasattr(view, "UseSSAO"):  # shadows where spheres are close to each other
        view.UseSSAO = 1
    scene = Scene(os.path.abspath(folder), view, contacts)
    scene.show(field)
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
    for folder in (FOLDER, os.path.dirname(opened), os.getcwd()):
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
    parser.add_argument("--color", default="velocity", metavar="FIELD", help="that colours the particles")
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
    main()
