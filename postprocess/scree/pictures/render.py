"""Pictures of a run at its snapshots, and animations of them, without a display."""

from __future__ import annotations

import io
import pathlib
import subprocess
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import matplotlib

matplotlib.use("Agg")

import matplotlib.animation
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import FixedFormatter, FixedLocator, MaxNLocator
from PIL import Image

from scree.errors import ScreeError
from scree.pictures.coloring import SPEED, Coloring, coloring
from scree.pictures.discs import DiscScene
from scree.pictures.model import Model, Motion
from scree.pictures.palette import INK, PALE_INK
from scree.pictures.space import SphereScene
from scree.pictures.surfaces import Surfaces
from scree.run import Run
from scree.series import POSITION

FRAMES_PER_SECOND = 25
FILM_FORMATS = ("mp4", "webp", "gif")


def vtk_renders() -> bool:
    """Whether VTK can draw here; tried in another process: it crashes where it finds no OpenGL library."""
    probe = pathlib.Path(__file__).with_name("spheres.py")
    if subprocess.run([sys.executable, probe], capture_output=True).returncode == 0:
        return True
    print("VTK cannot render here (is libegl1 installed?): spheres are drawn as shaded discs", file=sys.stderr)
    return False


def chosen_frames(count: int, limit: int) -> list[int]:
    """At most `limit` snapshots, evenly spread, the first and the last among them."""
    return [int(k) for k in np.unique(np.linspace(0, count - 1, min(count, limit)).round())]


class DrawnRun:
    """What pictures show of a run."""

    def __init__(self, run: Run) -> None:
        self.title, self.model = run.title, Model(run.deck)
        particles = run.series("particles")
        if particles is None:
            missing = "particles.vtkhdf, which pictures need" if len(run.snapshots) else "snapshots"
            raise ScreeError(f"{run.folder}: holds no {missing}")
        self.particles = particles
        self.bodies = run.series("bodies")
        surfaces = run.series("surfaces")
        self.surfaces = Surfaces(surfaces, self.model.holding) if surfaces else None

    def motion(self, snapshot: int) -> Motion:
        found: Motion = self.model.motion(self.bodies, snapshot)
        return found

    def shapes(self, snapshot: int) -> tuple[np.ndarray, np.ndarray]:
        """Centres and radii of the bodies' discs or spheres [m]; their centres of mass have no size."""
        if self.bodies is None:
            return np.empty((0, 3)), np.empty(0)
        radii = self.bodies.rows(snapshot, "radius")
        return self.bodies.rows(snapshot, POSITION)[radii > 0], radii[radii > 0]


class Picture:
    """One figure whose scene changes from snapshot to snapshot."""

    def __init__(self, scene: DiscScene | SphereScene, run: DrawnRun, snapshots: Sequence[int],
                 colors: Coloring) -> None:
        self.scene, self.run = scene, run
        width, height = scene.size()
        layout = ConstrainedLayoutEngine(w_pad=0.15, h_pad=0.2)
        self.figure, axes = plt.subplots(figsize=(width + 1.6, height + 1.3), dpi=120, layout=layout)
        scene.set_up(axes, colors)
        self.bar = None
        if any(len(run.particles.rows(snapshot, "radius")) for snapshot in snapshots):
            self.bar = self.add_bar(axes, scene.colors, colors.label, colors.names)
        if isinstance(scene, SphereScene) and run.surfaces and run.surfaces.field:
            self.add_bar(axes, scene.surface_colors, run.surfaces.label())
        self.title, self.subtitle = (
            axes.annotate(text, (0, 1), (0, height), xycoords="axes fraction", textcoords="offset points",
                          fontsize=size, color=color)
            for text, height, size, color in ((run.title, 28, 16, INK), (" ", 9, 12, PALE_INK)))

    def add_bar(self, axes: Axes, colors: ScalarMappable, label: str, names: Sequence[str] = ()) -> Colorbar:
        """names: of what the colours stand for, from 0 on, in place of numbers."""
        extend = "neither" if names else "max"
        bar = self.figure.colorbar(colors, ax=axes, extend=extend, shrink=0.5, aspect=25, pad=0.02)
        bar.set_label(label, fontsize=12, color=INK)
        bar.ax.tick_params(labelsize=11, color=PALE_INK, labelcolor=INK)
        if names:
            bar.ax.minorticks_off()
            bar.locator, bar.formatter = FixedLocator(range(len(names))), FixedFormatter(names)
        else:
            bar.locator = MaxNLocator(5)
        bar.outline.set_visible(False)
        bar.update_ticks()
        return bar

    def caption(self, snapshot: int) -> str:
        parts = [f"t = {self.run.particles.times[snapshot]:.4g} s"]
        bodies = len(self.run.model.names)
        if self.bar:
            parts.append(counted(len(self.run.particles.rows(snapshot, "radius")), "particle", "particles"))
        if bodies:
            parts.append(counted(bodies, "body", "bodies") + " (orange)")
        return ", ".join(parts)

    def draw(self, snapshot: int) -> None:
        self.scene.draw(snapshot)
        self.subtitle.set_text(self.caption(snapshot))
        if self.figure.get_layout_engine() is not None:
            self.figure.canvas.draw()
            self.figure.set_layout_engine("none")  # laid out once, so that frames are quick and nothing jumps


