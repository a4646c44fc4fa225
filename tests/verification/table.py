#!/usr/bin/env python3
"""Makes the tables of measured values, from tests/verification/measured.csv after
tests/verification/tables.toml.

    SCREE_MEASURED=FOLDER build/release/tests/test_verification_impact      # writes its measured values to FOLDER
    python3 tests/support/measured.py --merge tests/verification/measured.csv FOLDER
    tests/verification/table.py [--check]
    tests/verification/table.py --demands FOLDER

--check writes nothing, and fails where a page is not what the data give, a row of the data is in no table, or no test
writes it. --demands fails where tests, whose rows are in FOLDER, demand something else than the data say, or write
other keys."""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
import measured  # noqa: E402
import page_tables  # noqa: E402

DATA, LAYOUT = "tests/verification/measured.csv", "tests/verification/tables.toml"
SOURCES = ["tests/verification", "tests/unit", "tests/trials"]


def other_demands(rows, folder):
    """Differences of bounds and texts between the files of a folder and the rows of the data, a line each."""
    known = {measured.identity(row): row for row in rows}
    programs = sorted({row["command"] for row in rows if row["command"].startswith("test_verification_")
                       and " " not in row["command"]})
    problems = [f"{name} has left no rows" for name in programs if not (folder / f"{name}.csv").exists()]
    for path in sorted(folder.glob("*.csv")):
        found = measured.read(path)
        for row in found:
            kept = known.get(measured.identity(row), known.get((row["key"], "cpu")))
            if kept is None:
                problems.append(f"{row['key']}: {row['command']} writes it, and {DATA} has no such row")
                continue
            for name in ("unit", "at_least", "at_most"):
                if row[name] != kept[name]:
                    problems.append(f"{row['key']}: {name} is {row[name] or 'not there'} in {row['command']}, "
                                    f"{kept[name] or 'not there'} in {DATA}")
        # Tests that run by name only, as [table], are not part of a program's default run.
        here = {row["key"] for row in found}
        problems += [f"{row['key']}: {row['command']} no longer writes it" for row in rows
                     if (row["command"], row["backend"]) == (found[0]["command"], found[0]["backend"])
                     and row["key"] not in here]
    return problems


def main():
    if sys.argv[1:2] != ["--demands"]:
        return page_tables.run(__doc__, ROOT, LAYOUT, DATA, SOURCES, digits=2)
    problems = other_demands(measured.read(ROOT / DATA), pathlib.Path(sys.argv[2]))
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
