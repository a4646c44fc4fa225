"""Conversion between Python values and tomlkit items of a deck."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import tomlkit
import tomlkit.items

from scree.errors import ScreeError

LONGEST_LINE = 100  # columns of a list of tables on one line


def is_list_of_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(each, Mapping) for each in value)


def plain(value: Any) -> Any:
    """Numpy values, tuples, paths and items of another deck as plain TOML values, without comments. Throws ScreeError
    for other types."""
    if isinstance(value, tomlkit.items.Item):
        return value.unwrap()
    if isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist()) if isinstance(value, np.ndarray) else value.item()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return {str(key): plain(each) for key, each in value.items()}
    if isinstance(value, Sequence):
        return [plain(each) for each in value]
    raise ScreeError(f"{value!r}: a deck has numbers, strings, true and false, lists and tables")


def inline(value: Any) -> tomlkit.items.Item:
    """On one line, except long lists of tables, which have one line per table."""
    if isinstance(value, Mapping):
        table = tomlkit.inline_table()
        for key, each in value.items():
            table.append(key, inline(each))
        return table
    if isinstance(value, list):
        array = tomlkit.array()
        for each in value:
            array.append(inline(each))
        return array.multiline(is_list_of_tables(value) and len(array.as_string()) > LONGEST_LINE)
    found: tomlkit.items.Item = tomlkit.item(value)
    return found


def block(table: Mapping[str, Any]) -> tomlkit.items.Table:
    """The content of [name] or [[name]], with inline values."""
    found = tomlkit.table()
    for key, each in table.items():
        found.append(key, inline(each))
    return found


def blocks(tables: Sequence[Mapping[str, Any]]) -> tomlkit.items.AoT:
    found = tomlkit.aot()
    for table in tables:
        found.append(block(table))
    return found


def of_deck(value: Any, depth: int) -> tomlkit.items.Item:
    """A plain value in the form for this depth of a deck: [name] and [[name]] at the top level, [[name.name]] one level
    below, inline further down."""
    if depth <= 1 and is_list_of_tables(value):
        return blocks(value)
    if depth == 0 and isinstance(value, Mapping):
        table = tomlkit.table()
        for key, each in sorted(value.items(), key=lambda item: is_list_of_tables(item[1])):
            table.append(key, of_deck(each, 1))
        return table
    return inline(value)


def unwrapped(item: Any) -> Any:
    """Numbers, strings and booleans as Python values; lists and tables remain those of the deck."""
    if isinstance(item, tomlkit.items.Item) and not isinstance(item, (list, dict)):
        return item.unwrap()
    return item
