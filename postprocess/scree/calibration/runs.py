"""Carries out the runs of a test: for each seed, at each stress."""

from __future__ import annotations

import pathlib
import threading
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from scree.calibration import materials
from scree.calibration.tests import TESTS, Values, deck_for, stresses_of, template
from scree.deck import Deck
from scree.errors import ScreeError
from scree.record import read_record
from scree.run import Run, open_run


@dataclass(frozen=True)
class Plan:
    """What all runs of a command have in common. slots: of the runs that may go on at a time; settings: keys of the
    decks, as for --set; errors: of runs that failed or were interrupted, after which none begins."""

    scree: pathlib.Path
    slots: threading.Semaphore
    seeds: int = 3
    backend: str = "auto"
    stresses: tuple[float, ...] = ()
    settings: tuple[tuple[str, Any], ...] = ()
    deck: pathlib.Path | None = None
    errors: list[Exception] = field(default_factory=list)


@dataclass(frozen=True)
class Measured:
    """Of one test with one material: per seed the values of the runs, at each stress, and the quantities."""

    runs: list[list[Run]]
    values: list[list[Values]]
    quantities: list[Values]

    def mean(self, name: str) -> float:
        return float(np.mean([each[name] for each in self.quantities]))

    def spread(self, name: str) -> float:
        """Standard deviation over the seeds; 0 for a single one."""
        found = [each[name] for each in self.quantities]
        return float(np.std(found, ddof=1)) if len(found) > 1 else 0.0


def run_deck(deck: Deck, folder: pathlib.Path, plan: Plan) -> Run:
    """The results in the folder if they are those of this deck, else a run of it."""
    written, record = folder / "deck.toml", read_record(folder)
    done = record is not None and record["run"]["status"] == "done" and written.exists()
    if done and written.read_text(encoding="utf-8") == str(deck):
        return open_run(folder)
    deck.name = str(written)
    with plan.slots:
        if plan.errors:
            raise plan.errors[0]
        try:
            return deck.run(folder, "--overwrite", backend=plan.backend, quiet=True, scree=plan.scree)
        except (ScreeError, OSError) as error:
            plan.errors.append(error)
            raise


def decks_of(name: str, grains: materials.Grains, plan: Plan) -> list[list[Deck]]:
    """Per seed, at each stress."""
    test = TESTS[name]
    if plan.stresses and test.stress is None:
        raise ScreeError(f"{name}: has no stresses")
    stresses: Sequence[float | None] = plan.stresses or stresses_of(test, grains) or [None]
    base, found = template(test, plan.deck, plan.scree), []
    for seed in range(1, plan.seeds + 1):
        found.append([deck_for(test, base, grains, seed, stress) for stress in stresses])
        for deck in found[-1]:
            for key, value in plan.settings:
                deck[key] = value
    return found


def measure(name: str, grains: materials.Grains, plan: Plan, folder: pathlib.Path) -> Measured:
    """Runs a test into FOLDER/seed_N, with several stresses FOLDER/seed_N/stress_M."""
    test, decks = TESTS[name], decks_of(name, grains, plan)
    several = len(decks[0]) > 1
    places = [(seed, k) for seed in range(len(decks)) for k in range(len(decks[0]))]

    def run(place: tuple[int, int]) -> Run:
        seed, k = place
        own = folder / f"seed_{seed + 1}"
        return run_deck(decks[seed][k], own / f"stress_{k + 1}" if several else own, plan)

    with ThreadPoolExecutor(len(places)) as pool:
        done = dict(zip(places, pool.map(run, places)))
    runs = [[done[seed, k] for k in range(len(decks[0]))] for seed in range(len(decks))]
    values = [[test.measure(each) for each in of_seed] for of_seed in runs]
    return Measured(runs, values, [test.combine(of_seed) for of_seed in values])
