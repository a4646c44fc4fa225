"""Colours, line styles and sizes that pictures and ParaView share. Needs no library."""

SPEEDS = ["#ead9ae", "#a9cdb0", "#45a3b3", "#2364a8", "#1b2560"]  # from rest; each step is darker
# Okabe and Ito's palette without the orange of bodies, for groups and materials; it repeats.
CATEGORIES = ["#0072b2", "#f0e442", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#606060"]
BODY_COLOR = "#e66100"
EDGE_COLOR = "#303030"

# Lines of a mechanism: colour, width [pt], whether they are drawn above the shapes.
LINES = {
    "bar": (BODY_COLOR, 4.0, False),
    "guide": ("#606060", 1.0, True),
    "spring": ("#404040", 1.0, True),
    "distance": ("#202020", 2.0, True),
    "rod": ("#c4c8cc", 3.0, True),
    "barrel": ("#4a4f55", 6.0, True),
}
# Joints: marker, fill colour.
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

# Sizes in a 3D mechanism over the longest side of the scene: objects without a size, radius of a line of 1 pt, radius
# of the ball of a joint.
SMALL, TUBE, BALL = 0.012, 0.0014, 0.007
