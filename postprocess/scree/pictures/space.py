"""Pictures of a 3D run: spheres and meshes, seen from the front and above."""

import matplotlib
import numpy as np

from scree.fields import POSITION
from scree.pictures.flat import FlatMechanism, FlatSurfaces, disc_collection, place_discs
from scree.pictures.framing import body_bounds, figure_size, picture_axes, scene_bounds, union
from scree.pictures.marks import draw_directions, draw_scale_bar
from scree.pictures.mechanism import Mechanism
from scree.pictures.palette import (BODY_COLOR, COLORED_OPACITY, EDGE_COLOR, GLASS, JOINTS, LINES, SURFACE_COLORS,
                                    SURFACE_MAP, rgb)
from scree.pictures.styles import BALL, SMALL, TUBE
from scree.pictures.walls import section

LIGHT = np.array([-0.4, 0.75, 0.53])  # direction of the light on walls: right, up, towards the viewer
DOTS = 160  # pixels per inch of the axes rendered by VTK
MARGIN, FADED = 1.1, 0.05  # margin factor; fraction of the picture's width over which the ground fades out
FINE = 1.5  # factor of the resolution for single pictures


def faded(pixels):
    """Fades to white at the sides, to hide the ends of shadows. pixels: [height][width][3] of 0 to 255."""
    height, width = pixels.shape[:2]
    ramps = [np.clip(np.minimum(np.arange(n) + 0.5, n - 0.5 - np.arange(n)) / (FADED * width), 0, 1)
             for n in (height, width)]
    weight = np.minimum(ramps[0][:, None], ramps[1][None])[..., None]
    return (255 - weight * (255.0 - pixels)).round().astype(np.uint8)


