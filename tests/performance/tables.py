#!/usr/bin/env python3
"""Makes the tables of performance, from tests/performance/measured.csv after tests/performance/tables.toml.

    export SCREE_MEASURED=FOLDER        # the programs and scripts of this folder leave their numbers there
    build/release/tests/performance/bed --particles 10000
    python3 tests/support/measured.py --merge tests/performance/measured.csv FOLDER
    tests/performance/tables.py [--check]

--check writes nothing, and fails where a page is not what the data give, a row of the data is in no table, or no
program writes it."""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
import page_tables  # noqa: E402

if __name__ == "__main__":
    sys.exit(page_tables.run(__doc__, ROOT, "tests/performance/tables.toml", "tests/performance/measured.csv",
                             ["tests/performance"]))
