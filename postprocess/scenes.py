"""What render.py shows inside its axes: discs in the plane, or spheres seen from the front and above."""

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection

BODY_COLOR = "#e66100"
EDGE_COLOR = "#303030"
LONGEST_SIDE = 7.5  # of the axes [inch]


def bounds(series, snapshots, strays):
    """Box around the points of some snapshots, grown by the radius. strays: percentage left out per side."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for snapshot in snapshots:
        points = series.rows(snapshot, "Points")
        if len(points) == 0:
            continue
        reach = series.rows(snapshot, "radius").max()
        low = np.minimum(low, np.percentile(points, strays, axis=0) - reach)
        high = np.maximum(high, np.percentile(points, 100 - strays, axis=0) + reach)
    return low, high


def common_bounds(particles, bodies, snapshots):
    low, high = bounds(particles, snapshots, strays=0.5)
    if bodies:
        body_low, body_high = bounds(bodies, snapshots, strays=0)
        low, high = np.minimum(low, body_low), np.maximum(high, body_high)
    if not np.isfinite(low).all():
        low, high = -np.ones(3), np.ones(3)
    margin = 0.04 * max(high - low)
    return low - margin, high + margin


def figure_size(width, height):
    """Axes of this shape [inch], not narrower or flatter than 1 : 2.2."""
    scale = LONGEST_SIDE / max(width, height)
    return max(scale * width, LONGEST_SIDE / 2.2), max(scale * height, LONGEST_SIDE / 2.2)


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


class DiscScene:
    def __init__(self, particles, bodies, snapshots, view):
        self.particles, self.bodies = particles, bodies
        low, high = common_bounds(particles, bodies, snapshots)
        self.view = view or (low[0], high[0], low[1], high[1])

    def size(self):
        return figure_size(self.view[1] - self.view[0], self.view[3] - self.view[2])

    def set_up(self, axes, color_map, limit):
        axes.set_aspect("equal")
        axes.set_xlim(self.view[:2])
        axes.set_ylim(self.view[2:])
        axes.set_xlabel("x [m]", fontsize=13)
        axes.set_ylabel("y [m]", fontsize=13)
        axes.grid(color="#dddddd", linewidth=0.6)
        axes.set_axisbelow(True)
        edge = 0.3 if len(self.particles.rows(0, "radius")) < 5000 else 0.0
        self.colors = disc_collection(axes, cmap=color_map, edgecolors=EDGE_COLOR, linewidths=edge)
        self.colors.set_clim(0, limit)
        self.shapes = disc_collection(axes, facecolors=BODY_COLOR, edgecolors=EDGE_COLOR, linewidths=0.6)

    def draw(self, snapshot):
        place_discs(
            self.colors,
            self.particles.rows(snapshot, "Points")[:, :2],
            self.particles.rows(snapshot, "radius"),
        )
        self.colors.set_array(self.particles.speed(snapshot))
        if self.bodies:
            place_discs(
                self.shapes, self.bodies.rows(snapshot, "Points")[:, :2], self.bodies.rows(snapshot, "radius")
            )


def scale_bar_length(width):
    """A round length near a fifth of the picture's width."""
    unit = 10.0 ** np.floor(np.log10(width / 5))
    return max(step * unit for step in (1, 2, 5) if step * unit <= width / 5)


class SphereScene:
    """Parallel projection, so that one scale bar holds everywhere; z points up."""

    # Unit vectors of the picture in space: right, up, and towards the eye.
    RIGHT = np.array([0.866, 0.5, 0.0])
    EYE = np.array([0.45, -0.779, 0.436])

    def __init__(self, particles, bodies, snapshots, use_vtk):
        self.particles, self.bodies = particles, bodies
        right, eye = self.RIGHT / np.linalg.norm(self.RIGHT), self.EYE / np.linalg.norm(self.EYE)
        self.axes_of_picture = np.array([right, np.cross(eye, right), eye])
        low, high = common_bounds(particles, bodies, snapshots)
        self.center = (low + high) / 2
        self.box = np.array(
            [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
        )
        flat = self.project(self.box)
        self.half = 1.02 * np.abs(flat[:, :2]).max(axis=0)  # half width and height of the picture [m]
        self.use_vtk = use_vtk

    def project(self, points):
        """Right, up and nearness of each point, from the picture's centre [m]."""
        return (points - self.center) @ self.axes_of_picture.T

    def size(self):
        return figure_size(*self.half)

    def set_up(self, axes, color_map, limit):
        self.map = plt.get_cmap(color_map)
        self.colors = matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(0, limit), color_map)
        axes.set_aspect("equal")
        axes.set_xlim(-self.half[0], self.half[0])
        axes.set_ylim(-self.half[1], self.half[1])
        axes.set_xticks([])
        axes.set_yticks([])
        self.draw_scale_bar(axes)
        self.draw_directions(axes)
        if self.use_vtk:
            from spheres import SphereRenderer

            pixels = np.round(np.array(self.size()) * 160).astype(int)
            pixels[1] = round(pixels[0] * self.half[1] / self.half[0])
            self.renderer = SphereRenderer(pixels, self.center, self.axes_of_picture, self.half[1], self.box)
            extent = (-self.half[0], self.half[0], -self.half[1], self.half[1])
            self.image = axes.imshow(
                np.zeros((2, 2, 3)), extent=extent, interpolation="antialiased", zorder=0
            )
        else:
            self.discs = disc_collection(axes, edgecolors=EDGE_COLOR, linewidths=0.2)

    def draw_scale_bar(self, axes):
        length = scale_bar_length(2 * self.half[0])
        x, y = -0.95 * self.half[0], -0.94 * self.half[1]
        axes.plot([x, x + length], [y, y], color="black", linewidth=3, solid_capstyle="butt")
        axes.text(
            x + length / 2, y + 0.02 * self.half[1], f"{length:g} m", ha="center", va="bottom", fontsize=12
        )

    def draw_directions(self, axes):
        """Where x, y and z point, in the lower right corner."""
        origin = np.array([0.86, -0.86]) * self.half
        length = 0.1 * self.half.min()
        for name, direction in zip("xyz", self.axes_of_picture[:2].T):
            tip = origin + length * direction
            axes.annotate(
                "",
                tip,
                origin,
                arrowprops={"arrowstyle": "-|>", "color": "black", "shrinkA": 0, "shrinkB": 0},
            )
            axes.text(*(origin + 1.35 * length * direction), name, ha="center", va="center", fontsize=12)

    def draw(self, snapshot):
        points, radii = self.particles.rows(snapshot, "Points"), self.particles.rows(snapshot, "radius")
        colors = self.colors.to_rgba(self.particles.speed(snapshot))[:, :3]
        if self.bodies:
            shapes = self.bodies.rows(snapshot, "Points")
            points = np.concatenate([points, shapes])
            radii = np.concatenate([radii, self.bodies.rows(snapshot, "radius")])
            colors = np.concatenate([colors, np.tile(matplotlib.colors.to_rgb(BODY_COLOR), (len(shapes), 1))])
        if self.use_vtk:
            self.image.set_data(self.renderer.image(points, radii, colors))
        else:
            self.draw_discs(self.project(points), radii, colors)

    def draw_discs(self, flat, radii, colors):
        """Far ones first and darker."""
        order = np.argsort(flat[:, 2])
        depth = flat[order, 2]
        light = 0.45 + 0.55 * (depth - depth.min()) / max(np.ptp(depth), 1e-300) if len(order) else depth
        place_discs(self.discs, flat[order, :2], radii[order])
        self.discs.set_facecolor(colors[order] * light[:, None])
