"""The final state of a run and an animation of it, without a display."""

import pathlib
import subprocess
import sys
from dataclasses import dataclass

import matplotlib

matplotlib.use("Agg")

import matplotlib.animation
import matplotlib.pyplot as plt
import numpy as np

from model import read_model
from results import fail, open_series, read_history
from scenes import WALL_OPACITY, DiscScene, SphereScene
from surfaces import Surfaces

COLOR_MAP = "viridis"  # ordered in lightness, safe for the colour-blind
FRAMES_PER_SECOND = 25


def vtk_renders():
    """Whether VTK can draw here; tried in another process: it crashes where it finds no OpenGL library."""
    probe = pathlib.Path(__file__).with_name("spheres.py")
    if subprocess.run([sys.executable, probe], capture_output=True).returncode == 0:
        return True
    print(
        "VTK cannot render here (is libegl1 installed?): spheres are drawn as shaded discs", file=sys.stderr
    )
    return False


def chosen_frames(count, limit):
    """At most `limit` snapshots, evenly spread, the first and the last among them."""
    return np.unique(np.linspace(0, count - 1, min(count, limit)).round().astype(int))


class Run:
    """What a run left in its folder."""

    def __init__(self, directory):
        self.model = read_model(directory)
        self.particles = open_series(directory, "particles")
        if self.particles is None:
            fail(f"{directory}: no particles.vtkhdf there")
        self.bodies = open_series(directory, "bodies")
        surfaces = open_series(directory, "surfaces")
        self.surfaces = Surfaces(surfaces) if surfaces else None
        bare = any(len(offsets) == 0 for offsets in self.model.offsets)
        self.history = read_history(directory) if bare else {}

    def motion(self, snapshot):
        return self.model.motion(self.particles.times[snapshot], self.bodies, snapshot, self.history)


def speed_limit(particles, snapshots):
    """Upper end of the colour scale [m/s]: the fastest particle but for the last percent, rounded up."""
    speeds = [np.percentile(s, 99) for s in (particles.speed(i) for i in snapshots) if len(s)]
    largest = max(speeds, default=0.0)
    if largest <= 0:
        return 1.0
    unit = 10.0 ** np.floor(np.log10(largest))
    return float(
        next(step * unit for step in (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10) if step * unit >= largest)
    )


class Picture:
    """One figure whose scene changes from snapshot to snapshot."""

    def __init__(self, scene, run, snapshots, fastest):
        self.scene, self.run = scene, run
        width, height = scene.size()
        self.figure, axes = plt.subplots(figsize=(width + 1.6, height + 1.1), dpi=120, layout="constrained")
        scene.set_up(axes, COLOR_MAP, fastest)
        self.bar = None
        if any(len(run.particles.rows(snapshot, "radius")) for snapshot in snapshots):
            self.bar = self.figure.colorbar(scene.colors, ax=axes, extend="max", shrink=0.85, pad=0.02)
            self.bar.set_label("particle speed [m/s]", fontsize=13)
            self.bar.ax.tick_params(labelsize=11)
        if run.surfaces and run.surfaces.field:
            bar = self.figure.colorbar(scene.surface_colors, ax=axes, extend="max", shrink=0.85, pad=0.02)
            bar.set_label(run.surfaces.label(), fontsize=13)
            bar.ax.tick_params(labelsize=11)
        self.title = axes.set_title(" ", fontsize=14, loc="left")
        axes.tick_params(labelsize=11)

    def caption(self, snapshot):
        parts = [f"t = {self.run.particles.times[snapshot]:.4g} s"]
        bodies = len(self.run.model.names)
        if self.bar:
            parts.append(counted(len(self.run.particles.rows(snapshot, "radius")), "particle", "particles"))
        if bodies:
            parts.append(counted(bodies, "body", "bodies") + " (orange)")
        return f"{self.run.model.title}\n{', '.join(parts)}"

    def draw(self, snapshot):
        self.scene.draw(snapshot)
        self.title.set_text(self.caption(snapshot))
        if self.figure.get_layout_engine() is not None:
            self.figure.canvas.draw()
            self.figure.set_layout_engine("none")  # laid out once, so that frames are quick and nothing jumps


def counted(count, one, many):
    return f"{count:,} {one if count == 1 else many}"


@dataclass
class Look:
    """What a user may choose of pictures."""

    view: list | None = None  # part of the plane, of runs in it [m]
    opacity: float = WALL_OPACITY  # of meshes on bodies
    fastest: float | None = None  # upper end of the colour scale [m/s]
    surfaces: str | None = None  # field by which meshes are coloured


def make_picture(run, snapshots, with_vtk=False, look=Look()):
    if run.model.planar:
        scene = DiscScene(run, snapshots, look.view)
    else:
        scene = SphereScene(run, snapshots, with_vtk, look.opacity)
    return Picture(scene, run, snapshots, look.fastest or speed_limit(run.particles, snapshots))


def save_picture(picture, snapshot, path):
    picture.draw(snapshot)
    picture.figure.savefig(path)
    plt.close(picture.figure)


def save_animation(picture, snapshots, directory):
    """Returns the file's path."""
    if matplotlib.animation.FFMpegWriter.isAvailable():
        path = directory / "animation.mp4"
        # Players want even numbers of pixels and this pixel format.
        options = ["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white", "-pix_fmt", "yuv420p", "-crf", "20"]
        writer = matplotlib.animation.FFMpegWriter(fps=FRAMES_PER_SECOND, codec="libx264", extra_args=options)
    else:
        path = directory / "animation.gif"
        writer = matplotlib.animation.PillowWriter(fps=FRAMES_PER_SECOND)
    with writer.saving(picture.figure, path, dpi=picture.figure.dpi):
        for snapshot in snapshots:
            picture.draw(snapshot)
            writer.grab_frame()
    plt.close(picture.figure)
    return path


def draw_run(directory, frames, with_vtk, look):
    """Writes the final state and, with more than one frame, the animation; yields their paths."""
    run = Run(directory)
    if look.view and not run.model.planar:
        fail("--view is for runs in the plane")
    with_vtk = with_vtk and not run.model.planar and vtk_renders()
    last = len(run.particles) - 1
    if look.surfaces:
        if not with_vtk or not run.surfaces:
            fail("--surfaces is for runs in space with meshes, drawn by VTK")
        run.surfaces.color_by(look.surfaces, [*chosen_frames(len(run.particles), frames), last])
    seen = run.motion(last).known
    if run.surfaces:
        seen[run.surfaces.bodies] = True
    unseen = int((~seen).sum())
    if unseen:
        print(f"{counted(unseen, 'body', 'bodies')} without shapes and not in output.history_bodies: not drawn",
              file=sys.stderr)
    path = pathlib.Path(directory) / "final.png"
    save_picture(make_picture(run, [last], with_vtk, look), last, path)
    yield path
    chosen = chosen_frames(len(run.particles), frames)
    if len(chosen) > 1:
        yield save_animation(make_picture(run, chosen, with_vtk, look), chosen, pathlib.Path(directory))
