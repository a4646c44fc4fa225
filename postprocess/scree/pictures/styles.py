"""Colours, line styles and sizes that pictures and ParaView share. Needs no library."""

SPEEDS = ["#ead9ae", "#a9cdb0", "#45a3b3", "#2364a8", "#1b2560"]  # from rest on; each step is darker
# Okabe and Ito's, of groups and materials, then the same again; the orange is that of bodies.
CATEGORIES = ["#0072b2", "#f0e442", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#606060"]
BODY_COLOR = "#e66100"
EDGE_COLOR = "#303030"

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

# Of a mechanism in space, over the scene's longest side: things without a size of their own, the radius of a line a
# point wide, that of a joint's ball.
SMALL, TUBE, BALL = 0.012, 0.0014, 0.007
