#!/usr/bin/env python3
"""Plots a run's energies and their balance over time.

    python3 postprocess/plot_history.py RESULT_DIR [--columns GROUP/NAME ...]

Writes RESULT_DIR/history.png. --columns adds a panel per unit with other columns of the history; --list names
them all.
"""

import argparse
import itertools
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


def plot_columns(panel, columns, names):
    """One line per column, all of one unit."""
    time = columns["step/time"][0]
    styles = itertools.product(["-", "--", ":", "-."], COLORS)
    for name, (dash, color) in zip(names, styles):
        label = name.split("/", 1)[-1].replace("_", " ") if name.startswith("energy/") else name
        panel.plot(time, columns[name][0], dash, color=color, linewidth=1.6, label=label)
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


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("result_directory", type=pathlib.Path)
    parser.add_argument("--columns", nargs="+", default=[], metavar="GROUP/NAME")
    parser.add_argument(
        "--list", action="store_true", help="print the columns with unit and description, plot nothing"
    )
    arguments = parser.parse_args()
    columns = read_history(arguments.result_directory)
    if arguments.list:
        for name, (_, unit, description) in columns.items():
            print(f"{name} [{unit}]: {description}")
        return
    if "step/time" not in columns:
        fail(f"{arguments.result_directory}: the history has no column step/time")
    energies = [name for name in columns if name.startswith("energy/") and "balance" not in name]
    balances = [name for name in columns if name.startswith("energy/") and "balance" in name]
    others = chosen_columns(columns, arguments.columns)
    heights = [4.5] * bool(energies) + [2.2] * len(balances) + [3.0] * len(others)
    if not heights:
        fail(f"{arguments.result_directory}: the history has no energies; name others with --columns")
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
    path = arguments.result_directory / "history.png"
    figure.savefig(path)
    print(path)


if __name__ == "__main__":
    main()
