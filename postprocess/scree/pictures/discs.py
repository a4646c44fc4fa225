"""Pictures of a planar run."""

import numpy as np

from scree.fields import POSITION
from scree.pictures.flat import FlatMechanism, FlatSurfaces, disc_collection, place_discs
from scree.pictures.framing import figure_size, plane_bounds
from scree.pictures.marks import draw_scale_bar
from scree.pictures.mechanism import Mechanism
from scree.pictures.palette import BODY_COLOR, EDGE_COLOR, PALE_INK
from scree.pictures.styles import SMALL
from scree.pictures.walls import solids

SHINE = 0.14  # opacity of the highlights, brighter discs that make a particle look round
SHINES = ((0.65, 0.15), (0.35, 0.25))  # radius of each highlight and distance from the centre, over the radius
SHINE_AT = np.array([-0.65, 0.76])
MOST_SHINY = 5000  # number of particles up to which they have edges and highlights


class DiscScene:
    def __init__(self, run, snapshots, view, with_numbers=False):
        """view: part of the plane, or None; with_numbers: axes with coordinates instead of a scale bar."""
        self.run, self.with_numbers = run, with_numbers
        low, high = plane_bounds(run, snapshots)
        self.view = view or (low[0], high[0], low[1], high[1])

    def size(self):
        return figure_size(self.view[1] - self.view[0], self.view[3] - self.view[2])

    def shows(self, points, radii):
        """For each disc, whether a part of it is in the picture."""
        low, high = np.array(self.view[::2]), np.array(self.view[1::2])
        margin = radii[:, None]
        return ((points[:, :2] + margin > low) & (points[:, :2] - margin < high)).all(axis=1)

    def set_up(self, axes, coloring):
        self.coloring = coloring
        axes.set_aspect("equal")
        axes.set_xlim(self.view[:2])
        axes.set_ylim(self.view[2:])
        self.draw_walls(axes)
        if self.with_numbers:
            axes.set_xlabel("x [m]", fontsize=12)
            axes.set_ylabel("y [m]", fontsize=12)
            axes.grid(color="#dddddd", linewidth=0.6)
            axes.set_axisbelow(True)
        else:
            axes.set_axis_off()
            draw_scale_bar(axes)
        self.shiny = len(self.run.particles.rows(0, "radius")) < MOST_SHINY
        edge = 0.4 if self.shiny else 0.0
        self.colors = disc_collection(axes, cmap=coloring.map, norm=coloring.norm, edgecolors=EDGE_COLOR,
                                      linewidths=edge)
        self.shapes = disc_collection(axes, facecolors=BODY_COLOR, edgecolors=EDGE_COLOR, linewidths=0.6)
        self.shines = [disc_collection(axes, facecolors="white", alpha=SHINE, linewidths=0) for _ in SHINES]
        unit = SMALL * max(self.view[1] - self.view[0], self.view[3] - self.view[2])
        self.mechanism = FlatMechanism(
            Mechanism(self.run.model, self.run.motion, unit), axes, lambda points: points[..., :2]
        )
        self.surfaces = FlatSurfaces(self.run.surfaces, axes, lambda points: points[..., :2])

    def draw_walls(self, axes):
        """Solid regions behind walls, and the sides of the domain: dashed if periodic, dotted if open."""
        low, high = np.array(self.view[::2]), np.array(self.view[1::2])
        for polygon, _ in solids(self.run.model, low, high):
            axes.fill(*polygon.T, facecolor="#e9e9e9", linewidth=0, zorder=0.5)
        corners = (self.run.model.low, self.run.model.high)
        styles = {"periodic": "--", "open": ":"}
        for i, (_, kind) in enumerate(self.run.model.boundaries.items()):
            if kind == "wall":
                continue
            ends = np.array([corners[0][:2], corners[1][:2]])
            ends[:, i // 2] = corners[i % 2][i // 2]
            axes.plot(*ends.T, styles[kind], color=PALE_INK, linewidth=1.0, zorder=0.7)
        for polygon, (point, normal) in solids(self.run.model, low, high):
            on_wall = polygon[np.abs((polygon - point) @ normal) <= 1e-9 * np.linalg.norm(normal) * max(high - low)]
            # The solid region covers half of the width.
            axes.plot(*on_wall.T, "-", color=EDGE_COLOR, linewidth=3.0, zorder=0.4)

    def draw(self, snapshot):
        particles, (shapes, sizes) = self.run.particles, self.run.shapes(snapshot)
        points, radii = particles.rows(snapshot, POSITION)[:, :2], particles.rows(snapshot, "radius")
        place_discs(self.colors, points, radii)
        self.colors.set_array(self.coloring.values(particles, snapshot))
        for discs, (size, distance) in zip(self.shines if self.shiny else (), SHINES):
            place_discs(discs, points + distance * radii[:, None] * SHINE_AT, size * radii)
        place_discs(self.shapes, shapes[:, :2], sizes)
        self.surfaces.draw(snapshot)
        self.mechanism.draw(snapshot)
