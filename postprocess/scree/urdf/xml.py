"""The file of a robot as elements with line numbers. Document types, and therefore entities, are refused."""

from __future__ import annotations

import pathlib
import xml.parsers.expat
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NoReturn

import numpy as np

from scree.errors import ScreeError


@dataclass
class Element:
    name: str
    attributes: dict[str, str]
    location: str  # FILE:LINE
    children: list[Element] = field(default_factory=list)

    @property
    def line(self) -> str:
        return self.location.rsplit(":", 1)[1]

    @property
    def called(self) -> str:
        return f"{self.name} {self.attributes.get('name', '')} (line {self.line})"

    def fail(self, text: str) -> NoReturn:
        owner = f' "{self.attributes["name"]}"' if "name" in self.attributes else ""
        raise ScreeError(f"{self.location}: {self.name}{owner}: {text}")

    def all(self, name: str) -> Iterator[Element]:
        return (child for child in self.children if child.name == name)

    def first(self, name: str) -> Element | None:
        return next(self.all(name), None)

    def required(self, name: str) -> Element:
        found = self.first(name)
        if found is None:
            self.fail(f"has no <{name}>")
        return found

    def text(self, attribute: str) -> str:
        if not self.has(attribute):
            self.fail(f'has no attribute "{attribute}"')
        return self.attributes[attribute].strip()

    def has(self, attribute: str) -> bool:
        return bool(self.attributes.get(attribute, "").strip())

    def numbers(self, attribute: str, count: int, default: list[float] | None = None,
                infinite: bool = False) -> np.ndarray:
        """Numbers separated by blanks, finite unless `infinite`. default None: the attribute is required."""
        if not self.has(attribute) and default is not None:
            return np.array(default, dtype=float)
        text = self.text(attribute)
        try:
            values = np.array([float(word) for word in text.split()])
        except ValueError:
            values = np.array([])
        if len(values) != count or not (~np.isnan(values) if infinite else np.isfinite(values)).all():
            self.fail(f'{attribute} = "{text}": must be {"a number" if count == 1 else f"{count} numbers"}')
        return values

    def number(self, attribute: str, default: float | None = None, infinite: bool = False) -> float:
        return float(self.numbers(attribute, 1, None if default is None else [default], infinite)[0])


def read(path: pathlib.Path) -> Element:
    """The root element. Throws ScreeError if the file is not XML, has a document type, or has macros of xacro."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise ScreeError(f"{path}: cannot be read: {error.strerror}") from error
    top = Element("", {}, str(path))
    within = [top]
    parser = xml.parsers.expat.ParserCreate()

    def begin(name: str, attributes: dict[str, str]) -> None:
        element = Element(name, attributes, f"{path}:{parser.CurrentLineNumber}")
        if name.startswith("xacro:") or any("${" in value or "$(" in value for value in attributes.values()):
            raise ScreeError(f"{element.location}: has macros of xacro; expand them first: "
                             f"xacro {path.name} > robot.urdf")
        within[-1].children.append(element)
        within.append(element)

    def refuse(*_: object) -> None:
        raise ScreeError(f"{path}:{parser.CurrentLineNumber}: has a document type, which is not read")

    parser.StartElementHandler = begin
    parser.EndElementHandler = lambda _: within.pop()
    parser.StartDoctypeDeclHandler = refuse
    try:
        parser.Parse(data, True)
    except xml.parsers.expat.ExpatError as error:
        raise ScreeError(f"{path}:{error.lineno}: no XML: {xml.parsers.expat.ErrorString(error.code)}") from error
    return top.children[0]
