"""Colours, opacities and line styles of all pictures."""

import matplotlib
from matplotlib.colors import LinearSegmentedColormap

# From sand at rest to dark blue: each step is darker, so that it reads in print and for the colour-blind.
SPEED_MAP = LinearSegmentedColormap.from_list("speed", ["#ead9ae", "#a9cdb0", "#45a3b3", "#2364a8", "#1b2560"])
# Okabe and Ito's, of groups and materials, then the same again; the orange is that of bodies.
CATEGORIES = ["#0072b2", "#f0e442", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#606060"]
SURFACE_MAP = "YlOrRd"  # of meshes that are coloured by a field
BODY_COLOR = "#e66100"
EDGE_COLOR = "#303030"
INK = "#262626"  # of words
PALE_INK = "#6a6a6a"
SURFACE_COLORS = {"walls": "#8d939b", "bodies": BODY_COLOR}
GLASS = 0.1  # opacity of meshes that hold particles: what is behind them shows
COLORED_OPACITY = 0.95  # of meshes that are coloured by a field, at the end of its scale

# Lines of a mechanism: colour, width [pt], whether they lie above the shapes.
LINES = {
    "bar": (BODY_COLOR, 4.0, False),
    "guide": ("#606060", 1.0, True),
    "spring": ("#404040", 1.0, True),
    "distance": ("#202020", 2.0, True),
    "rod": ("#c4c8cc", 3.0, True),
    "barrel": ("#4a4f55", 6.0, True),
}
# Joints: marker, its fill.
JOINTS = {
    "revolute": ("o", "white"),
    "translational": ("s", "white"),
    "fixed": ("s", "#202020"),
    "torsional": ("o", "none"),
    "spherical": ("o", "#808080"),
    "universal": ("P", "white"),
    "constant-velocity": ("P", "white"),
    "cylindrical": ("s", "white"),
    "screw": ("s", "#808080"),
    "planar": ("s", "white"),
    "point-on-line": ("o", "#808080"),
    "point-on-plane": ("o", "#808080"),
}


def rgb(color):
    return matplotlib.colors.to_rgb(color)
