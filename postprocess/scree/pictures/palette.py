"""Colours, opacities and line styles of all pictures."""

import matplotlib
from matplotlib.colors import LinearSegmentedColormap

from scree.pictures.styles import BODY_COLOR, CATEGORIES, EDGE_COLOR, JOINTS, LINES, SPEEDS

__all__ = ["BODY_COLOR", "CATEGORIES", "COLORED_OPACITY", "EDGE_COLOR", "GLASS", "INK", "JOINTS", "LINES", "PALE_INK",
           "SPEED_MAP", "SURFACE_COLORS", "SURFACE_MAP", "rgb"]

# From sand colour at rest to dark blue. Luminance decreases, for print and colour-blind readers.
SPEED_MAP = LinearSegmentedColormap.from_list("speed", SPEEDS)
SURFACE_MAP = "YlOrRd"  # colour map of meshes coloured by a field
INK = "#262626"  # text
PALE_INK = "#6a6a6a"
SURFACE_COLORS = {"walls": "#8d939b", "bodies": BODY_COLOR}
GLASS = 0.1  # opacity of meshes that hold particles
COLORED_OPACITY = 0.95  # opacity of meshes coloured by a field, at the upper end of the scale


def rgb(color):
    return matplotlib.colors.to_rgb(color)
