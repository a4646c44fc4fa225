"""The JSON schema of decks (`scree keys --schema`), and its violations in the wording of the program."""

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
    """Schema of the program version of this package, draft 2020-12."""
    file = importlib.resources.files("scree") / "deck.schema.json"
    found: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    return found


def shown(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= LONGEST_VALUE else f"{text[:LONGEST_VALUE]} ..."


def path_of(deck: Any, steps: Iterable[str | int], *further: str) -> str:
    """Path as for --set, with elements of lists of tables by name if they have one."""
    parts = []
    for step in steps:
        deck = deck[step]
        name = deck.get("name") if isinstance(step, int) and isinstance(deck, Mapping) else None
        parts.append(name if isinstance(name, str) and name else str(step))
    return ".".join([*parts, *further])


def schemas_along(schema: Mapping[str, Any], steps: Iterable[str | int]) -> list[Any]:
    """The schemas from the root to the one that an error violates."""
    found: list[Any] = [schema]
    for step in steps:
        here = found[-1]
        if isinstance(here, Mapping) and "$ref" in here:  # the path of an error omits it
            here = schema["$defs"][here["$ref"].rsplit("/", 1)[1]]
            found.append(here)
        found.append(here[step])
    return found


def allowed(along: Iterable[Any]) -> str:
    """Allowed values of the innermost key with a description: "a number above 0 [kg]"."""
    for schema in reversed(list(along)):
        text = schema.get("description", "") if isinstance(schema, Mapping) else ""
        if "\n\n" in text:
            takes = str(text).rsplit("\n\n", 1)[1].split(";")[0].rstrip(".")
            return above_zero(takes) if any("exclusiveMinimum" in each for each in schema.get("anyOf", [])) else takes
        if isinstance(schema, Mapping) and schema.get("type") in ("array", "object") and text:
            return "a table" if schema["type"] == "object" else "a list of tables"
    return ""


def above_zero(takes: str) -> str:
    """Wording for a number or a table if the number has a lower limit."""
    return takes.replace("a number [", "a number above 0 [").replace("] or a table", "], or a table")


def condition(along: Iterable[Any]) -> str:
    """Condition of a rule for one value of a selector: ' with kind = "planar"'."""
    for schema in reversed(list(along)):
        if isinstance(schema, Mapping) and "if" in schema:
            (selector, word), = ((key, value["const"]) for key, value in schema["if"]["properties"].items())
            return f' with {selector} = "{word}"'
    return ""


def innermost(error: ValidationError) -> list[ValidationError]:
    """Errors of the intended alternative, where a key takes a number or a table."""
    intended = [each for each in error.context or [] if each.validator != "type" or len(each.relative_path)]
    return [inner for each in intended for inner in innermost(each)] or [error]


def unknown_keys(error: ValidationError, path: str) -> list[str]:
    known = [key for key, schema in error.schema["properties"].items() if not schema.get("deprecated")]
    found = []
    for key in (key for key in error.instance if key not in error.schema["properties"]):
        near = difflib.get_close_matches(key, known, 1)
        hint = f'; did you mean "{near[0]}"?' if near else f"; known: {', '.join(known)}"
        where = f"{path}.{key}" if path else key
        found.append(f"{where} = {shown(error.instance[key])}: unknown key{hint}")
    return found


def missing_keys(error: ValidationError, path: str, along: list[Any]) -> list[str]:
    found = []
    for key in (key for key in error.validator_value if key not in error.instance):
        declared: Any = next((each["properties"][key] for each in reversed(along)
                              if isinstance(each, Mapping) and each.get("properties", {}).get(key)), {})
        where = f"{path}.{key}" if path else key
        found.append(f"{where}: missing;{condition(along)} it must be {allowed([declared])}")
    return found


def keys_of_others(deck: Any, error: ValidationError, path: str, along: list[Any]) -> list[str]:
    """Keys that tables of this kind do not have. The error names the table, but not the keys."""
    table = functools.reduce(lambda holder, step: holder[step], error.absolute_path, deck)
    return [f"{path}.{key} = {shown(table[key])}: not used{condition(along)}"
            for key, schema in along[-1].items() if schema is False and key in table]


def lines_of(error: ValidationError, deck: Any, schema: Mapping[str, Any]) -> list[str]:
    along = schemas_along(schema, error.absolute_schema_path)
    path = path_of(deck, error.absolute_path)
    if error.validator == "additionalProperties":
        return unknown_keys(error, path)
    if error.validator == "required":
        return missing_keys(error, path, along)
    if error.schema is False:
        return keys_of_others(deck, error, path, along)
    return [f"{path} = {shown(error.instance)}: must be {allowed(along) or error.message}"]


def problems(deck: dict[str, Any], schema: Mapping[str, Any] | None = None) -> list[str]:
    """One line per violation: "bodies.lid.mass = -1: must be a number above 0 [kg]". schema: default that of the
    package."""
    chosen = load() if schema is None else schema
    errors = sorted(jsonschema.Draft202012Validator(chosen).iter_errors(deck), key=lambda e: [str(p) for p in e.path])
    inner = [each for error in errors for each in innermost(error)]
    return list(dict.fromkeys(line for error in inner for line in lines_of(error, deck, chosen)))