class SphereScene:
    """Parallel projection with a uniform scale; gravity points down."""

    def __init__(self, run, snapshots, use_vtk, opacity=None, fine=False):
        """opacity: of meshes on bodies; None: opaque, except meshes that hold particles."""
        self.run, self.use_vtk, self.opacity, self.fine = run, use_vtk, opacity, fine
        self.axes_of_picture = picture_axes(run.model.up)
        self.box = (run.model.low, run.model.high)
        bodies = body_bounds(run, snapshots)
        low, high = scene_bounds(run, snapshots, bodies) if use_vtk else union(self.box, bodies)
        self.shown = (low, high)
        self.center = (low + high) / 2
        self.extent = max(high - low)
        corners = np.array(
            [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
        )
        flat = self.project(corners)
        self.half = MARGIN * np.abs(flat[:, :2]).max(axis=0)  # half width and height of the picture [m]
        self.ground = (corners @ run.model.up).min()  # coordinate of the ground along the upward direction [m]

    def project(self, points):
        """Coordinates of points to the right, upwards and towards the viewer, from the centre of the picture [m]."""
        return (points - self.center) @ self.axes_of_picture.T

    def shows(self, points, radii):
        """For each sphere, whether a part of it is inside the picture; it may be hidden by others."""
        return (np.abs(self.project(points)[:, :2]) - radii[:, None] < self.half).all(axis=1)

    def size(self):
        return figure_size(*self.half)

    def faces(self):
        """Walls as (polygon, colour, opacity). Of the sides of the domain only those behind the particles."""
        found = []
        inner, sides = self.run.model.walls, self.run.model.side_walls()
        for opacity, walls in ((1.0, sides), (0.5, inner)):
            for point, normal in walls:
                towards_light = normal @ (self.axes_of_picture.T @ LIGHT) / np.linalg.norm(normal)
                if opacity < 1 or normal @ self.axes_of_picture[2] > 0:
                    color = np.full(3, 0.78 + 0.14 * towards_light)
                    found.append((section(*self.box, point, normal), color, opacity))
        return [face for face in found if len(face[0])]

    def set_up(self, axes, coloring):
        self.coloring = coloring
        self.colors = matplotlib.cm.ScalarMappable(coloring.norm, coloring.map)
        if self.run.surfaces:
            self.surface_colors = matplotlib.cm.ScalarMappable(
                matplotlib.colors.Normalize(0, self.run.surfaces.limit), SURFACE_MAP
            )
        axes.set_aspect("equal")
        axes.set_xlim(-self.half[0], self.half[0])
        axes.set_ylim(-self.half[1], self.half[1])
        axes.set_axis_off()
        draw_scale_bar(axes)
        origin = -self.half + 0.1 * self.half.min()
        draw_directions(axes, origin, 0.1 * self.half.min(), dict(zip("xyz", self.axes_of_picture[:2].T)))
        mechanism = Mechanism(self.run.model, self.run.motion, SMALL * self.extent)
        if self.use_vtk:
            self.mechanism = mechanism
            self.set_up_renderer(axes)
        else:
            self.draw_box(axes)
            self.discs = disc_collection(axes, edgecolors=EDGE_COLOR, linewidths=0.2)
            self.mechanism = FlatMechanism(mechanism, axes, lambda points: self.project(points)[..., :2])
            self.surfaces = FlatSurfaces(self.run.surfaces, axes, lambda points: self.project(points)[..., :2])

    def set_up_renderer(self, axes):
        from scree.pictures.spheres import SphereRenderer

        pixels = np.round(np.array(self.size()) * DOTS * (FINE if self.fine else 1)).astype(int)
        pixels[1] = round(pixels[0] * self.half[1] / self.half[0])
        self.renderer = SphereRenderer(pixels, self.center, self.axes_of_picture, self.half[1], self.extent)
        if any(kind != "open" for kind in self.run.model.boundaries.values()):  # clipped to the bounds of the picture
            self.renderer.add_box(np.maximum(self.box[0], self.shown[0]), np.minimum(self.box[1], self.shown[1]))
        self.renderer.add_ground(self.run.model.up, self.ground)
        inner = [face for face in self.faces() if face[2] < 1]
        for face in inner:
            self.renderer.add_face(*face)
        extent = (-self.half[0], self.half[0], -self.half[1], self.half[1])
        self.image = axes.imshow(np.zeros((2, 2, 3)), extent=extent, interpolation="antialiased", zorder=0)

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

    def draw(self, snapshot):
        particles, (shapes, sizes) = self.run.particles, self.run.shapes(snapshot)
        points, radii = particles.rows(snapshot, POSITION), particles.rows(snapshot, "radius")
        colors = self.colors.to_rgba(self.coloring.values(particles, snapshot))[:, :3]
        points, radii = np.concatenate([points, shapes]), np.concatenate([radii, sizes])
        colors = np.concatenate([colors, np.tile(rgb(BODY_COLOR), (len(shapes), 1))])
        if not self.use_vtk:
            self.draw_discs(self.project(points), radii, colors)
            self.surfaces.draw(snapshot)
            self.mechanism.draw(snapshot)
            return
        self.draw_surfaces(snapshot)
        lines, joints = self.mechanism.draw(snapshot)
        for style, (color, width, _) in LINES.items():
            strokes = lines.get(style, np.empty((0, 2, 3)))
            self.renderer.set_lines(style, strokes, rgb(color), TUBE * width * self.extent)
        balls = np.concatenate([joints[kind] for kind in JOINTS])
        points, radii = np.concatenate([points, balls]), np.append(radii, np.full(len(balls), BALL * self.extent))
        colors = np.concatenate([colors, np.tile(rgb(EDGE_COLOR), (len(balls), 1))])
        self.image.set_data(faded(self.renderer.image(points, radii, colors)))

    def draw_surfaces(self, snapshot):
        if not self.run.surfaces:
            return
        surfaces = self.run.surfaces
        points, lines = surfaces.points(snapshot), surfaces.lines(snapshot)
        values = surfaces.values(snapshot) if surfaces.field else {}
        for owner, triangles in surfaces.triangles.items():
            color = rgb(SURFACE_COLORS[owner])
            for glass in (False, True):
                rows = surfaces.glass[owner] == glass
                opacity = GLASS if glass else 1.0
                if owner == "bodies" and self.opacity is not None:
                    opacity = self.opacity
                colors = self.field_colors(values[owner][rows], opacity) if values else None
                self.renderer.set_triangles(f"{owner}, {glass}", points, triangles[rows], color, opacity, colors)
            self.renderer.set_lines(f"edges of {owner}", lines[owner], 0.55 * np.array(color), 0.5 * TUBE * self.extent)

    def field_colors(self, values, opacity):
        """Colours [n][4] of 0 to 255 of triangles, with an opacity that grows with the value."""
        colors = self.surface_colors.to_rgba(values)
        fraction = np.clip(values / self.run.surfaces.limit, 0, 1)
        colors[:, 3] = opacity + (max(COLORED_OPACITY, opacity) - opacity) * fraction
        return (255 * colors).round().astype(np.uint8)

    def draw_discs(self, flat, radii, colors):
        """Discs in the order of depth, distant ones first and darker."""
        order = np.argsort(flat[:, 2])
        depth = flat[order, 2]
        light = 0.45 + 0.55 * (depth - depth.min()) / max(np.ptp(depth), 1e-300) if len(order) else depth
        place_discs(self.discs, flat[order, :2], radii[order])
        self.discs.set_facecolor(colors[order] * light[:, None])
