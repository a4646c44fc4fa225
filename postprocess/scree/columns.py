"""What a column of the history is called in a plot: words in place of the file's keys."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from scree.errors import ScreeError
from scree.history import TIME, History
from scree.quantity import Quantity

# What is measured in a unit.
MEASURES = {"N": "force", "N m": "torque", "J": "energy", "W": "power", "m": "length", "rad": "angle", "m/s": "speed",
            "rad/s": "angular speed", "s": "time", "1": "number", "kg m/s": "momentum",
            "kg m^2/s": "angular momentum", "Pa": "pressure", "N/m": "force per length"}
# Before the component's letter: what it is about.
PARTS = {
    "torque_": "about {}",
    "marker_torque_": "about {} of the marker",
    "marker_f": "along {} of the marker",
    "turn_": "about {}",
    "w": "about {} of the body",
}


@dataclass(frozen=True)
class Words:
    """what: the quantity; owner: whose it is, of a joint, body, wall or particle its name, else empty; component: along
    which axis, empty for scalars."""

    what: str
    owner: str
    component: str
    unit: str

    def legend(self, with_what: bool) -> str:
        """with_what: the panel's title does not say it."""
        parts = [self.owner, self.what if with_what else "", self.component]
        return ", ".join(part for part in parts if part) or self.what


def words(name: str, unit: str, description: str) -> Words:
    """Of the column GROUP/NAME or GROUP/OWNER/NAME."""
    group, *owner, last = name.split("/")
    if group == "particles":
        owner = [f"particle {number}" for number in owner]  # which have no names
    what = re.split(r"[:;,] |: ", description)[0]
    parts = re.fullmatch(r"(|.*_|f|v|w|marker_f|origin_v)([xyz])", last)
    component = PARTS.get(parts[1], "{}").format(parts[2]) if parts else ""
    quaternion = re.fullmatch(r"e([0-3])", last)
    if quaternion:
        component = "wxyz"[int(quaternion[1])]
    if what in ("its rate", "rate of the coordinate"):  # the first one in results of earlier versions
        what = f"rate of {(' '.join(owner[-1:] + [last.removesuffix('rate').strip('_')])).strip()}"
        owner = []
    return Words(what, "/".join(owner), component, unit)


def axis(unit: str) -> str:
    measure = MEASURES.get(unit, "")
    return measure if unit == "1" else f"{measure} [{unit}]".strip()


def panels(history: History, names: Sequence[str]) -> list[tuple[str, str, dict[str, str]]]:
    """Columns of one group and unit share a panel: (title, axis, {column: legend}), in the order in which they are
    named."""
    shared: dict[tuple[str, str], dict[str, Words]] = {}
    for name in names:
        column = history[name]
        shared.setdefault((name.split("/")[0], column.unit), {})[name] = words(name, column.unit, column.description)
    found = []
    for (group, unit), of_names in shared.items():
        first, same = next(iter(of_names.values())), len({each.what for each in of_names.values()}) == 1
        legends = {name: each.legend(not same) for name, each in of_names.items()}
        title = first.legend(True) if len(of_names) == 1 else first.what if same else group
        begins_with_name = len(of_names) == 1 and first.owner
        found.append((title if begins_with_name else title[:1].upper() + title[1:], axis(unit), legends))
    return found


def x_axis(history: History, name: str) -> tuple[Quantity, str]:
    """The column along the horizontal axis and its label. name: as it is, or a pattern that one column fits."""
    fitting = history.names(name)
    if len(fitting) > 1:
        raise ScreeError(f"{name} fits {len(fitting)} columns, and the horizontal axis takes one: "
                         f"{', '.join(fitting)}")
    column = history[fitting[0]]
    label = "time" if fitting[0] == TIME else words(fitting[0], column.unit, column.description).legend(True)
    return column, label if column.unit == "1" else f"{label} [{column.unit}]"
