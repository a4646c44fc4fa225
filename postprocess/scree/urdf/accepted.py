"""Makes the program accept the deck."""

from __future__ import annotations

from collections.abc import MutableMapping
from typing import Any

from scree import program
from scree.deck import Deck
from scree.errors import ScreeError
from scree.urdf.meshes import LEFT_OUT, SHEET
from scree.urdf.notes import Notes


def refused_mesh(deck: Deck, message: str) -> int | None:
    """Number of the mesh whose triangles cause a message of the program; None for other messages."""
    named = [k for k, mesh in enumerate(deck.get("meshes", [])) if any(f"meshes.{mesh['name']}.{key} = " in message
                                                                       for key in ("file", "kind"))]
    return max(named, key=lambda k: len(deck[f"meshes.{k}.name"])) if named else None


def leave_out(deck: Deck, name: str) -> None:
    """Removes the mesh and all references to it."""
    uses = [("meshes", "name"), ("walls", "mesh"),
            *((f"bodies.{k}.meshes", "mesh") for k in range(len(deck.get("bodies", []))))]
    for path, key in uses:
        tables = deck.get(path, [])
        rest = [dict(table) for table in tables if table[key] != name]
        if rest and len(rest) < len(tables):
            deck[path] = rest
        elif len(rest) < len(tables):
            del deck[path]


def make_accepted(deck: Deck, notes: Notes) -> None:
    """Meshes that `scree check` refuses become open surfaces or are left out. Throws ScreeError if the deck is refused
    for another reason."""
    if program.find() is None:
        notes.add("not checked, because the program scree is not found", "run scree check on the deck")
        return
    while True:
        try:
            deck.check()
            return
        except ScreeError as error:
            message = str(error).splitlines()[0]
        number = refused_mesh(deck, message)
        if number is None:
            raise ScreeError(f"{deck.name}: the deck is refused by scree check: {message}")
        mesh: MutableMapping[str, Any] = deck["meshes"][number]
        what = mesh.get("file", mesh["name"])
        reason = message.rpartition(f"meshes.{mesh['name']}.")[2].partition(": ")[2].partition("; ")[0]
        if mesh["kind"] == "file" and not mesh.get("sheet", False):
            mesh["sheet"] = True
            notes.add(SHEET, f"{what}, by scree check: {reason}")
        else:
            notes.add(f"refused by scree check, {LEFT_OUT}", f"{what}: {reason}")
            leave_out(deck, mesh["name"])
