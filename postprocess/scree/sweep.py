"""Parameter studies: the list of runs for a SLURM array (jobs/array.sbatch) or for this machine, and one table of what
they gave."""

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
OWN_OPTIONS = ("--output", "--restart", "--backend")  # of the runner, each with a word
OF_LATER = CHECKPOINTS[:2]  # checkpoints that a run goes on from
LOG, ERROR = "log.txt", "error: "  # of a run on this machine; how its line of an error begins


def listed(path: Path) -> str:
    """A path as a list has it: by the bytes of its name, whatever the locale makes of them."""
    return os.fsencode(path).decode("utf-8", "surrogateescape")


def given(text: str) -> bytes:
    """Words of a list, for the program, which takes UTF-8 in every locale."""
    return text.encode("utf-8", "surrogateescape")


def path_of(line: str) -> pathlib.Path:
    """Of the deck of a line."""
    return pathlib.Path(os.fsdecode(given(line.split()[0])))


def write_lines(path: Path, lines: Sequence[str]) -> int:
    """Returns their number."""
    pathlib.Path(path).write_bytes(given("".join(f"{line}\n" for line in lines)))
    return len(lines)


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


def write_list(path: Path, deck: Path | Deck, keys: Mapping[str, Sequence[Any]]) -> int:
    """Writes a line "DECK --set KEY=VALUE ..." for each combination of the keys' values, the last key's changing
    fastest; returns their number. keys: as --set names them, "contact.pairs.0.friction", with the values to try. A deck
    made in Python is written beside the list, under its name with .toml."""
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
    """Writes each deck as NAME.toml into a folder beside the list, which has the list's name without its suffix, and a
    line for each; returns their number. For studies that no keys can say."""
    folder = pathlib.Path(path).with_suffix("")
    folder.mkdir(parents=True, exist_ok=True)
    lines = [word(listed(folder / f"{name}.toml")) for name in decks]
    for line, deck in zip(lines, decks.values()):
        deck.write(path_of(line))
    return write_lines(path, lines)


def elements(path: Path) -> Iterator[tuple[int, str]]:
    """Numbers, from 1, and lines of the list that name a deck."""
    text = pathlib.Path(path).read_text(encoding="utf-8", errors="surrogateescape")
    for number_of_line, line in enumerate(text.splitlines(), 1):
        if line.strip() and not line.lstrip().startswith("#"):
            yield number_of_line, line.strip()


def is_done(line: str, folder: pathlib.Path) -> bool:
    """Whether the folder has the results of this line, of the deck as it is."""
    record = read_record(folder)
    if record is None or record["run"]["status"] != "done":
        return False
    words = str(record["run"]["command_line"]).split()[2:]
    own = {k for k, each in enumerate(words) for k in (k, k + 1) if each in OWN_OPTIONS}
    kept = [each for k, each in enumerate(words) if k not in own and each != "--overwrite"]
    return kept == line.split() and (folder / "run_record.json").stat().st_mtime > path_of(line).stat().st_mtime


def run_line(line: str, folder: pathlib.Path, backend: str, where: pathlib.Path) -> str:
    """Returns what became of it: "done", or that it was. Throws ScreeError with the program's message, which the log
    has, too."""
    if is_done(line, folder):
        return "done before"
    checkpoints = sorted((folder / name for name in OF_LATER if (folder / name).exists()),
                         key=lambda file: file.stat().st_mtime)
    begun = ["--restart", checkpoints[-1]] if checkpoints else ["--overwrite"]
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / LOG, "a", encoding="utf-8") as log:
        try:
            words = map(given, line.split())
            program.call([where, "run", *words, "--output", folder, "--backend", backend, *begun], {}, log)
        except ScreeError as error:
            log.write(f"{ERROR}{error}\n")
            raise
    return "done"


def run_local(path: Path, results: Path, at_once: int = 1, backend: str = "auto", scree: Path | None = None,
              quiet: bool = False) -> dict[int, str]:
    """Runs the lines of the list on this machine, so many at a time, each on one rank, to RESULTS/N, with its log in
    RESULTS/N/log.txt. As in an array what is done is left as it is, and what has a checkpoint goes on from it. Returns
    the messages of the runs that failed, by element; the others go on. quiet: without a line for each as it ends, on
    the standard error."""
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
    """What a line of the list sets."""
    words = line.split()
    return dict(following.split("=", 1) for option, following in zip(words, words[1:]) if option == "--set")


def number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def measured(name: str, measure: Callable[[Run], Any], run: Run) -> Any:
    """None where the run has not got so far that there is anything to measure."""
    try:
        return measure(run)
    except (ScreeError, KeyError, IndexError) as error:
        if run.status == "done":
            raise ScreeError(f'{run.folder}: measure "{name}": {error}') from error
        return None


def status_without_results(folder: pathlib.Path) -> str:
    """By the log of run_local, where there is one."""
    try:
        lines = (folder / LOG).read_text(encoding="utf-8").splitlines()
    except FileNotFoundError:
        return "not begun"
    errors = [line.removeprefix(ERROR) for line in lines if line.startswith(ERROR)]
    return f"failed: {errors[-1]}" if errors else "not begun"


def table(path: Path, results: Path, measures: Mapping[str, Callable[[Run], Any]]) -> pandas.DataFrame:
    """A row for each line of the list that names a deck, by its number from 1: the deck, where it is not the same in
    all, what the line sets, the run's status, and what each measure says of it. A run without results has the status
    "not begun", or "failed" with the message where run_local was refused, and no measures; one that is not done and has
    not got far enough for a measure has none of it. Throws ScreeError where a measure fails on a run that is done.

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
