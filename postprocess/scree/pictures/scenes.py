"""What a picture shows inside its axes: discs in the plane, or spheres seen from the front and above."""

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection

from scree.pictures.mechanism import Mechanism
from scree.pictures.walls import section, solids
from scree.series import POSITION

BODY_COLOR = "#e66100"
EDGE_COLOR = "#303030"
SURFACE_COLORS = {"walls": "#909090", "bodies": BODY_COLOR}
WALL_OPACITY = 0.18  # of meshes: what is behind them shows
SURFACE_MAP, COLORED_OPACITY = "YlOrRd", 0.95  # of meshes that are coloured by a field, at the end of its scale
LIGHT = np.array([-0.4, 0.75, 0.53])  # where walls are lighter: right, up, towards the eye
LONGEST_SIDE = 7.5  # of the axes [inch]
SPREAD = 40  # snapshots in which bodies are looked for
AZIMUTH, ELEVATION = 30, 26  # of the eye in space [degrees]
SMALL = 0.012  # things without a size of their own, over the picture's longest side

# Lines of a mechanism: colour, width [pt], whether they lie above the shapes.
LINES = {
    "bar": (BODY_COLOR, 4.0, False),
    "guide": ("#606060", 1.0, True),
    "spring": ("#404040", 1.0, True),
    "distance": ("#202020", 2.0, True),
    "rod": ("#b0b0b0", 3.0, True),
    "barrel": ("#505050", 6.0, True),
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


def bounds(series, snapshots, strays):
    """Box around the points of some snapshots, grown by the radius. strays: percentage left out per side."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for snapshot in snapshots:
        points = series.rows(snapshot, POSITION)
        if len(points) == 0:
            continue
        reach = series.rows(snapshot, "radius").max()
        low = np.minimum(low, np.percentile(points, strays, axis=0) - reach)
        high = np.maximum(high, np.percentile(points, 100 - strays, axis=0) + reach)
    return low, high


def union(*boxes):
    return np.min([low for low, _ in boxes], axis=0), np.max([high for _, high in boxes], axis=0)


def body_bounds(run, snapshots):
    """Of shapes, meshes, joints and springs."""
    mechanism = Mechanism(run.model, run.motion, 0.0)
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for snapshot in snapshots:
        lines, points = mechanism.draw(snapshot)
        everything = np.concatenate([a.reshape(-1, 3) for a in (*lines.values(), *points.values())])
        low = np.min(np.concatenate([[low], everything]), axis=0)
        high = np.max(np.concatenate([[high], everything]), axis=0)
    if run.surfaces:
        low, high = union((low, high), run.surfaces.bounds(snapshots))
    if run.bodies is None:
        return low, high
    return union((low, high), bounds(run.bodies, snapshots, strays=0))


def plane_bounds(run, snapshots):
    """All but stray particles and those outside the space, with a margin."""
    low, high = bounds(run.particles, snapshots, strays=0.5)
    if np.isfinite(low).all():
        low, high = np.maximum(low, run.model.low), np.minimum(high, run.model.high)
    # Where bodies swing, all the way.
    spread = np.unique(np.linspace(0, len(run.particles) - 1, SPREAD).astype(int))
    way = body_bounds(run, spread)
    way = np.maximum(way[0], run.model.low), np.minimum(way[1], run.model.high)
    boxes = [(low, high), body_bounds(run, snapshots)] + [way] * bool((way[1] >= way[0]).all())
    low, high = union(*boxes)
    if not np.isfinite(low).all() or not (high >= low).all():
        low, high = run.model.low, run.model.high
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
        for whose, color in SURFACE_COLORS.items() if surfaces else ():
            self.lines[whose] = LineCollection([], colors=color, linewidths=1.0, zorder=1.5)
            axes.add_collection(self.lines[whose], autolim=False)

    def draw(self, snapshot):
        lines = self.surfaces.lines(snapshot) if self.surfaces else {}
        for whose, found in lines.items():
            self.lines[whose].set_segments(self.flatten(found))


class DiscScene:
    def __init__(self, run, snapshots, view):
        self.run = run
        low, high = plane_bounds(run, snapshots)
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
        self.draw_walls(axes)
        edge = 0.3 if len(self.run.particles.rows(0, "radius")) < 5000 else 0.0
        self.colors = disc_collection(axes, cmap=color_map, edgecolors=EDGE_COLOR, linewidths=edge)
        self.colors.set_clim(0, limit)
        self.shapes = disc_collection(axes, facecolors=BODY_COLOR, edgecolors=EDGE_COLOR, linewidths=0.6)
        unit = SMALL * max(self.view[1] - self.view[0], self.view[3] - self.view[2])
        self.mechanism = FlatMechanism(
            Mechanism(self.run.model, self.run.motion, unit), axes, lambda points: points[..., :2]
        )
        self.surfaces = FlatSurfaces(self.run.surfaces, axes, lambda points: points[..., :2])

    def draw_walls(self, axes):
        """What is solid, and the sides of the space: dashed where they are periodic, dotted where open."""
        low, high = np.array(self.view[::2]), np.array(self.view[1::2])
        for polygon, _ in solids(self.run.model, low, high):
            axes.fill(*polygon.T, facecolor="#eeeeee", edgecolor="#909090", hatch="////", linewidth=0, zorder=0.5)
        corners = (self.run.model.low, self.run.model.high)
        styles = {"wall": "-", "periodic": "--", "open": ":"}
        for i, (_, kind) in enumerate(self.run.model.boundaries.items()):
            ends = np.array([corners[0][:2], corners[1][:2]])
            ends[:, i // 2] = corners[i % 2][i // 2]
            axes.plot(*ends.T, styles[kind], color="#606060", linewidth=1.0, zorder=0.7)
        for polygon, (point, normal) in solids(self.run.model, low, high):
            on_wall = polygon[np.abs((polygon - point) @ normal) <= 1e-9 * np.linalg.norm(normal) * max(high - low)]
            axes.plot(*on_wall.T, "-", color="#404040", linewidth=1.4, zorder=0.8)

    def draw(self, snapshot):
        particles, (points, radii) = self.run.particles, self.run.shapes(snapshot)
        place_discs(self.colors, particles.rows(snapshot, POSITION)[:, :2], particles.rows(snapshot, "radius"))
        self.colors.set_array(particles.speed(snapshot))
        place_discs(self.shapes, points[:, :2], radii)
        self.surfaces.draw(snapshot)
        self.mechanism.draw(snapshot)


def scale_bar_length(width):
    """A round length near a fifth of the picture's width."""
    unit = 10.0 ** np.floor(np.log10(width / 5))
    return max(step * unit for step in (1, 2, 5) if step * unit <= width / 5)


def picture_axes(up):
    """Unit vectors of the picture in space: right, up, and towards the eye, which looks from the front and
    above."""
    first = np.eye(3)[0] if abs(up[0]) < 0.9 else np.eye(3)[1]
    first = first - (first @ up) * up
    first /= np.linalg.norm(first)
    second = np.cross(up, first)
    turn, rise = np.radians(AZIMUTH), np.radians(ELEVATION)
    right = np.cos(turn) * first + np.sin(turn) * second
    front = np.sin(turn) * first - np.cos(turn) * second
    eye = np.cos(rise) * front + np.sin(rise) * up
    return np.array([right, np.cross(eye, right), eye])


class SphereScene:
    """Parallel projection, so that one scale bar holds everywhere; gravity points down."""

    def __init__(self, run, snapshots, use_vtk, opacity=WALL_OPACITY):
        """opacity: of meshes on bodies."""
        self.run, self.use_vtk = run, use_vtk
        self.opacity = {"walls": WALL_OPACITY, "bodies": opacity}
        self.axes_of_picture = picture_axes(run.model.up)
        self.box = (run.model.low, run.model.high)
        low, high = union(self.box, body_bounds(run, snapshots))
        self.center = (low + high) / 2
        self.extent = max(high - low)
        corners = np.array(
            [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
        )
        flat = self.project(corners)
        self.half = 1.05 * np.abs(flat[:, :2]).max(axis=0)  # half width and height of the picture [m]

    def project(self, points):
        """Right, up and nearness of each point, from the picture's centre [m]."""
        return (points - self.center) @ self.axes_of_picture.T

    def size(self):
        return figure_size(*self.half)

    def faces(self):
        """Walls as (polygon, colour, opacity). Of the space's sides those behind the particles only."""
        found = []
        inner, sides = self.run.model.walls, self.run.model.side_walls()
        for opacity, walls in ((1.0, sides), (0.5, inner)):
            for point, normal in walls:
                towards_light = normal @ (self.axes_of_picture.T @ LIGHT) / np.linalg.norm(normal)
                if opacity < 1 or normal @ self.axes_of_picture[2] > 0:
                    color = np.full(3, 0.78 + 0.14 * towards_light)
                    found.append((section(*self.box, point, normal), color, opacity))
        return [face for face in found if len(face[0])]

    def set_up(self, axes, color_map, limit):
        self.map = plt.get_cmap(color_map)
        self.colors = matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(0, limit), color_map)
        if self.run.surfaces:
            self.surface_colors = matplotlib.cm.ScalarMappable(
                matplotlib.colors.Normalize(0, self.run.surfaces.limit), SURFACE_MAP
            )
        axes.set_aspect("equal")
        axes.set_xlim(-self.half[0], self.half[0])
        axes.set_ylim(-self.half[1], self.half[1])
        axes.set_xticks([])
        axes.set_yticks([])
        self.draw_scale_bar(axes)
        self.draw_directions(axes)
        mechanism = Mechanism(self.run.model, self.run.motion, SMALL * self.extent)
        if self.use_vtk:
            from scree.pictures.spheres import SphereRenderer

            self.mechanism = mechanism
            pixels = np.round(np.array(self.size()) * 160).astype(int)
            pixels[1] = round(pixels[0] * self.half[1] / self.half[0])
            self.renderer = SphereRenderer(pixels, self.center, self.axes_of_picture, self.half[1], self.extent)
            self.renderer.add_box(*self.box)
            for face in self.faces():
                self.renderer.add_face(*face)
            extent = (-self.half[0], self.half[0], -self.half[1], self.half[1])
            self.image = axes.imshow(
                np.zeros((2, 2, 3)), extent=extent, interpolation="antialiased", zorder=0
            )
        else:
            self.draw_box(axes)
            self.discs = disc_collection(axes, edgecolors=EDGE_COLOR, linewidths=0.2)
            self.mechanism = FlatMechanism(mechanism, axes, lambda points: self.project(points)[..., :2])
            self.surfaces = FlatSurfaces(self.run.surfaces, axes, lambda points: self.project(points)[..., :2])

    def draw_box(self, axes):
        for polygon, color, opacity in self.faces():
            flat = self.project(polygon)
            axes.fill(*flat[:, :2].T, color=color, alpha=opacity, linewidth=0, zorder=0.4)
        low, high = self.box
        for axis in range(3):
            for corner in range(4):
                ends = np.array([low, high])
                for bit, other in enumerate(a for a in range(3) if a != axis):
                    ends[:, other] = (low, high)[corner >> bit & 1][other]
                axes.plot(*self.project(ends)[:, :2].T, color="#999999", linewidth=0.8, zorder=0.5)

    def draw_scale_bar(self, axes):
        length = scale_bar_length(2 * self.half[0])
        x, y = -0.95 * self.half[0], -0.94 * self.half[1]
        axes.plot([x, x + length], [y, y], color="black", linewidth=3, solid_capstyle="butt")
        axes.text(
            x + length / 2, y + 0.02 * self.half[1], f"{length:g} m", ha="center", va="bottom", fontsize=12
        )

    def draw_directions(self, axes):
        """Where x, y and z point, above the scale bar: in the other corner the space is nearest to the eye."""
        origin = np.array([-0.93, -0.78]) * self.half
        length = 0.13 * self.half.min()
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
        particles, (shapes, sizes) = self.run.particles, self.run.shapes(snapshot)
        points, radii = particles.rows(snapshot, POSITION), particles.rows(snapshot, "radius")
        colors = self.colors.to_rgba(particles.speed(snapshot))[:, :3]
        points, radii = np.concatenate([points, shapes]), np.concatenate([radii, sizes])
        colors = np.concatenate([colors, np.tile(matplotlib.colors.to_rgb(BODY_COLOR), (len(shapes), 1))])
        if not self.use_vtk:
            self.draw_discs(self.project(points), radii, colors)
            self.surfaces.draw(snapshot)
            self.mechanism.draw(snapshot)
            return
        self.draw_surfaces(snapshot)
        lines, joints = self.mechanism.draw(snapshot)
        for style, (color, width, _) in LINES.items():
            strokes = lines.get(style, np.empty((0, 2, 3)))
            self.renderer.set_lines(style, strokes, matplotlib.colors.to_rgb(color), 0.0014 * width * self.extent)
        balls = np.concatenate([joints[kind] for kind in JOINTS])
        points, radii = np.concatenate([points, balls]), np.append(radii, np.full(len(balls), 0.005 * self.extent))
        colors = np.concatenate([colors, np.tile(matplotlib.colors.to_rgb(EDGE_COLOR), (len(balls), 1))])
        self.image.set_data(self.renderer.image(points, radii, colors))

    def draw_surfaces(self, snapshot):
        if not self.run.surfaces:
            return
        surfaces = self.run.surfaces
        points, lines = surfaces.points(snapshot), surfaces.lines(snapshot)
        values = surfaces.values(snapshot) if surfaces.field else {}
        for whose, triangles in surfaces.triangles.items():
            color = matplotlib.colors.to_rgb(SURFACE_COLORS[whose])
            colors = self.field_colors(values[whose]) if values else None
            self.renderer.set_triangles(whose, points, triangles, color, self.opacity[whose], colors)
            self.renderer.set_lines(f"edges of {whose}", lines[whose], color, 0.0008 * self.extent)

    def field_colors(self, values):
        """Of triangles, the more opaque the larger their values [n][4] of 0 to 255."""
        colors = self.surface_colors.to_rgba(values)
        share = np.clip(values / self.run.surfaces.limit, 0, 1)
        colors[:, 3] = WALL_OPACITY + (COLORED_OPACITY - WALL_OPACITY) * share
        return (255 * colors).round().astype(np.uint8)

    def draw_discs(self, flat, radii, colors):
        """Far ones first and darker."""
        order = np.argsort(flat[:, 2])
        depth = flat[order, 2]
        light = 0.45 + 0.55 * (depth - depth.min()) / max(np.ptp(depth), 1e-300) if len(order) else depth
        place_discs(self.discs, flat[order, :2], radii[order])
        self.discs.set_facecolor(colors[order] * light[:, None])
