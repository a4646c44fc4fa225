"""Parameter studies: the list of runs for a SLURM array (jobs/array.sbatch), and one table of what they gave."""

from __future__ import annotations

import itertools
import os
import pathlib
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from scree.errors import ScreeError
from scree.run import Run, open_run

if TYPE_CHECKING:
    import pandas

Path = str | os.PathLike[str]


def word(value: Any) -> str:
    """As `--set` takes it, without blanks, at which a line of the list is cut into words."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return f"[{','.join(word(each) for each in value)}]"
    text = value if isinstance(value, str) else repr(value.item() if hasattr(value, "item") else value)
    if not text or text.split() != [text]:
        raise ScreeError(f"{value!r}: must be a word without blanks")
    return text


def write_list(path: Path, deck: Path, keys: Mapping[str, Sequence[Any]]) -> int:
    """Writes a line "DECK --set KEY=VALUE ..." for each combination of the keys' values, the last key's changing
    fastest; returns their number. keys: as --set names them, "contact.pairs.0.friction", with the values to try."""
    combinations = list(itertools.product(*keys.values()))
    lines = [" ".join([word(str(deck)), *(f"--set {key}={word(value)}" for key, value in zip(keys, values))])
             for values in combinations]
    pathlib.Path(path).write_text("".join(f"{line}\n" for line in lines))
    return len(lines)


def settings(line: str) -> dict[str, str]:
    """What a line of the list sets."""
    words = line.split()
    return dict(following.split("=", 1) for option, following in zip(words, words[1:]) if option == "--set")


def number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def measured(measure: Callable[[Run], Any], run: Run) -> Any:
    """None where the run has not got so far that there is anything to measure."""
    try:
        return measure(run)
    except (ScreeError, KeyError, IndexError):
        return None


def table(path: Path, results: Path, measures: Mapping[str, Callable[[Run], Any]]) -> pandas.DataFrame:
    """A row for each line of the list that names a deck, by its number from 1: what it sets, the run's status, and what
    each measure says of it; a run that has no results yet has the status "not begun" and no measures, and one that has
    not got far enough for a measure has none of it.

        scree.sweep.table("LIST", "results/study", {"force": lambda run: run.history["contacts/floor/fy"][-1]})
    """
    import pandas

    rows = {}
    for element, line in enumerate(pathlib.Path(path).read_text().splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        row: dict[str, Any] = {key: number(value) for key, value in settings(line).items()}
        folder = pathlib.Path(results) / str(element)
        try:
            run = open_run(folder)
        except ScreeError:
            row["status"] = "not begun"
        else:
            row["status"] = run.status
            row |= {name: measured(measure, run) for name, measure in measures.items()}
        rows[element] = row
    return pandas.DataFrame.from_dict(rows, orient="index").rename_axis("element")
