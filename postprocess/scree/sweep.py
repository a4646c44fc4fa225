"""Parameter studies: the list of runs for a SLURM array (jobs/array.sbatch) or for this machine, and the table of their
results."""

from __future__ import annotations

import itertools
import os
import pathlib
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TYPE_CHECKING, Any

from scree import program
from scree.deck import Deck
from scree.errors import ScreeError
from scree.record import CHECKPOINTS, read_record
from scree.run import Run, open_run

if TYPE_CHECKING:
    import pandas

Path = str | os.PathLike[str]
OWN_OPTIONS = ("--output", "--restart", "--backend")  # options set by the runner, each with a value
TO_CONTINUE = CHECKPOINTS[:2]  # checkpoints from which a run continues
LOG, ERROR = "log.txt", "error: "  # log of a run on this machine; start of an error line in it


def listed(path: Path) -> str:
    """A path as written in a list: the bytes of its name, independent of the locale."""
    return os.fsencode(path).decode("utf-8", "surrogateescape")


def given(text: str) -> bytes:
    """Text of a list as bytes for the program, which expects UTF-8 in every locale."""
    return text.encode("utf-8", "surrogateescape")


def path_of(line: str) -> pathlib.Path:
    """Path of the deck of a line."""
    return pathlib.Path(os.fsdecode(given(line.split()[0])))


def write_lines(path: Path, lines: Sequence[str]) -> int:
    """Returns the number of lines."""
    pathlib.Path(path).write_bytes(given("".join(f"{line}\n" for line in lines)))
    return len(lines)


