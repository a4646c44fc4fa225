"""Changes and omissions in the import of a robot, with one warning per kind."""

from __future__ import annotations

import os
import warnings

from scree.errors import ScreeWarning

MOST = 10  # items of a kind that are listed


class Notes:
    def __init__(self) -> None:
        self._items: dict[str, list[str]] = {}

    def add(self, kind: str, item: str) -> None:
        """kind: the change, and if possible a remedy. item: the affected element with its line in the file."""
        self._items.setdefault(kind, []).append(item)

    def lines(self) -> list[str]:
        """One line per kind, in the order of occurrence."""
        found = []
        for kind, items in self._items.items():
            count = f" ({len(items)} times)" if len(items) > 1 else ""
            rest = f" and {len(items) - MOST} more" if len(items) > MOST else ""
            found.append(f"{kind}{count}: {', '.join(items[:MOST])}{rest}")
        return found

    def warn(self, path: str | os.PathLike[str]) -> None:
        for line in self.lines():
            warnings.warn(ScreeWarning(f"{os.fspath(path)}: {line}"), stacklevel=3)
