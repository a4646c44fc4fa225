"""Rows of values measured by tests and benchmarks, as measured.hpp writes them and as the repository keeps them.

    measured.py KEY VALUE UNIT [--least X] [--most X] [--at-most X] [--machine NAME] [--backend NAME]
                [--record RUN_RECORD] --command WORDS

Adds a row to the folder that the environment variable SCREE_MEASURED names, for scripts in other languages; without the
variable it goes nowhere.

    measured.py --merge DATA.csv FOLDER [--also-new]

Takes the rows of all files in FOLDER over into DATA.csv: each in place of the one with its key and backend, and with
--also-new those that DATA.csv does not have, too.
"""
import argparse
import csv
import datetime
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

# key: words with slashes between them. value: the main one (the largest error, the least of what must be large, the
# median of times), empty where both ends do. least, most: of all values. at_least, at_most: bounds.
COLUMNS = ["key", "value", "unit", "least", "most", "at_least", "at_most", "commit", "machine", "backend", "date",
           "command"]
MUST = ("key", "commit", "machine", "backend", "command")
NUMBERS = ("value", "least", "most", "at_least", "at_most")
ROOT = pathlib.Path(__file__).resolve().parents[2]
ALWAYS = {}


def read(path):
    """The rows of a file, as dictionaries of text. Ends the program with a message where its format is another one."""
    try:
        with open(path, newline="") as file:
            reader = csv.DictReader(file)
            rows = list(reader)
    except OSError as error:
        raise SystemExit(f"error: {path}: {error.strerror}")
    if reader.fieldnames != COLUMNS:
        raise SystemExit(f"error: {path}: its columns must be {','.join(COLUMNS)}")
    for number, row in enumerate(rows, start=2):
        if None in row or None in row.values():
            raise SystemExit(f"error: {path}:{number}: must have {len(COLUMNS)} cells")
        for name in NUMBERS:
            if row[name] and not re.fullmatch(r"-?[\d.]+(e[+-]?\d+)?", row[name]):
                raise SystemExit(f"error: {path}:{number}: {name} is {row[name]}; must be a number, or empty")
        for name in MUST:
            if not row[name]:
                raise SystemExit(f"error: {path}:{number}: has no {name}")
    return rows


def write(path, rows):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def identity(row):
    return row["key"], row["backend"]


def keeps(row):
    """Whether the values are within their bounds."""
    return ((not row["at_most"] or float(row["most"]) <= float(row["at_most"]))
            and (not row["at_least"] or float(row["least"]) >= float(row["at_least"])))


def merge(path, folder, also_new):
    """Rows of the folder's files in place of those with their key and backend, and others, too, if also_new. How many
    were taken, and how many left. Rows that break what was demanded, or of sources that no commit has, are refused."""
    kept = {identity(row): row for row in read(path)} if path.exists() else {}
    taken = left = 0
    for file in sorted(folder.glob("*.csv")):
        for row in read(file):
            if not keeps(row):
                raise SystemExit(f"error: {file}: {row['key']} is not what was demanded")
            if row["commit"].endswith("-modified"):
                raise SystemExit(f"error: {file}: {row['key']} is of commit {row['commit']}; must be one as it is")
            if also_new or identity(row) in kept:
                kept[identity(row)] = row
                taken += 1
            else:
                left += 1
    write(path, [kept[key] for key in sorted(kept)])
    return taken, left


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown"


def commit_of(program):
    """The commit at which scree was built."""
    text = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
    found = re.search(r"commit ([^)\s]*)", text)
    return found[1] if found else "unknown"


def gpu():
    """Name of the first GPU; that of the processor where there is none."""
    if shutil.which("nvidia-smi") is None:
        return processor()
    done = subprocess.run(["nvidia-smi", "--query-gpu=name", "--format=csv,noheader"], capture_output=True, text=True)
    return done.stdout.splitlines()[0].strip()


def commit():
    """The commit of the source tree, as src/base/version.cmake has it; where that is not in git, SCREE_COMMIT."""
    done = subprocess.run(["git", "-C", ROOT, "describe", "--always", "--dirty=-modified", "--abbrev=12",
                           "--exclude=*"], capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else os.environ.get("SCREE_COMMIT", "unknown")


def of_record(record):
    """Commit, machine and backend of a run, from its run_record.json as a dictionary."""
    words = record["run"]["backend"]
    gpu = re.match(r"cuda \((.*?)[,)]", words)
    return {"commit": record["build"]["commit"], "machine": gpu[1] if gpu else record["host"]["processor"],
            "backend": words.split()[0]}


def command_line():
    """The command line of this script, without folders of this machine."""
    return " ".join(pathlib.PurePath(word).name if "/" in word else word for word in sys.argv)


def always(**others):
    """Values of COLUMNS for all rows from here on."""
    ALWAYS.update(others)


def note(key, value, unit="", *, record=None, **others):
    """Adds a row to the folder SCREE_MEASURED. record: of the run, as a dictionary; others: of COLUMNS."""
    folder = os.environ.get("SCREE_MEASURED")
    if not folder:
        return
    row = dict.fromkeys(COLUMNS, "") | (
        of_record(record) if record else {"commit": commit(), "machine": processor(), "backend": "cpu"})
    row |= {"key": key, "value": value, "unit": unit, "least": value, "most": value, "command": command_line(),
            "date": datetime.datetime.now(datetime.timezone.utc).date().isoformat()} | ALWAYS | others
    for name in NUMBERS:
        if isinstance(row[name], float):
            row[name] = f"{row[name]:.4g}"
    path = pathlib.Path(folder) / (re.sub(r"[^\w-]", "_", row["command"]) + ".csv")
    path.parent.mkdir(parents=True, exist_ok=True)
    others = [one for one in read(path) if identity(one) != identity(row)] if path.exists() else []
    write(path, [*others, row])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", nargs="*", metavar="KEY VALUE UNIT")
    parser.add_argument("--least", default=argparse.SUPPRESS)
    parser.add_argument("--most", default=argparse.SUPPRESS)
    parser.add_argument("--at-most", default=argparse.SUPPRESS)
    parser.add_argument("--machine", default=argparse.SUPPRESS)
    parser.add_argument("--backend", default=argparse.SUPPRESS)
    parser.add_argument("--record", type=pathlib.Path, metavar="RUN_RECORD", help="commit, machine and backend are its")
    parser.add_argument("--command", help="that measured it")
    parser.add_argument("--merge", nargs=2, type=pathlib.Path, metavar=("DATA.csv", "FOLDER"))
    parser.add_argument("--also-new", action="store_true")
    others = vars(parser.parse_args())
    words, merging, record, also_new = (others.pop(name) for name in ("words", "merge", "record", "also_new"))
    if merging:
        print("{} rows taken over, {} left that are new".format(*merge(*merging, also_new)))
        return
    if len(words) != 3 or not others["command"]:
        parser.error("KEY VALUE UNIT and --command are needed, or --merge")
    note(*words, record=json.loads(record.read_text()) if record else None, **others)


if __name__ == "__main__":
    sys.exit(main())
