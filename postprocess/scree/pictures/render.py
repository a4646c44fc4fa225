"""Pictures and animations of the snapshots of a run, without a display."""

from __future__ import annotations

import io
import pathlib
import subprocess
import sys
import textwrap
from collections.abc import Callable, Iterable, Sequence
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
from matplotlib.transforms import Bbox
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
TITLE, SUBTITLE, LABEL = 16, 12, 12  # font sizes [pt]
MARGIN = 0.08  # around text [inch]
WIDE = 0.58  # mean width of a character over the font size
FILM_FORMATS = ("mp4", "webp", "gif")
WEBP_QUALITY = 80


def vtk_renders() -> bool:
    """Whether VTK can render here; tested in another process, because VTK crashes without an OpenGL library."""
    probe = pathlib.Path(__file__).with_name("spheres.py")
    if subprocess.run([sys.executable, probe], capture_output=True).returncode == 0:
        return True
    print("VTK cannot render here (is libegl1 installed?): spheres are drawn as shaded discs", file=sys.stderr)
    return False


def chosen_frames(count: int, limit: int) -> list[int]:
    """At most `limit` evenly spaced snapshots, including the first and the last."""
    return [int(k) for k in np.unique(np.linspace(0, count - 1, min(count, limit)).round())]


class DrawnRun:
    """The data of a run that pictures show."""

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
        """Centres and radii of the discs or spheres of bodies [m], without centres of mass."""
        if self.bodies is None:
            return np.empty((0, 3)), np.empty(0)
        radii = self.bodies.rows(snapshot, "radius")
        return self.bodies.rows(snapshot, POSITION)[radii > 0], radii[radii > 0]


def wrapped(text: str, size: float, width: float) -> str:
    """The text in lines of at most a width [inch]. size: font size [pt]."""
    return textwrap.fill(text, max(int(72 * width / (WIDE * size)), 8))


def always(box: Bbox) -> Callable[[Any, Any], Bbox]:
    """A locator of axes that do not move."""
    return lambda axes, renderer: box


class Picture:
    """A figure whose scene is updated for each snapshot."""

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
        """names: of categories, counted from 0, instead of numbers; below: values may be below the scale, not only
        above."""
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
            parts.append(counted(self.run.particles.whole_count(snapshot), "particle", "particles"))
        if bodies:
            parts.append(counted(bodies, "body", "bodies") + " (orange)")
        return ", ".join(parts)

    def imprint(self, snapshot: int) -> dict[str, str]:
        """Text fields of the picture file at a snapshot."""
        entries = {"Title": self.run.title, "Description": self.caption(snapshot)}
        if self.bar:
            entries["Color bar"] = self.colors.summary()
        if self.run.record:
            build = self.run.record["build"]
            entries["Software"] = f"Scree {build['version']}, commit {build['commit']}"
        return entries

    def draw(self, snapshot: int) -> None:
        self.scene.draw(snapshot)
        self.subtitle.set_text(self.caption(snapshot))
        if self.figure.get_layout_engine() is not None:
            self.figure.canvas.draw()
            self.figure.set_layout_engine("none")  # laid out once: faster, and without jumps between frames
            self._make_room()
            self._hold_bars()

    def _hold_bars(self) -> None:
        """Colour bars stay as they are: matplotlib's own locator would shorten those with a tip at each drawing."""
        for axes in self.figure.axes[1:]:
            axes.set_axes_locator(always(axes.get_position().frozen()))
            axes.set_box_aspect(None)

    def _make_room(self) -> None:
        """Enlarges the figure so that it contains all text."""
        figure, margin = self.figure, MARGIN * self.figure.dpi
        size = np.array(figure.canvas.get_width_height(), dtype=float)
        texts = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text().strip()]
        boxes = [text.get_window_extent() for text in texts]
        low = np.min([[box.x0, box.y0] for box in boxes], axis=0)
        high = np.max([[box.x1, box.y1] for box in boxes], axis=0)
        before, after = np.maximum(margin - low, 0).round(), np.maximum(high + margin - size, 0).round()
        larger = size + before + after
        for axes in figure.axes:
            box = axes.get_position()
            corner, extent = (box.p0 * size + before) / larger, box.size * size / larger
            axes.set_position((*corner, *extent))
        figure.set_size_inches(larger / figure.dpi)


