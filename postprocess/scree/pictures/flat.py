"""Discs, mechanisms and meshes as matplotlib draws them."""

import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection

from scree.pictures.palette import JOINTS, LINES, SURFACE_COLORS


def disc_collection(axes, **style):
    """Circles whose diameters are lengths in the axes' units."""
    discs = EllipseCollection(
        [], [], [], units="xy", offsets=np.empty((0, 2)), transOffset=axes.transData, **style
    )
    axes.add_collection(discs, autolim=False)
    return discs


def place_discs(discs, points, radii):
    discs.set_offsets(points)
    discs.set_widths(2 * radii)
    discs.set_heights(2 * radii)
    discs.set_angles(np.zeros(len(radii)))


class FlatMechanism:
    """A mechanism's lines and joints as matplotlib draws them. flatten: points in space to those of the axes."""

    def __init__(self, mechanism, axes, flatten):
        self.mechanism, self.flatten = mechanism, flatten
        count = sum(len(pairs) for pairs, _, _ in mechanism.model.connections.values())
        size = 6.0 if count < 60 else 3.5 if count < 600 else 1.5
        self.lines, self.points = {}, {}
        for style, (color, width, above) in LINES.items():
            width *= size / 6
            self.lines[style] = LineCollection([], colors=color, linewidths=width, zorder=2.5 if above else 0.9)
            self.lines[style].set_capstyle("round")
            axes.add_collection(self.lines[style], autolim=False)
        edge = {"linestyle": "none", "markeredgecolor": "#202020", "markeredgewidth": 0.18 * size}
        (self.points["held"],) = axes.plot(
            [], [], marker=6, markersize=1.6 * size, markerfacecolor="#909090", zorder=2.6, **edge
        )
        for kind, (marker, fill) in JOINTS.items():
            larger = 1.6 if kind == "torsional" else 1.0
            (self.points[kind],) = axes.plot(
                [], [], marker=marker, markersize=larger * size, markerfacecolor=fill, zorder=2.7, **edge
            )

    def draw(self, snapshot):
        lines, points = self.mechanism.draw(snapshot)
        for style, collection in self.lines.items():
            collection.set_segments([self.flatten(line) for line in lines.get(style, [])])
        for kind, markers in self.points.items():
            markers.set_data(*self.flatten(points.get(kind, np.empty((0, 3)))).T)


class FlatSurfaces:
    """The edges of meshes as matplotlib draws them. flatten: as in FlatMechanism."""

    def __init__(self, surfaces, axes, flatten):
        self.surfaces, self.flatten, self.lines = surfaces, flatten, {}
        for owner, color in SURFACE_COLORS.items() if surfaces else ():
            self.lines[owner] = LineCollection([], colors=color, linewidths=1.0, zorder=1.5)
            axes.add_collection(self.lines[owner], autolim=False)

    def draw(self, snapshot):
        lines = self.surfaces.lines(snapshot) if self.surfaces else {}
        for owner, found in lines.items():
            self.lines[owner].set_segments(self.flatten(found))
