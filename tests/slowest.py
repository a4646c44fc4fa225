"""The slowest tests of a build folder, as a table in Markdown.

    tests/slowest.py [BUILD] [--count N]      default: build/release, 10

Seconds are wall times beside other tests, the mean of ctest's runs in this folder that passed."""

import argparse
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]


def seconds_of_tests(text):
    """{name: seconds} of ctest's CTestCostData.txt: a name, a number of runs and a mean a line, up to dashes."""
    found = {}
    for line in text.split("\n---")[0].splitlines():
        name, runs, mean = line.rsplit(maxsplit=2)
        if int(runs) > 0:
            found[name] = float(mean)
    return found


def table(seconds, count):
    """Lines: the slowest tests, and the sum of all."""
    slowest = sorted(seconds.items(), key=lambda item: -item[1])[:count]
    return ["| test | seconds |", "|---|---|", *(f"| {name} | {value:.0f} |" for name, value in slowest),
            f"| all {len(seconds)} together | {sum(seconds.values()):,.0f} |"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--count", type=int, default=10)
    arguments = parser.parse_args()
    costs = arguments.build / "Testing/Temporary/CTestCostData.txt"
    try:
        text = costs.read_text()
    except OSError as trouble:
        print(f"error: {costs}: {trouble.strerror}; ctest --test-dir {arguments.build} writes it", file=sys.stderr)
        return 2
    print("\n".join(table(seconds_of_tests(text), arguments.count)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