def counted(count: int, one: str, many: str) -> str:
    return f"{count:,} {one if count == 1 else many}"


@dataclass
class Look:
    """What a user may choose of pictures."""

    view: Sequence[float] | None = None  # part of the plane, of runs in it [m]
    axes: bool = False  # with coordinates, of runs in the plane, in place of a scale bar
    opacity: float | None = None  # of meshes on bodies; None: solid ones are opaque, those that hold particles are not
    color: str = SPEED  # field by which particles are coloured
    fastest: float | None = None  # upper end of the scale of speeds [m/s]
    surfaces: str | None = None  # field by which meshes are coloured
    with_vtk: bool = True  # spheres are drawn by VTK, where it can

    def fit(self, drawn: DrawnRun, snapshots: Iterable[int]) -> None:
        """Makes ready for pictures of this run at these snapshots. Throws ScreeError where it cannot look like this."""
        if self.fastest and self.color != SPEED:
            raise ScreeError(f"the fastest speed ends a scale of speeds; particles are coloured by {self.color}")
        if (self.view or self.axes) and not drawn.model.planar:
            raise ScreeError("a view and axes are for runs in the plane")
        self.with_vtk = self.with_vtk and not drawn.model.planar and vtk_renders()
        if self.surfaces:
            if not self.with_vtk or not drawn.surfaces:
                raise ScreeError("surfaces are coloured in runs in space with meshes, drawn by VTK")
            drawn.surfaces.color_by(self.surfaces, snapshots)


def make_picture(drawn: DrawnRun, snapshots: Sequence[int], look: Look, fine: bool = False) -> Picture:
    """A picture that fits all of these snapshots. look: fitted; fine: smoother than a frame of a film need be."""
    scene = (DiscScene(drawn, snapshots, look.view, look.axes) if drawn.model.planar else
             SphereScene(drawn, snapshots, look.with_vtk, look.opacity, fine))
    gravity = float(np.linalg.norm(drawn.model.gravity))
    return Picture(scene, drawn, snapshots, coloring(drawn.particles, look.color, snapshots, gravity, look.fastest))


def save_picture(picture: Picture, snapshot: int, path: pathlib.Path) -> None:
    picture.draw(snapshot)
    if path.suffix == ".png":  # smaller than with the transparency that matplotlib gives it
        drawn = io.BytesIO()
        picture.figure.savefig(drawn, format="png")
        Image.open(drawn).convert("RGB").save(path, optimize=True)
    else:
        picture.figure.savefig(path)
    plt.close(picture.figure)


def animation_writer(format: str, frames_per_second: int) -> matplotlib.animation.AbstractMovieWriter:
    """format: one of FILM_FORMATS."""
    if format != "mp4":
        return matplotlib.animation.PillowWriter(fps=frames_per_second)
    if not has_ffmpeg():
        raise ScreeError("an mp4 needs the program ffmpeg; make a webp or gif instead")
    # Players want even numbers of pixels and this pixel format.
    options = ["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white", "-pix_fmt", "yuv420p", "-crf", "18", "-movflags",
               "+faststart"]
    return matplotlib.animation.FFMpegWriter(fps=frames_per_second, codec="libx264", extra_args=options)


def has_ffmpeg() -> bool:
    return matplotlib.animation.FFMpegWriter.isAvailable()


def save_animation(picture: Picture, snapshots: Sequence[int], path: pathlib.Path,
                   frames_per_second: int = FRAMES_PER_SECOND, width: int | None = None) -> None:
    """The path ends in one of FILM_FORMATS. width: of the film [pixels]; None: that of the pictures."""
    writer = animation_writer(path.suffix[1:], frames_per_second)
    figure = picture.figure
    with writer.saving(figure, path, dpi=width / figure.get_figwidth() if width else figure.dpi):
        for snapshot in snapshots:
            picture.draw(snapshot)
            writer.grab_frame()
    plt.close(figure)
