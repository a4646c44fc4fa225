#!/usr/bin/env python3
"""Runs that are signalled at any time, while the model is built too: they end with 5 or 0, say so, and go on.

    tests/trials/signals.py build/release/scree --trials 100 --seed 1

Wants postprocess/requirements.txt. Ends with 1 where a trial went wrong."""

import os
import pathlib
import signal
import sys
import time

from trial import DONE, STOPPED, WAYS, Trials, ranks_of

HANDLED = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGUSR1, signal.SIGUSR2, signal.SIGXCPU)
PASSED_ON = (signal.SIGUSR1, signal.SIGUSR2)  # by mpirun


def hears(pid, number):
    """Whether the process has a handler for the signal."""
    try:
        lines = pathlib.Path(f"/proc/{pid}/status").read_text().splitlines()
    except OSError:
        return False
    caught = next((line.split()[1] for line in lines if line.startswith("SigCgt:")), "0")
    return bool(int(caught, 16) >> (number - 1) & 1)


def listening(run, ranks, number):
    """The program's processes, once each of them would hear the signal; none where the run ends before."""
    while run.poll() is None:
        processes = ranks_of(run) if ranks > 1 else [run.pid]
        if len(processes) == ranks and all(hears(pid, number) for pid in processes):
            return processes
        time.sleep(0.001)
    return []


def send(trials, run, ranks, number, seconds):
    """At once, while the model is built, or at any time of the run."""
    processes = listening(run, ranks, number)
    time.sleep(trials.random.choice((0, 1, 1)) * trials.random.uniform(0, ranks * seconds))
    target = run.pid if ranks > 1 and number in PASSED_ON and trials.random.random() < 0.5 else None
    try:
        if processes and run.poll() is None:
            os.kill(target or trials.random.choice(processes), number)
    except ProcessLookupError:
        pass  # it has ended meanwhile


def trial(trials, number):
    rng = trials.random
    way, ranks, output = rng.choice(WAYS), rng.choice((1, 1, 2)), f"trial {number}"
    word = HANDLED[number % len(HANDLED)]
    seconds = trials.reference(way)[2]
    run = trials.start(way, ranks, output)
    send(trials, run, ranks, word, seconds)
    code, text = trials.finish(run)
    if code not in (DONE, STOPPED):
        return trials.complain(number, f"{word.name} on {ranks} ranks: ended with {code}: {text}")
    if code == STOPPED and not (trials.folder / output).exists():
        trials.count("stopped before the first step")
        if "before the first step, without a new checkpoint" not in text:
            trials.complain(number, f"{word.name}: says {text}")
        return None
    trials.check_files(number, output)
    expected = "done" if code == DONE else f"stopped by signal: {signal.strsignal(word)}"
    if trials.record(output)["status"] != expected or trials.record(output)["exit_code"] != code:
        trials.complain(number, f"{word.name}: the record says {trials.record(output)['status']}")
    if code == DONE:
        trials.count("done before")
        return trials.compare(number, way, output)
    trials.count("stopped and went on")
    return trials.go_on(number, way, output)


def main():
    trials = Trials(__doc__.split("\n")[0])
    for number in range(trials.words.trials):
        trial(trials, number)
    return trials.report()


if __name__ == "__main__":
    sys.exit(main())
