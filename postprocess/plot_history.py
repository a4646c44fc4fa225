"""A run's energies and their balance over time, and other columns of its history."""

import itertools
import textwrap
import pathlib

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np

from results import fail, read_history

# Okabe and Ito's palette, told apart by the colour-blind; lines beyond eight repeat it dashed.
COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#8a8a00"]


def style(panel, label):
    panel.set_ylabel(label, fontsize=13)
    panel.tick_params(labelsize=11)
    panel.grid(color="#dddddd", linewidth=0.6)
    panel.margins(x=0.01)


def label_of(name):
    return name.split("/", 1)[-1].replace("_", " ") if name.startswith("energy/") else name


def plot_columns(panel, columns, names):
    """One line per column, all of one unit. Those that are zero throughout get a word instead."""
    time = columns["step/time"][0]
    zero = [name for name in names if not np.any(columns[name][0])]
    if zero:
        words = textwrap.fill("zero throughout: " + ", ".join(label_of(name) for name in zero), 130)
        panel.set_title(words, fontsize=10, loc="left", color="#505050")
    shown = [name for name in names if name not in zero]
    styles = itertools.product(["-", "--", ":", "-."], COLORS)
    for name, (dash, color) in zip(shown, itertools.cycle(styles)):
        label = label_of(name)
        panel.plot(time, columns[name][0], dash, color=color, linewidth=1.6, label=label)
    if shown:
        panel.legend(fontsize=11, loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False)


def plot_balance(panel, columns, name):
    """The balance error, its largest value above."""
    time, balance = columns["step/time"][0], columns[name][0]
    panel.plot(time, balance, color=COLORS[0], linewidth=1.4)
    panel.ticklabel_format(axis="y", style="sci", scilimits=(-2, 3))
    finite = balance[np.isfinite(balance)]
    if len(finite):
        panel.set_title(f"largest balance error {np.abs(finite).max():.2e} J", fontsize=12, loc="left")


def chosen_columns(columns, names):
    """{unit: names} of the columns asked for."""
    panels = {}
    for name in names:
        if name not in columns:
            fail(f"no column {name}; there are: {', '.join(columns)}")
        panels.setdefault(columns[name][1], []).append(name)
    return panels


def list_columns(directory):
    for name, (_, unit, description) in read_history(directory).items():
        print(f"{name} [{unit}]: {description}")


def history_figure(columns, extra):
    """extra: names of columns beside the energies."""
    energies = [name for name in columns if name.startswith("energy/") and "balance" not in name]
    balances = [name for name in columns if name.startswith("energy/") and "balance" in name]
    others = chosen_columns(columns, extra)
    heights = [4.5] * bool(energies) + [2.2] * len(balances) + [3.0] * len(others)
    if not heights:
        fail("the history has no energies; name others with --columns")
    figure, panels = plt.subplots(
        len(heights),
        1,
        figsize=(11, sum(heights) + 0.6),
        height_ratios=heights,
        sharex=True,
        squeeze=False,
        layout="constrained",
        dpi=120,
    )
    panels = iter(panels[:, 0])
    if energies:
        panel = next(panels)
        plot_columns(panel, columns, energies)
        style(panel, "energy [J]")
    for name in balances:
        panel = next(panels)
        plot_balance(panel, columns, name)
        style(panel, "balance [J]")
    for unit, names in others.items():
        panel = next(panels)
        plot_columns(panel, columns, names)
        style(panel, f"[{unit}]")
    figure.axes[-1].set_xlabel("time [s]", fontsize=13)
    return figure


def plot_run(directory, extra):
    """Writes the plot; returns its path."""
    columns = read_history(directory)
    if "step/time" not in columns:
        fail(f"{directory}: the history has no column step/time")
    figure = history_figure(columns, extra)
    path = pathlib.Path(directory) / "history.png"
    figure.savefig(path)
    plt.close(figure)
    return path
