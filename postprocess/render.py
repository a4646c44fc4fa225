#!/usr/bin/env python3
"""Draws the final state of a run and an animation of it, without a display.

    python3 postprocess/render.py RESULT_DIR

Writes RESULT_DIR/final.png and RESULT_DIR/animation.mp4 (.gif where there is no ffmpeg). Particles are drawn
to scale and coloured by their speed, bodies in orange: discs in 2D, lit spheres in 3D.
"""

import argparse
import pathlib
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")

import matplotlib.animation
import matplotlib.pyplot as plt
import numpy as np

from results import fail, open_series
from scenes import DiscScene, SphereScene

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


def is_planar(particles, bodies):
    return all(
        np.ptp(series.rows(i, "Points")[:, 2]) == 0
        for series in (particles, bodies)
        if series
        for i in (0, len(series) - 1)
        if len(series.rows(i, "Points"))
    )


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

    def __init__(self, scene, particles, limit):
        self.scene, self.particles = scene, particles
        width, height = scene.size()
        self.figure, axes = plt.subplots(figsize=(width + 1.6, height + 1.1), dpi=120, layout="constrained")
        scene.set_up(axes, COLOR_MAP, limit)
        bar = self.figure.colorbar(scene.colors, ax=axes, extend="max", shrink=0.85, pad=0.02)
        bar.set_label("particle speed [m/s]", fontsize=13)
        bar.ax.tick_params(labelsize=11)
        self.title = axes.set_title(" ", fontsize=14, loc="left")
        axes.tick_params(labelsize=11)

    def draw(self, snapshot):
        self.scene.draw(snapshot)
        count = len(self.particles.rows(snapshot, "radius"))
        text = f"t = {self.particles.times[snapshot]:.4g} s, {count:,} particles"
        if self.scene.bodies:
            text += f", {len(np.unique(self.scene.bodies.rows(snapshot, 'body'))):,} bodies (orange)"
        self.title.set_text(f"{self.particles.title}\n{text}")
        if self.figure.get_layout_engine() is not None:
            self.figure.canvas.draw()
            self.figure.set_layout_engine("none")  # laid out once, so that frames are quick and nothing jumps


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


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("result_directory", type=pathlib.Path)
    parser.add_argument("--frames", type=int, default=200, help="largest number of frames (default 200)")
    parser.add_argument(
        "--view",
        type=float,
        nargs=4,
        metavar=("XMIN", "XMAX", "YMIN", "YMAX"),
        help="part of the plane to show, 2D only [m]; default: all but stray particles",
    )
    parser.add_argument("--no-animation", action="store_true")
    parser.add_argument("--no-vtk", action="store_true", help="draw spheres without VTK, as shaded discs")
    arguments = parser.parse_args()
    directory = arguments.result_directory
    particles = open_series(directory, "particles")
    if particles is None:
        fail(f"{directory}: no particles.vtkhdf there")
    bodies = open_series(directory, "bodies")
    planar = is_planar(particles, bodies)
    use_vtk = not planar and not arguments.no_vtk and vtk_renders()

    def picture(snapshots):
        if planar:
            scene = DiscScene(particles, bodies, snapshots, arguments.view)
        else:
            scene = SphereScene(particles, bodies, snapshots, use_vtk)
        return Picture(scene, particles, speed_limit(particles, snapshots))

    last = len(particles) - 1
    save_picture(picture([last]), last, directory / "final.png")
    print(directory / "final.png")
    frames = chosen_frames(len(particles), arguments.frames)
    if not arguments.no_animation and len(frames) > 1:
        print(save_animation(picture(frames), frames, directory))


if __name__ == "__main__":
    main()