def counted(count: int, one: str, many: str) -> str:
    return f"{count:,} {one if count == 1 else many}"


@dataclass
class PictureOptions:
    """Options of a user for pictures."""

    view: Sequence[float] | None = None  # part of the plane, planar runs only [m]
    axes: bool = False  # coordinates instead of a scale bar, planar runs only
    opacity: float | None = None  # opacity of meshes on bodies; None: opaque, except meshes that hold particles
    color: str = SPEED  # field by which particles are coloured
    fastest: float | None = None  # upper end of the speed scale [m/s]
    surfaces: str | None = None  # field by which meshes are coloured
    with_vtk: bool = True  # draw spheres by VTK if it can render

    def fit(self, drawn: DrawnRun, snapshots: Iterable[int]) -> None:
        """Prepares pictures of this run at these snapshots. Throws ScreeError if the options do not fit the run."""
        if self.fastest and self.color != SPEED:
            raise ScreeError(f"--fastest is for the speed scale; particles are coloured by {self.color}")
        if (self.view or self.axes) and not drawn.model.planar:
            raise ScreeError("--view and --axes are for planar runs")
        self.with_vtk = self.with_vtk and not drawn.model.planar and vtk_renders()
        if self.surfaces:
            if not self.with_vtk or not drawn.surfaces:
                raise ScreeError("--surfaces is for 3D runs with meshes, drawn by VTK")
            drawn.surfaces.color_by(self.surfaces, snapshots)


def make_picture(drawn: DrawnRun, snapshots: Sequence[int], options: PictureOptions,
                 fine: bool = False) -> Picture:
    """A picture for all of these snapshots. options: after fit(); fine: at a higher resolution than frames of a
    film."""
    scene = (DiscScene(drawn, snapshots, options.view, options.axes) if drawn.model.planar else
             SphereScene(drawn, snapshots, options.with_vtk, options.opacity, fine))
    gravity, particles = float(np.linalg.norm(drawn.model.gravity)), drawn.particles

    def visible(snapshot: int) -> np.ndarray:
        return np.asarray(scene.shows(particles.rows(snapshot, POSITION), particles.rows(snapshot, "radius")))

    return Picture(scene, drawn, snapshots,
                   coloring(particles, options.color, snapshots, gravity, visible, options.fastest))


def save_picture(picture: Picture, snapshot: int, path: pathlib.Path, colors: int = 0,
                 width: int | None = None) -> None:
    """colors: number of those of a PNG, for a smaller file; 0: all. width: in pixels."""
    picture.draw(snapshot)
    dpi = "figure" if width is None else width / picture.figure.get_figwidth()
    if path.suffix == ".png":  # without the transparency of matplotlib the file is smaller
        drawn = io.BytesIO()
        picture.figure.savefig(drawn, format="png", dpi=dpi)
        entries = PngInfo()
        for name, text in picture.imprint(snapshot).items():
            entries.add_text(name, text)
        image = Image.open(drawn).convert("RGB")
        if colors:
            image = image.quantize(colors, dither=Image.Dither.NONE)
        image.save(path, optimize=True, pnginfo=entries)
    else:
        picture.figure.savefig(path, dpi=dpi)
    plt.close(picture.figure)


class WebpWriter(matplotlib.animation.AbstractMovieWriter):
    """Writes frames as webp with a selectable quality, for small files on web pages."""

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
    # Players require even numbers of pixels and this pixel format.
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
    picture.draw(snapshots[0])  # also enlarges the figure for its text
    with writer.saving(figure, path, dpi=width / figure.get_figwidth() if width else figure.dpi):
        for snapshot in snapshots:
            picture.draw(snapshot)
            writer.grab_frame()
    plt.close(figure)
