"""What is done otherwise than a robot's file says: one warning of each kind, however often it comes."""

from __future__ import annotations

import os
import warnings

from scree.errors import ScreeWarning

MOST = 10  # of one kind that are named


class Notes:
    def __init__(self) -> None:
        self._items: dict[str, list[str]] = {}

    def add(self, kind: str, item: str) -> None:
        """kind: what was done, and where that can be, what to do about it. item: to what, with its line in the file."""
        self._items.setdefault(kind, []).append(item)

    def lines(self) -> list[str]:
        """One of each kind, in the order in which they came."""
        found = []
        for kind, items in self._items.items():
            count = f" ({len(items)} times)" if len(items) > 1 else ""
            rest = f" and {len(items) - MOST} more" if len(items) > MOST else ""
            found.append(f"{kind}{count}: {', '.join(items[:MOST])}{rest}")
        return found

    def warn(self, path: str | os.PathLike[str]) -> None:
        for line in self.lines():
            warnings.warn(ScreeWarning(f"{os.fspath(path)}: {line}"), stacklevel=3)
