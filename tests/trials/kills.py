#!/usr/bin/env python3
"""Runs that are killed at any time: what they leave is complete, and goes on to the bits of the uninterrupted run.

    tests/trials/kills.py build/release/scree --trials 100 --seed 1

Wants postprocess/requirements.txt. Ends with 1 where a trial went wrong."""

import os
import signal
import sys
import time

from trial import DONE, WAYS, Trials, ranks_of


def trial(trials, number):
    rng = trials.random
    way, ranks, output = rng.choice(WAYS), rng.choice((1, 1, 2)), f"trial {number}"
    delay = rng.uniform(0, 1.2) * trials.reference(way)[2] * ranks
    run = trials.start(way, ranks, output)
    time.sleep(delay)
    victims = ranks_of(run) if ranks > 1 else [run.pid]
    if run.poll() is None and victims:
        os.kill(rng.choice(victims), signal.SIGKILL)
    code, text = trials.finish(run)
    if code is None:
        return trials.complain(number, text)
    folder = trials.folder / output
    trials.check_files(number, output)
    if code == DONE:
        trials.count("done before")
        return trials.compare(number, way, output)
    if not (folder / "checkpoint.h5").exists():
        return trials.count("killed before the first checkpoint")
    trials.count("went on")
    trials.go_on(number, way, output)


def main():
    trials = Trials(__doc__.split("\n")[0])
    for number in range(trials.words.trials):
        trial(trials, number)
    return trials.report()


if __name__ == "__main__":
    sys.exit(main())
