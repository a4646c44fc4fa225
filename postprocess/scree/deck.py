"""Decks as dictionaries: reading, making, changing, writing, checking and running them."""

from __future__ import annotations

import itertools
import os
import pathlib
import re
import tempfile
from collections.abc import Iterator, Mapping, MutableMapping
from subprocess import PIPE
from typing import Any

import tomlkit
import tomlkit.exceptions
import tomlkit.items

from scree import program, schema
from scree.errors import MissingError, ScreeError
from scree.run import Run, open_run
from scree.toml_items import block, inline, is_list_of_tables, of_deck, plain, unwrapped

Path = str | os.PathLike[str]
FILES = ("meshes", "particles")  # lists whose elements may have a `file` relative to the folder of the deck


def element_index(elements: Any, part: str, path: str) -> int:
    """Index of the element of a list of tables with this name or, if none has it, with this number."""
    names = [table.get("name") for table in elements if isinstance(table, Mapping)]
    if part in names:
        return names.index(part)
    if part.isdigit() and int(part) < len(elements):
        return int(part)
    counted = "there is 1 element" if len(elements) == 1 else f"there are {len(elements)} elements"
    raise MissingError(f"{path}: {counted}, counted from 0" if part.isdigit() else
                       f"{path}: no element is named {part}; there are {', '.join(filter(None, names)) or 'none'}")


def key_of(message: str, deck: str) -> str:
    """The key in a message, which may begin with the deck and a position: "fast.toml:3:8: time.end = -1: must be". For
    an element of a list of numbers it is the key of the list, as in the messages of the program."""
    found = re.match(rf"(?:{re.escape(deck)}(?::\d+:\d+)?: )?([^\s:]+?)(?:\.\d+)?(?: = |: )", message)
    return found[1] if found else ""


