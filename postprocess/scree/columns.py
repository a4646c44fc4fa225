"""Readable names of history columns for plots."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from scree.errors import ScreeError
from scree.history import TIME, History
from scree.quantity import Quantity

# Kind of quantity by unit.
QUANTITIES = {"N": "force", "N m": "torque", "J": "energy", "W": "power", "m": "length", "rad": "angle", "m/s": "speed",
            "rad/s": "angular speed", "s": "time", "1": "number", "kg m/s": "momentum",
            "kg m^2/s": "angular momentum", "Pa": "pressure", "N/m": "force per length"}
# Component by the prefix of its letter.
PARTS = {
    "torque_": "about {}",
    "marker_torque_": "about {} of the marker",
    "marker_f": "along {} of the marker",
    "turn_": "about {}",
    "w": "about {} of the body",
}


@dataclass(frozen=True)
class ColumnLabel:
    """what: the quantity; owner: name of the joint, body, wall or particle, else empty; component: the axis, empty for
    scalars."""

    what: str
    owner: str
    component: str
    unit: str

    def legend(self, with_what: bool) -> str:
        """with_what: include the quantity, because the title of the panel does not have it."""
        parts = [self.owner, self.what if with_what else "", self.component]
        return ", ".join(part for part in parts if part) or self.what


def column_label(name: str, unit: str, description: str) -> ColumnLabel:
    """Label of the column GROUP/NAME or GROUP/OWNER/NAME."""
    group, *owner, last = name.split("/")
    if group == "particles":
        owner = [f"particle {number}" for number in owner]  # particles have no names
    what = re.split(r"[:;,] |: ", description)[0]
    parts = re.fullmatch(r"(|.*_|f|v|w|marker_f|origin_v)([xyz])", last)
    component = PARTS.get(parts[1], "{}").format(parts[2]) if parts else ""
    quaternion = re.fullmatch(r"e([0-3])", last)
    if quaternion:
        component = "wxyz"[int(quaternion[1])]
    if what in ("its rate", "rate of the coordinate"):  # the first one in results of earlier versions
        what = f"rate of {(' '.join(owner[-1:] + [last.removesuffix('rate').strip('_')])).strip()}"
        owner = []
    return ColumnLabel(what, "/".join(owner), component, unit)


def axis(unit: str) -> str:
    quantity = QUANTITIES.get(unit, "")
    return quantity if unit == "1" else f"{quantity} [{unit}]".strip()


def panels(history: History, names: Sequence[str]) -> list[tuple[str, str, dict[str, str]]]:
    """One panel per group and unit: (title, axis, {column: legend}), in the order of the names."""
    shared: dict[tuple[str, str], dict[str, ColumnLabel]] = {}
    for name in names:
        column = history[name]
        label = column_label(name, column.unit, column.description)
        shared.setdefault((name.split("/")[0], column.unit), {})[name] = label
    found = []
    for (group, unit), of_names in shared.items():
        labels = list(of_names.values())
        first, same = labels[0], len({label.what for label in labels}) == 1
        legends = {name: label.legend(not same) for name, label in of_names.items()}
        title = first.legend(True) if len(of_names) == 1 else first.what if same else group
        begins_with_name = len(of_names) == 1 and first.owner
        found.append((title if begins_with_name else title[:1].upper() + title[1:], axis(unit), legends))
    return found


def x_axis(history: History, name: str) -> tuple[Quantity, str]:
    """The column on the horizontal axis and its label. name: a name, or a pattern that matches exactly one column."""
    matching = history.names(name)
    if len(matching) > 1:
        raise ScreeError(f"{name} matches {len(matching)} columns, and the horizontal axis takes one: "
                         f"{', '.join(matching)}")
    column = history[matching[0]]
    label = "time" if matching[0] == TIME else column_label(matching[0], column.unit, column.description).legend(True)
    return column, label if column.unit == "1" else f"{label} [{column.unit}]"
