"""Colours of view.py: by a field with a scale, or uniform."""

from paraview import simple

from results import information

SPEEDS = "ead9ae a9cdb0 45a3b3 2364a8 1b2560"  # colours of particles by speed, from rest; each step is darker
FORCES = "d9d9d9 f6c37c ee8a3a cc3d26 7a0c1e"
PRESSURES = "f3b27a e66100 b52b10 5c0a14"  # colours of meshes, beginning near the colour of bodies
CATEGORIES = "0072b2 f0e442 009e73 cc79a7 56b4e9 e69f00 606060 d55e00"  # groups and materials; repeats
BODY, INK, PALE, FLOOR = (0.90, 0.38, 0.0), (0.15, 0.15, 0.15), (0.6, 0.6, 0.6), (0.85, 0.85, 0.85)
PARTICLE = (0.92, 0.85, 0.68)  # colour of particles without a scale
UNITS = {"velocity": "m/s", "angular_velocity": "rad/s", "force": "N", "reaction": "N", "normal_force": "N",
         "pressure": "Pa", "shear": "Pa", "radius": "m", "mass": "kg", "impact_work": "J", "sliding_work": "J",
         "wear_depth": "m"}
NAMES = {"velocity": "speed", "angular_velocity": "angular speed", "reaction": "link force"}


def font_size(view, lines):
    """Font size at which this number of lines fills the height of the picture."""
    return max(12, round(view.ViewSize[1] / lines))


def color_by(display, view, field, limit, colors, names):
    """Colours by a field (a vector by magnitude) from 0 to limit, or by name. Returns the scalar bar."""
    association = "CELLS" if information(display.Input, "CELLS", field) else "POINTS"
    array = information(display.Input, association, field)  # None without points at this time
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
    bar.TitleFontSize, bar.LabelFontSize = font_size(view, 50), font_size(view, 55)
    bar.Orientation, bar.WindowLocation, bar.ScalarBarThickness = "Vertical", "Any Location", 18
    bar.Position, bar.ScalarBarLength = [0.88, 0.32], 0.4
    bar.AutomaticLabelFormat, bar.LabelFormat, bar.RangeLabelFormat = 0, "%-.3g", "%-.3g"
    bar.AddRangeLabels = int(not names)
    display.SetScalarBarVisibility(view, True)
    return bar


def paint(display, color):
    display.ColorArrayName, display.AmbientColor, display.DiffuseColor = ["POINTS", ""], color, color
