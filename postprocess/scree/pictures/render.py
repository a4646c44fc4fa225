"""Pictures of a run at its snapshots, and animations of them, without a display."""

from __future__ import annotations

import io
import pathlib
import subprocess
import sys
import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.animation
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.text import Text
from matplotlib.ticker import FixedFormatter, FixedLocator, MaxNLocator
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from scree.errors import ScreeError
from scree.fields import POSITION
from scree.pictures.coloring import SPEED, Coloring, coloring
from scree.pictures.discs import DiscScene
from scree.pictures.model import Model, Motion
from scree.pictures.palette import INK, PALE_INK
from scree.pictures.space import SphereScene
from scree.pictures.surfaces import Surfaces
from scree.run import Run

FRAMES_PER_SECOND = 25
TITLE, SUBTITLE, LABEL = 16, 12, 12  # sizes of letters [pt]
MARGIN = 0.08  # around words [inch]
WIDE = 0.58  # mean width of a letter, over its size
FILM_FORMATS = ("mp4", "webp", "gif")
WEBP_QUALITY = 80


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
        self.title, self.model, self.record = run.title, Model(run.deck), run.record
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


def wrapped(text: str, size: float, width: float) -> str:
    """In lines no longer than a width [inch]. size: of the letters [pt]."""
    return textwrap.fill(text, max(int(72 * width / (WIDE * size)), 8))


class Picture:
    """One figure whose scene changes from snapshot to snapshot."""

    def __init__(self, scene: DiscScene | SphereScene, run: DrawnRun, snapshots: Sequence[int],
                 colors: Coloring) -> None:
        self.scene, self.run, self.colors = scene, run, colors
        width, height = scene.size()
        title = wrapped(run.title, TITLE, width + 1.3)
        layout = ConstrainedLayoutEngine(w_pad=0.15, h_pad=0.2)
        self.figure, axes = plt.subplots(figsize=(width + 1.6, height + 1.3), dpi=120, layout=layout)
        scene.set_up(axes, colors)
        self.bar = None
        if any(len(run.particles.rows(snapshot, "radius")) for snapshot in snapshots):
            self.bar = self.add_bar(axes, scene.colors, wrapped(colors.label, LABEL, height), colors.names,
                                    below=colors.low < 0)
        if isinstance(scene, SphereScene) and run.surfaces and run.surfaces.field:
            self.add_bar(axes, scene.surface_colors, wrapped(run.surfaces.label(), LABEL, height))
        self.title, self.subtitle = (
            axes.annotate(text, (0, 1), (0, height), xycoords="axes fraction", textcoords="offset points",
                          fontsize=size, color=color, va="bottom")
            for text, height, size, color in ((title, 24, TITLE, INK), (" ", 6, SUBTITLE, PALE_INK)))

    def add_bar(self, axes: Axes, colors: ScalarMappable, label: str, names: Sequence[str] = (),
                below: bool = False) -> Colorbar:
        """names: of what the colours stand for, from 0 on, in place of numbers; below: values may lie below the
        scale, as they may above it."""
        extend = "neither" if names else "both" if below else "max"
        bar = self.figure.colorbar(colors, ax=axes, extend=extend, shrink=0.5, aspect=25, pad=0.02)
        bar.set_label(label, fontsize=LABEL, color=INK)
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

    def imprint(self, snapshot: int) -> dict[str, str]:
        """What a file of the picture at a snapshot says of it, in words."""
        said = {"Title": self.run.title, "Description": self.caption(snapshot)}
        if self.bar:
            said["Color bar"] = self.colors.words()
        if self.run.record:
            build = self.run.record["build"]
            said["Software"] = f"Scree {build['version']}, commit {build['commit']}"
        return said

    def draw(self, snapshot: int) -> None:
        self.scene.draw(snapshot)
        self.subtitle.set_text(self.caption(snapshot))
        if self.figure.get_layout_engine() is not None:
            self.figure.canvas.draw()
            self.figure.set_layout_engine("none")  # laid out once, so that frames are quick and nothing jumps
            self._make_room()

    def _make_room(self) -> None:
        """The figure becomes so large that all words are in it."""
        figure, margin = self.figure, MARGIN * self.figure.dpi
        size = np.array(figure.canvas.get_width_height(), dtype=float)
        texts = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text().strip()]
        words = [text.get_window_extent() for text in texts]
        low = np.min([[box.x0, box.y0] for box in words], axis=0)
        high = np.max([[box.x1, box.y1] for box in words], axis=0)
        before, after = np.maximum(margin - low, 0).round(), np.maximum(high + margin - size, 0).round()
        larger = size + before + after
        for axes in figure.axes:
            place = axes.get_position()
            corner, extent = (place.p0 * size + before) / larger, place.size * size / larger
            axes.set_position((*corner, *extent))
        figure.set_size_inches(larger / figure.dpi)


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
    gravity, particles = float(np.linalg.norm(drawn.model.gravity)), drawn.particles

    def seen(snapshot: int) -> np.ndarray:
        return np.asarray(scene.shows(particles.rows(snapshot, POSITION), particles.rows(snapshot, "radius")))

    return Picture(scene, drawn, snapshots,
                   coloring(particles, look.color, snapshots, gravity, seen, look.fastest))


