"""Plots of energies, their balance and other columns of the history, over time or over another column."""

from __future__ import annotations

import itertools
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import EngFormatter

from scree.columns import panels, x_axis
from scree.errors import ScreeError
from scree.history import TIME, History

# Okabe and Ito's palette for colour-blind readers; further lines repeat it with dashes.
COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#8a8a00"]
PREFIXED = ("N", "N m", "J", "W", "m", "m/s", "s", "Pa")  # units with prefixes
WIDTH = 11  # figure width [inch]
LEGEND, LEGEND_LINE = 34, 0.235  # characters per line of a legend; height of a line [inch]

# Columns of the group energy: legend and colour, common to all plots.
STORED = {
    "kinetic": ("kinetic", COLORS[0]),
    "gravitational": ("gravitational, above its minimum", COLORS[2]),
    "elastic_force_elements": ("elastic, in springs and other force elements", COLORS[3]),
    "elastic_contacts": ("elastic, in contacts", COLORS[4]),
    "total": ("total", COLORS[6]),
}
TRANSFERRED = {
    "dissipated_contacts": ("dissipated in contacts", COLORS[4]),
    "dissipated_force_elements": ("dissipated in dampers and other force elements", COLORS[3]),
    "dissipated_integrator": ("dissipated by the time integration", COLORS[5]),
    "driver_work": ("work of drivers, motors and walls", COLORS[1]),
    "carried_out": ("carried out by escaped particles", COLORS[7]),
}


@dataclass
class Line:
    values: np.ndarray
    label: str
    color: str | None = None  # None: next colour of the palette


@dataclass
class Panel:
    """One plot: title, vertical axis, lines and height [inch]."""

    title: str
    axis: str
    lines: list[Line]
    height: float = 3.0
    unit: str = ""  # unit of ticks with a prefix; empty: plain numbers
    notes: list[str] = field(default_factory=list)

    def draw(self, along: np.ndarray, axes: Axes) -> None:
        """along: values of the horizontal axis. Lines that are zero everywhere become a note."""
        zero = [line.label for line in self.lines if not np.any(line.values)]
        shown = [line for line in self.lines if line.label not in zero]
        notes = self.notes + [f"Zero throughout: {'; '.join(zero)}."] * bool(zero)
        axes.set_title(self.title, fontsize=13, loc="left", pad=8 + 14 * sum(map(len, self._wrapped(notes))))
        for row, text in enumerate(reversed(sum(self._wrapped(notes), []))):
            axes.annotate(text, (0, 1), (0, 5 + 14 * row), xycoords="axes fraction", textcoords="offset points",
                          fontsize=10, color="#505050")
        styles = itertools.cycle(itertools.product(["-", "--", ":", "-."], COLORS))
        for line, (dash, color) in zip(shown, styles):
            label = textwrap.fill(line.label, LEGEND)
            dash, color = ("-", line.color) if line.color else (dash, color)
            axes.plot(along, line.values, dash, color=color, linewidth=1.6, label=label)
        if not shown:
            axes.set_yticks([])
        if shown and len(self.lines) > 1:  # also for a single remaining line, to name it
            axes.legend(fontsize=11, loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False)
        axes.set_ylabel(self.axis, fontsize=12)
        if self.unit:
            axes.yaxis.set_major_formatter(EngFormatter(self.unit))
        axes.yaxis.get_offset_text().set_horizontalalignment("right")  # next to the notes
        axes.tick_params(labelsize=11)
        axes.grid(color="#dddddd", linewidth=0.6)
        axes.spines[["top", "right"]].set_visible(False)
        axes.margins(x=0.01)

    @staticmethod
    def _wrapped(notes: Sequence[str]) -> list[list[str]]:
        return [textwrap.wrap(note, 120) for note in notes]


def energy_lines(history: History, entries: Mapping[str, tuple[str, str]]) -> list[Line]:
    """Gravitational energy, whose zero is arbitrary, is shown above its minimum, and so is the total."""
    found = []
    gravity = history.get("energy/gravitational")
    lowest = np.nanmin(gravity.values) if gravity is not None and len(gravity) else 0.0
    for name, (label, color) in entries.items():
        if f"energy/{name}" in history:
            values = history[f"energy/{name}"].values
            found.append(Line(values - lowest if name in ("gravitational", "total") else values, label, color))
    return found


def balance_panel(history: History) -> Panel:
    """The energy balance residual over the largest energy exchanged."""
    error = history["energy/balance_error"].values
    exchanged = np.nanmax(history["energy/exchanged"].values, initial=0.0)
    largest = np.nanmax(np.abs(error), initial=0.0)
    title = f"Energy balance residual: at most {EngFormatter('J', places=2)(largest)}"
    if exchanged <= 0:
        return Panel(title, "residual", [Line(error, "residual")], 2.2, unit="J")
    percent = 100 * largest / exchanged
    title += f", {percent:.2g} % of the {EngFormatter('J', places=1)(exchanged)} exchanged"
    return Panel(title, "residual [%]", [Line(100 * error / exchanged, "residual")], 2.2)


def energy_panels(history: History) -> list[Panel]:
    """Empty if the history has no energies."""
    found = []
    stored, transferred = energy_lines(history, STORED), energy_lines(history, TRANSFERRED)
    if stored:
        found.append(Panel("Stored energy", "energy", stored, 4.0, unit="J"))
    if transferred:
        found.append(Panel("Energy added and removed since the start", "energy", transferred, 3.0, unit="J"))
    if "energy/balance_error" in history and "energy/exchanged" in history:
        found.append(balance_panel(history))
    return found


def wants_prefix(lines: Sequence[Line], unit: str) -> bool:
    """Whether ticks are more readable with a prefix (kN, mm) than with a power of ten."""
    largest = max((np.nanmax(np.abs(line.values), initial=0.0) for line in lines), default=0.0)
    return unit in PREFIXED and largest > 0 and not 0.01 <= largest < 10000


def column_panels(history: History, names: Sequence[str]) -> list[Panel]:
    """One panel per group and unit."""
    found = []
    for title, axis, legends in panels(history, names):
        lines = [Line(history[name].values, label) for name, label in legends.items()]
        unit = history[next(iter(legends))].unit
        rows = sum(len(textwrap.wrap(line.label, LEGEND)) for line in lines if np.any(line.values))
        height = max(3.0, LEGEND_LINE * rows)  # height of the legend
        found.append(Panel(title, axis, lines, height, unit=unit if wants_prefix(lines, unit) else ""))
    return found


def history_figure(history: History, title: str, columns: Sequence[str] = (), energies: bool = True,
                   x: str = TIME) -> Figure:
    """columns: patterns of names, in addition to the energies or instead of them; x: the column on the horizontal axis.
    Throws ScreeError if there is nothing to plot."""
    shown = energy_panels(history) if energies else []
    shown += column_panels(history, history.names(*columns))
    if not shown or history.rows == 0:
        raise ScreeError("the history has no energies; name other columns" if energies else
                         "nothing to plot: without the energies, name columns")
    heights = [panel.height for panel in shown]
    figure, rows = plt.subplots(len(shown), 1, figsize=(WIDTH, sum(heights) + 0.9), height_ratios=heights, sharex=True,
                                squeeze=False, layout=ConstrainedLayoutEngine(hspace=0.04), dpi=120)
    if title:
        figure.suptitle(title, fontsize=15, x=0.01, ha="left")
    along, label = x_axis(history, x)
    for panel, axes in zip(shown, rows[:, 0]):
        panel.draw(along.values, axes)
    rows[-1, 0].set_xlabel(label, fontsize=12)
    figure.align_ylabels()
    return figure
