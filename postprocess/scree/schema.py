"""The JSON schema of decks (`scree keys --schema`), and what a deck breaks of it in the program's own words."""

from __future__ import annotations

import difflib
import functools
import importlib.resources
import json
from collections.abc import Iterable, Mapping
from typing import Any

import jsonschema
from jsonschema.exceptions import ValidationError

LONGEST_VALUE = 60  # in a message


@functools.cache
def load() -> dict[str, Any]:
    """That of the program of this package's version, draft 2020-12."""
    file = importlib.resources.files("scree") / "deck.schema.json"
    found: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    return found


def shown(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= LONGEST_VALUE else f"{text[:LONGEST_VALUE]} ..."


def path_of(deck: Any, steps: Iterable[str | int], *further: str) -> str:
    """As --set has it: elements of lists of tables by their names, where they have some."""
    parts = []
    for step in steps:
        deck = deck[step]
        name = deck.get("name") if isinstance(step, int) and isinstance(deck, Mapping) else None
        parts.append(name if isinstance(name, str) and name else str(step))
    return ".".join([*parts, *further])


def schemas_on_the_way(schema: Mapping[str, Any], steps: Iterable[str | int]) -> list[Any]:
    """From the whole schema to the one that an error is of."""
    found: list[Any] = [schema]
    for step in steps:
        here = found[-1]
        if isinstance(here, Mapping) and "$ref" in here:  # an error's path does not name it
            here = schema["$defs"][here["$ref"].rsplit("/", 1)[1]]
            found.append(here)
        found.append(here[step])
    return found


def allowed(way: Iterable[Any]) -> str:
    """What the innermost key with a description takes: "a number above 0 [kg]"."""
    for schema in reversed(list(way)):
        text = schema.get("description", "") if isinstance(schema, Mapping) else ""
        if "\n\n" in text:
            takes = str(text).rsplit("\n\n", 1)[1].split(";")[0].rstrip(".")
            return above_zero(takes) if any("exclusiveMinimum" in each for each in schema.get("anyOf", [])) else takes
        if isinstance(schema, Mapping) and schema.get("type") in ("array", "object") and text:
            return "a table" if schema["type"] == "object" else "a list of tables"
    return ""


def above_zero(takes: str) -> str:
    """Of a number or a table, where a number has a lower limit of its own."""
    return takes.replace("a number [", "a number above 0 [").replace("] or a table", "], or a table")


def condition(way: Iterable[Any]) -> str:
    """Of a rule that holds for one word of a selector: ' with kind = "planar"'."""
    for schema in reversed(list(way)):
        if isinstance(schema, Mapping) and "if" in schema:
            (selector, word), = ((key, value["const"]) for key, value in schema["if"]["properties"].items())
            return f' with {selector} = "{word}"'
    return ""


def innermost(error: ValidationError) -> list[ValidationError]:
    """Where a number or a table may stand, what is wrong with the one that was meant."""
    fitting = [each for each in error.context or [] if each.validator != "type" or len(each.relative_path)]
    return [inner for each in fitting for inner in innermost(each)] or [error]


def unknown_keys(error: ValidationError, path: str) -> list[str]:
    known = list(error.schema["properties"])
    found = []
    for key in (key for key in error.instance if key not in known):
        near = difflib.get_close_matches(key, known, 1)
        hint = f'; did you mean "{near[0]}"?' if near else f"; known: {', '.join(known)}"
        where = f"{path}.{key}" if path else key
        found.append(f"{where} = {shown(error.instance[key])}: unknown key{hint}")
    return found


def missing_keys(error: ValidationError, path: str, way: list[Any]) -> list[str]:
    found = []
    for key in (key for key in error.validator_value if key not in error.instance):
        declared: Any = next((each["properties"][key] for each in reversed(way)
                              if isinstance(each, Mapping) and each.get("properties", {}).get(key)), {})
        where = f"{path}.{key}" if path else key
        found.append(f"{where}: missing;{condition(way)} it must be {allowed([declared])}")
    return found


def keys_of_others(deck: Any, error: ValidationError, path: str, way: list[Any]) -> list[str]:
    """Keys that tables of this kind have not. The error says in which table they are, but not which ones."""
    table = functools.reduce(lambda holder, step: holder[step], error.absolute_path, deck)
    return [f"{path}.{key} = {shown(table[key])}: not used{condition(way)}"
            for key, schema in way[-1].items() if schema is False and key in table]


def lines_of(error: ValidationError, deck: Any, schema: Mapping[str, Any]) -> list[str]:
    way = schemas_on_the_way(schema, error.absolute_schema_path)
    path = path_of(deck, error.absolute_path)
    if error.validator == "additionalProperties":
        return unknown_keys(error, path)
    if error.validator == "required":
        return missing_keys(error, path, way)
    if error.schema is False:
        return keys_of_others(deck, error, path, way)
    return [f"{path} = {shown(error.instance)}: must be {allowed(way) or error.message}"]


def problems(deck: dict[str, Any], schema: Mapping[str, Any] | None = None) -> list[str]:
    """A line for each: "bodies.lid.mass = -1: must be a number above 0 [kg]". schema: that of the package."""
    chosen = load() if schema is None else schema
    errors = sorted(jsonschema.Draft202012Validator(chosen).iter_errors(deck), key=lambda e: [str(p) for p in e.path])
    inner = [each for error in errors for each in innermost(error)]
    return list(dict.fromkeys(line for error in inner for line in lines_of(error, deck, chosen)))