def save_picture(picture: Picture, snapshot: int, path: pathlib.Path) -> None:
    picture.draw(snapshot)
    if path.suffix == ".png":  # smaller than with the transparency that matplotlib gives it
        drawn = io.BytesIO()
        picture.figure.savefig(drawn, format="png")
        said = PngInfo()
        for name, text in picture.imprint(snapshot).items():
            said.add_text(name, text)
        Image.open(drawn).convert("RGB").save(path, optimize=True, pnginfo=said)
    else:
        picture.figure.savefig(path)
    plt.close(picture.figure)


class WebpWriter(matplotlib.animation.AbstractMovieWriter):
    """Frames that are compressed at a quality of one's choice, as pages load no large files."""

    def __init__(self, frames_per_second: int, quality: int) -> None:
        super().__init__(fps=frames_per_second)
        self.quality = quality
        self.frames: list[Image.Image] = []

    @classmethod
    def isAvailable(cls) -> bool:
        return True

    def setup(self, fig: Figure, outfile: Any, dpi: float | None = None) -> None:
        super().setup(fig, outfile, dpi=dpi)

    def grab_frame(self, **options: Any) -> None:
        drawn = io.BytesIO()
        self.fig.savefig(drawn, format="rgba", dpi=self.dpi, **options)
        self.frames.append(Image.frombytes("RGBA", self.frame_size, drawn.getvalue()).convert("RGB"))

    def finish(self) -> None:
        self.frames[0].save(self.outfile, save_all=True, append_images=self.frames[1:], quality=self.quality, loop=0,
                            duration=round(1000 / self.fps), method=4)


def animation_writer(format: str, frames_per_second: int, quality: int) -> matplotlib.animation.AbstractMovieWriter:
    """format: one of FILM_FORMATS. quality: of a webp, up to 100."""
    if format == "webp":
        return WebpWriter(frames_per_second, quality)
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
                   frames_per_second: int = FRAMES_PER_SECOND, width: int | None = None,
                   quality: int = WEBP_QUALITY) -> None:
    """The path ends in one of FILM_FORMATS. width: of the film [pixels]; None: that of the pictures. quality: of a
    webp, up to 100."""
    writer = animation_writer(path.suffix[1:], frames_per_second, quality)
    figure = picture.figure
    picture.draw(snapshots[0])  # which makes room for its words
    with writer.saving(figure, path, dpi=width / figure.get_figwidth() if width else figure.dpi):
        for snapshot in snapshots:
            picture.draw(snapshot)
            writer.grab_frame()
    plt.close(figure)
