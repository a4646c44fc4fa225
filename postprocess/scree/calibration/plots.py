"""Plots of the four tests."""

from __future__ import annotations

import pathlib
from collections.abc import Callable

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from scree.calibration.runs import Measured
from scree.calibration.tests import column_curve, drum_surface, ledge_surface, shear_curve
from scree.plots import COLORS

SHOWN = 0.25  # compression of a column up to which its stress is drawn


def surfaces(axes: list[Axes], measured: Measured) -> None:
    """Heights of the surface and the line through them, per seed."""
    find = ledge_surface if "gate" in {wall.get("name") for wall in measured.runs[0][0].deck["walls"]} else drum_surface
    for seed, (run,) in enumerate(measured.runs):
        found, color = find(run), COLORS[seed % len(COLORS)]
        axes[0].plot(1e3 * found.x, 1e3 * found.height, "o", color=color,
                     label=f"seed {seed + 1}: {found.angle:.1f} degrees")
        axes[0].plot(1e3 * found.x, 1e3 * (found.start + found.slope * found.x), color=color)
    axes[0].set(xlabel="x [mm]", ylabel="height of the surface [mm]")
    axes[0].set_aspect("equal", "datalim")
    axes[0].legend()


def rounded(stress: float) -> str:
    return f"{float(f'{stress:.3g}'):g} Pa"


def shear(axes: list[Axes], measured: Measured) -> None:
    """Shear stress over the displacement for the first seed; peak and residual stress over the normal stress."""
    for run in measured.runs[0]:
        moved, stress, normal = shear_curve(run)
        axes[0].plot(1e3 * moved, stress, linewidth=0.8, label=f"normal stress {rounded(normal.mean())}")
    axes[0].set(xlabel="displacement [mm]", ylabel="shear stress [Pa]")
    lines(axes[1], measured, "normal", {"peak": "o", "residual": "s"})
    for name, color in (("peak", COLORS[0]), ("residual", COLORS[1])):
        stress = np.array([0.0, max(each["normal"] for row in measured.values for each in row)])
        slope = np.tan(np.radians(measured.mean(f"{name}_angle")))
        axes[1].plot(stress, measured.mean(f"{name}_cohesion") + slope * stress, color=color)
    axes[1].set(xlabel="normal stress [Pa]", ylabel="shear stress [Pa]", xlim=(0, None), ylim=(0, None))
    for each in axes:
        each.legend()


def uniaxial(axes: list[Axes], measured: Measured) -> None:
    """Stress over compression for the first seed; strength over consolidation stress, with the means over the seeds."""
    highest = 0.0
    for run in measured.runs[0]:
        consolidation, compression, stress = column_curve(run)
        axes[0].plot(100 * compression, stress, linewidth=0.8, label=f"consolidated at {rounded(consolidation)}")
        highest = max(highest, float(stress[compression < SHOWN].max(initial=0.0)))  # later it is on the base
    axes[0].set(xlabel="compression of the free column [%]", ylabel="stress [Pa]", xlim=(-1, 100 * SHOWN),
                ylim=(0, 1.3 * highest or None))
    lines(axes[1], measured, "consolidation", {"strength": "o"})
    means = [[np.mean([of_seed[k][name] for of_seed in measured.values]) for k in range(len(measured.values[0]))]
             for name in ("consolidation", "strength")]
    axes[1].plot(*means, color=COLORS[0], linewidth=0.8, label="mean")
    axes[1].set(xlabel="consolidation stress [Pa]", ylabel="unconfined yield strength [Pa]", xlim=(0, None),
                ylim=(0, None))
    for each in axes:
        each.legend()


def lines(axes: Axes, measured: Measured, x: str, marks: dict[str, str]) -> None:
    """Values of all seeds over another value."""
    for k, (name, mark) in enumerate(marks.items()):
        rows = [each for of_seed in measured.values for each in of_seed]
        axes.plot([each[x] for each in rows], [each[name] for each in rows], mark, color=COLORS[k], label=name)


DRAWN: dict[str, tuple[Callable[[list[Axes], Measured], None], int]] = {
    "repose": (surfaces, 1), "drum": (surfaces, 1), "shear": (shear, 2), "uniaxial": (uniaxial, 2)}


def draw(name: str, title: str, measured: Measured, path: pathlib.Path) -> None:
    content, count = DRAWN[name]
    figure, axes = plt.subplots(1, count, figsize=(5.5 * count, 4.2), layout="constrained", squeeze=False)
    content(list(axes[0]), measured)
    figure.suptitle(title)
    figure.savefig(path, dpi=110)
    plt.close(figure)
