"""A deck with other units of length, time and mass: every value is multiplied by the factor of its unit in the schema."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from scree import schema
from scree.errors import ScreeError

OWN_UNIT = "the quantity's unit"  # in functions of time and distributions
DIMENSIONS = {"m": (1, 0, 0), "s": (0, 1, 0), "kg": (0, 0, 1), "N": (1, -2, 1), "Pa": (-1, -2, 1), "J": (2, -2, 1),
              "W": (2, -3, 1), "Hz": (0, -1, 0), "rad": (0, 0, 0), "1": (0, 0, 0)}  # powers of length, time and mass


@dataclass(frozen=True)
class Factors:
    """By which lengths, times and masses are multiplied."""

    length: float
    time: float
    mass: float

    def of(self, unit: str) -> float:
        """Factor of a unit such as "kg m^2" or "N s/m"."""
        above, *below = unit.split("/")
        found = 1.0
        for part, sign in ((above, 1), *((each, -1) for each in below)):
            for word in part.split():
                name, _, power = word.partition("^")
                if name not in DIMENSIONS or (power and not power.isdigit()):
                    raise ScreeError(f"a value in {unit} cannot be scaled")
                length, time, mass = (sign * int(power or 1) * each for each in DIMENSIONS[name])
                found *= self.length**length * self.time**time * self.mass**mass
        return found


def unit_in(description: str, along_a_line: bool) -> str:
    """The unit in brackets at the end of a description, or "1". along_a_line: of the two units of a coordinate of a
    joint, "rad or m", the second."""
    found = re.search(r"\[([^\]]*)\]", description.rsplit("\n\n", 1)[-1].split(";")[0])
    unit = found[1] if found else "1"
    return unit.split(" or ")[-1 if along_a_line else 0] or "1"


def resolved(node: Mapping[str, Any]) -> Mapping[str, Any]:
    """The schema of a table where a key takes a number or a table."""
    for each in (node, *node.get("anyOf", ())):
        if "$ref" in each:
            found: Mapping[str, Any] = schema.load()["$defs"][each["$ref"].rsplit("/", 1)[1]]
            return found
    return node


def scaled(value: Any, node: Mapping[str, Any], factors: Factors, of_line: frozenset[str], own: str = "1") -> Any:
    """A value of a deck with the schema `node`. of_line: names of the joints whose coordinate is a displacement; own:
    the unit of the key that has this function of time or distribution."""
    if isinstance(value, Mapping):
        along = value.get("joint") in of_line
        tables = resolved(node)["properties"]
        return {key: scaled_key(each, tables[key], factors, of_line, (own, along)) if key in tables else each
                for key, each in value.items()}
    if isinstance(value, list):
        return [scaled(each, node["items"], factors, of_line, own) for each in value]
    return value


def scaled_key(value: Any, node: Mapping[str, Any], factors: Factors, of_line: frozenset[str],
               context: tuple[str, bool]) -> Any:
    own, along = context
    unit = unit_in(node.get("description", ""), along).replace(OWN_UNIT, own)
    if isinstance(value, Mapping) or (isinstance(value, list) and value and isinstance(value[0], Mapping)):
        return scaled(value, node, factors, of_line, unit)
    return value if unit == "1" else multiplied(value, factors.of(unit))


def multiplied(value: Any, factor: float) -> Any:
    if isinstance(value, list):
        return [multiplied(each, factor) for each in value]
    return value * factor if isinstance(value, (int, float)) and not isinstance(value, bool) else value


def scaled_deck(tables: Mapping[str, Any], factors: Factors) -> dict[str, Any]:
    """All tables but gravity, materials and contact, which stay as they are."""
    of_line = frozenset(joint["name"] for joint in tables.get("joints", ()) if joint["type"] == "translational")
    kept = {key: tables[key] for key in ("gravity", "materials", "contact") if key in tables}
    changed: dict[str, Any] = scaled({key: each for key, each in tables.items() if key not in kept}, schema.load(),
                                     factors, of_line)
    return changed | kept