class Deck(MutableMapping[str, Any]):
    """Keys are the paths of `--set`: deck["contact.pairs.0.friction"], deck["walls.belt.surface_velocity"]. Numbers,
    strings and booleans are returned as Python values; lists and tables are those of the deck, so that changes in them
    change the deck. Comments are preserved; tables of one list are written together. Iteration yields the names of the
    top-level tables.

        deck = scree.Deck(gravity=[0, 0, -9.81], space={"dimension": 3, "min": [0, 0, 0], "max": [1, 1, 1]})
        deck["time.end"] = 0.5
        deck.add("particles", name="block", kind="random", ...)
    """

    def __init__(self, **tables: Any) -> None:
        """Files of the deck are relative to `folder`: the folder of the deck's file, else the current one."""
        self._document = tomlkit.document()
        self.name = "deck"  # in messages
        self.folder = pathlib.Path.cwd()
        self._file: pathlib.Path | None = None  # last read or written
        for key, value in tables.items():
            self[key] = value

    @classmethod
    def read(cls, path: Path) -> Deck:
        """Throws ScreeError if the file cannot be read or is not TOML."""
        try:
            text = pathlib.Path(path).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise ScreeError(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}") from error
        deck = cls.parse(text, os.fspath(path), pathlib.Path(path).resolve().parent)
        deck._file = pathlib.Path(path).resolve()
        return deck

    @classmethod
    def parse(cls, text: str, name: str = "deck", folder: Path = ".") -> Deck:
        """A deck from TOML text. name: in messages; folder: to which its files are relative."""
        deck = cls()
        deck.name, deck.folder = name, pathlib.Path(folder).resolve()
        try:
            deck._document = tomlkit.parse(text)
        except tomlkit.exceptions.TOMLKitError as error:
            raise ScreeError(f"{name}: no TOML: {error}") from error
        return deck

    def _parent(self, path: str, make: bool) -> tuple[Any, str | int]:
        """The table or list of tables that contains the element of this path, and the key of the element. make: create
        missing tables of the path."""
        parts = path.split(".")
        holder: Any = self._document
        for k, part in enumerate(parts):
            if is_list_of_tables(holder) or (isinstance(holder, tomlkit.items.AoT) and not holder):
                key: str | int = element_index(holder, part, path)
            elif isinstance(holder, Mapping):
                key = part
            else:
                raise MissingError(f"{path}: {'.'.join(parts[:k])} has no keys of its own")
            if k + 1 == len(parts):
                return holder, key
            if isinstance(key, str) and key not in holder:
                if not make:
                    raise MissingError(f"{path}: {'.'.join(parts[: k + 1])} does not exist")
                holder[key] = tomlkit.table() if k == 0 else tomlkit.inline_table()
            holder = holder[key]
        raise AssertionError("a path has a part at least")

    def __getitem__(self, path: str) -> Any:
        holder, key = self._parent(path, make=False)
        if isinstance(key, str) and key not in holder:
            raise MissingError(f"{path}: does not exist; there are {', '.join(holder) or 'no keys'}")
        return unwrapped(holder[key])

    def __setitem__(self, path: str, value: Any) -> None:
        holder, key = self._parent(path, make=True)
        value = plain(value)
        if isinstance(key, int) and not isinstance(value, dict):
            raise ScreeError(f"{path}: must be a table")
        if isinstance(holder, tomlkit.items.AoT) and isinstance(key, int):
            del holder[key]
            holder.insert(key, block(value))
        else:
            within = isinstance(holder, (tomlkit.items.InlineTable, tomlkit.items.Array))
            holder[key] = inline(value) if within else of_deck(value, path.count("."))

    def __delitem__(self, path: str) -> None:
        self[path]  # throws if it does not exist
        holder, key = self._parent(path, make=False)
        del holder[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._document)

    def __len__(self) -> int:
        """Number of top-level tables and keys."""
        return len(self._document)

    def add(self, path: str, **table: Any) -> Any:
        """Appends a table to a list of tables, which is created if necessary, and returns it:
        deck.add("bodies", name="lid", mass=2.0), deck.add("bodies.lid.shapes", radius=0.1)."""
        if path not in self:
            self[path] = [table]
        else:
            elements = self[path]
            if not isinstance(elements, list) or (elements and not is_list_of_tables(elements)):
                raise ScreeError(f"{path}: is no list of tables")
            new = block(plain(table)) if isinstance(elements, tomlkit.items.AoT) else inline(plain(table))
            elements.append(new)
        return self[path][-1]

    def to_dict(self) -> dict[str, Any]:
        """A copy as plain dictionaries and lists."""
        found: dict[str, Any] = self._document.unwrap()
        return found

    def copy(self) -> Deck:
        return Deck.parse(str(self), self.name, self.folder)

    def __str__(self) -> str:
        """The deck as TOML."""
        return tomlkit.dumps(self._document)

    def __repr__(self) -> str:
        return f"<{self.name}: {', '.join(self) or 'an empty deck'}>"

    def write(self, path: Path) -> None:
        """Relative paths of files are adapted to the new folder. Later messages about the deck name this file."""
        pathlib.Path(path).write_text(self._text_in(pathlib.Path(path).resolve().parent), encoding="utf-8")
        self.name, self._file = os.fspath(path), pathlib.Path(path).resolve()

    def _text_in(self, folder: pathlib.Path) -> str:
        """The text of the deck for a file in this folder."""
        written = self.copy()
        lists = [written[key] for key in FILES if key in written and is_list_of_tables(written[key])]
        for table in itertools.chain(*lists):
            if folder != self.folder and not os.path.isabs(table.get("file", "/")):
                table["file"] = os.path.relpath(self.folder / table["file"], folder)
        return str(written)

    def _unchanged_file(self) -> pathlib.Path | None:
        """The last file read or written, if it has the current content of the deck."""
        try:
            same = self._file is not None and self._file.read_text(encoding="utf-8") == self._text_in(self._file.parent)
        except (OSError, UnicodeDecodeError):
            return None
        return self._file if same else None

    def problems(self) -> list[str]:
        """Violations of the JSON schema by keys and values, one line each. Only the program checks combinations."""
        return schema.problems(self.to_dict())

    def check(self, scree: Path | None = None) -> str:
        """Returns the output of `scree check`, or an empty string if the program is not found. scree: the program, by
        default $SCREE, scree on the PATH or that of this repository. Throws ScreeError with the message of the program,
        which is about the first error that it finds, and all `problems` of other keys."""
        where = program.find(scree)
        try:
            output, refusal = "" if where is None else self._checked_by(where), ""
        except program.RefusedError as error:
            output, refusal = "", str(error)
        refused_key = key_of(refusal, self.name)
        lines = [refusal] if refusal else []
        lines += [f"{self.name}: {problem}" for problem in self.problems()
                  if not refusal or key_of(problem, self.name) != refused_key]
        if lines:
            raise ScreeError("\n".join(lines))
        return output

    def _checked_by(self, where: pathlib.Path) -> str:
        """Output of `scree check` for the deck's file, or for a temporary file if the deck has changed."""
        file = self._unchanged_file()
        if file is not None:
            return program.call([where, "check", file], {str(file): self.name})
        with tempfile.TemporaryDirectory(prefix="scree_deck_") as folder:
            path = pathlib.Path(folder).resolve() / "deck.toml"
            path.write_text(self._text_in(path.parent), encoding="utf-8")
            return program.call([where, "check", path], {str(path): self.name})

    def run(self, directory: Path, *options: str, ranks: int = 1, backend: str = "auto", quiet: bool = False,
            launcher: str = "mpirun", scree: Path | None = None) -> Run:
        """Runs the deck and returns the results. The deck is written into the directory of the results as deck.toml.

        options: further arguments of `scree run`, such as "--overwrite". quiet: do not show the progress. launcher:
        starts several ranks. Throws ScreeError with the message of the program if the run fails.
        """
        where = program.required(scree)
        folder = pathlib.Path(directory)
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / "deck.toml"
        earlier = path.read_bytes() if path.exists() else None
        path.write_text(self._text_in(path.resolve().parent), encoding="utf-8")
        several = [*launcher.split(), "-n", str(ranks)] if ranks > 1 else []
        command: list[Path] = [*several, where, "run", path, "--output", folder, "--backend", backend, *options]
        try:
            program.call(command, {str(path): self.name}, PIPE if quiet else None)
        except program.RefusedError:  # leave the folder unchanged
            path.unlink() if earlier is None else path.write_bytes(earlier)
            raise
        return open_run(folder)