def word(value: Any) -> str:
    """A value as for `--set`, without blanks, which separate the arguments of a line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return f"[{','.join(word(each) for each in value)}]"
    text = value if isinstance(value, str) else repr(value.item() if hasattr(value, "item") else value)
    if not text or text.split() != [text]:
        raise ScreeError(f"{value!r}: must be a word without blanks")
    return text


def write_list(path: Path, deck: Path | Deck, keys: Mapping[str, Sequence[Any]]) -> int:
    """Writes one line "DECK --set KEY=VALUE ..." per combination of values, the last key varying fastest, and returns
    the number of lines. keys: as for --set, "contact.pairs.0.friction", with their values. A deck made in Python is
    written beside the list, under the name of the list with .toml."""
    if isinstance(deck, Deck):
        file: Path = pathlib.Path(path).with_suffix(".toml")
        deck.write(file)
    else:
        file = deck
    combinations = list(itertools.product(*keys.values()))
    lines = [" ".join([word(listed(file)), *(f"--set {key}={word(value)}" for key, value in zip(keys, values))])
             for values in combinations]
    return write_lines(path, lines)


def write_decks(path: Path, decks: Mapping[str, Deck]) -> int:
    """Writes each deck as NAME.toml into a folder beside the list, named as the list without its suffix, and one line
    per deck; returns the number of lines. For studies that differ by more than keys."""
    folder = pathlib.Path(path).with_suffix("")
    folder.mkdir(parents=True, exist_ok=True)
    lines = [word(listed(folder / f"{name}.toml")) for name in decks]
    for line, deck in zip(lines, decks.values()):
        deck.write(path_of(line))
    return write_lines(path, lines)


def elements(path: Path) -> Iterator[tuple[int, str]]:
    """The lines of the list that name a deck, with their numbers, counted from 1."""
    text = pathlib.Path(path).read_text(encoding="utf-8", errors="surrogateescape")
    for number_of_line, line in enumerate(text.splitlines(), 1):
        if line.strip() and not line.lstrip().startswith("#"):
            yield number_of_line, line.strip()


def is_done(line: str, folder: pathlib.Path) -> bool:
    """Whether the folder has the results of this line for the current deck."""
    record = read_record(folder)
    if record is None or record["run"]["status"] != "done":
        return False
    arguments = str(record["run"]["command_line"]).split()[2:]
    own = {k for k, each in enumerate(arguments) for k in (k, k + 1) if each in OWN_OPTIONS}
    compared = [each for k, each in enumerate(arguments) if k not in own and each != "--overwrite"]
    return compared == line.split() and (folder / "run_record.json").stat().st_mtime > path_of(line).stat().st_mtime


def run_line(line: str, folder: pathlib.Path, backend: str, where: pathlib.Path) -> str:
    """Returns "done", or "done before". Throws ScreeError with the message of the program, which the log has, too."""
    if is_done(line, folder):
        return "done before"
    checkpoints = sorted((folder / name for name in TO_CONTINUE if (folder / name).exists()),
                         key=lambda file: file.stat().st_mtime)
    begun = ["--restart", checkpoints[-1]] if checkpoints else ["--overwrite"]
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / LOG, "a", encoding="utf-8") as log:
        try:
            arguments = map(given, line.split())
            program.call([where, "run", *arguments, "--output", folder, "--backend", backend, *begun], {}, log)
        except ScreeError as error:
            log.write(f"{ERROR}{error}\n")
            raise
    return "done"


def run_local(path: Path, results: Path, at_once: int = 1, backend: str = "auto", scree: Path | None = None,
              quiet: bool = False) -> dict[int, str]:
    """Runs the lines of the list on this machine, `at_once` at a time, each on one rank, into RESULTS/N with the log
    RESULTS/N/log.txt. As in an array, finished runs are skipped, and runs with a checkpoint continue. Returns the
    messages of failed runs by element; a failure does not stop the others. quiet: print no line on standard error when
    a run ends."""
    where, lines = program.required(scree), dict(elements(path))
    ended = itertools.count(1)

    def run(element: int, line: str) -> None:
        start = time.monotonic()
        word = "failed"
        try:
            word = run_line(line, pathlib.Path(results) / str(element), backend, where)
        finally:
            if not quiet:
                print(f"{next(ended)} of {len(lines)}: run {element} {word}, {time.monotonic() - start:.1f} s",
                      file=sys.stderr, flush=True)

    failed: dict[int, str] = {}
    with ThreadPoolExecutor(at_once) as pool:
        begun: dict[int, Future[None]] = {element: pool.submit(run, element, line) for element, line in lines.items()}
        try:
            for element, future in begun.items():
                try:
                    future.result()
                except (ScreeError, OSError) as error:
                    failed[element] = str(error)
        except KeyboardInterrupt:
            pool.shutdown(cancel_futures=True)
            raise
    return failed


def settings(line: str) -> dict[str, str]:
    """The settings of a line of the list."""
    arguments = line.split()
    return dict(following.split("=", 1) for option, following in zip(arguments, arguments[1:]) if option == "--set")


def number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def measured(name: str, measure: Callable[[Run], Any], run: Run) -> Any:
    """Value of a function of the run; None if an unfinished run does not have the data yet."""
    try:
        return measure(run)
    except (ScreeError, KeyError, IndexError) as error:
        if run.status == "done":
            raise ScreeError(f'{run.folder}: measure "{name}": {error}') from error
        return None


def status_without_results(folder: pathlib.Path) -> str:
    """Status from the log of run_local, if there is one."""
    try:
        lines = (folder / LOG).read_text(encoding="utf-8").splitlines()
    except FileNotFoundError:
        return "not begun"
    errors = [line.removeprefix(ERROR) for line in lines if line.startswith(ERROR)]
    return f"failed: {errors[-1]}" if errors else "not begun"


def table(path: Path, results: Path, measures: Mapping[str, Callable[[Run], Any]]) -> pandas.DataFrame:
    """One row per line of the list that names a deck, by its number from 1: the deck, if they differ, the settings of
    the line, the status of the run, and the value of each measure, a function of the run. A run without results has no
    values and the status "not begun", or "failed" with the message of a refused run_local. An unfinished run has no
    value for which it lacks data. Throws ScreeError if a measure fails on a finished run.

        scree.sweep.table("LIST", "results/study", {"force": lambda run: run.history["contacts/floor/fy"][-1]})
    """
    import pandas

    lines = dict(elements(path))
    several = len({line.split()[0] for line in lines.values()}) > 1
    rows = {}
    for element, line in lines.items():
        row: dict[str, Any] = {"deck": path_of(line).stem} if several else {}
        row |= {key: number(value) for key, value in settings(line).items()}
        folder = pathlib.Path(results) / str(element)
        try:
            run = open_run(folder)
        except ScreeError:
            row["status"] = status_without_results(folder)
        else:
            row["status"] = run.status
            row |= {name: measured(name, measure, run) for name, measure in measures.items()}
        rows[element] = row
    return pandas.DataFrame.from_dict(rows, orient="index").rename_axis("element")
