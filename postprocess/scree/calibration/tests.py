"""The four tests: their decks, the stresses at which they run, and what is measured in a run."""

from __future__ import annotations

import copy
import pathlib
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from scree import program
from scree.calibration import materials, surface
from scree.calibration.scaling import Factors, scaled_deck
from scree.deck import Deck
from scree.errors import ScreeError
from scree.run import Run
from scree.snapshots import Snapshot

DECKS = pathlib.Path(__file__).resolve().parents[3] / "input/calibration"  # in the repository
LEDGE = (0.1, 0.85)  # part of the ledge over which the slope is fitted: not at the wall, not at the edge
EARLIER = 0.8  # part of the run after which the slope must not change
CHORD = 0.5  # part of the drum's radius on either side of the axis over which the surface is fitted
PEAK_OVER = 0.2  # displacement over which the shear stress is averaged for its peak, in diameters
RESIDUAL = 0.4  # last part of the displacement: the residual state
FAILED_BY = 0.2  # compression of the column by which it must have failed
HELD = 5  # rows of the history over which the stress on the platen is averaged

Values = dict[str, float]


@dataclass(frozen=True)
class Test:
    """deck: its name. stress: the normal stress of a deck, for tests that run at several stresses. measure: values of
    one run. combine: quantities from the values of one seed at all stresses. units: of the quantities."""

    deck: str
    measure: Callable[[Run], Values]
    combine: Callable[[Sequence[Values]], Values]
    units: Mapping[str, str]
    stresses: tuple[float, ...] = ()  # by default, over density of a grain x g x diameter
    stress: Callable[[Mapping[str, Any]], float] | None = None


def named(tables: Mapping[str, Any], path: str, name: str) -> Any:
    """The element of a list of tables with this name."""
    for table in tables.get(path, ()):
        if table.get("name") == name:
            return table
    raise ScreeError(f"deck: {path}: none is named {name}")


def state(snapshot: Snapshot) -> tuple[np.ndarray, np.ndarray]:
    """Positions and radii of the grains [m]."""
    return np.array(snapshot.particles["position"]), np.array(snapshot.particles["radius"])


def ledge_surface(run: Run, time: float = float("inf")) -> surface.Surface:
    """Of the snapshot nearest to this time [s], by default the last one."""
    low = run.deck["space"]["min"][0]
    length = named(run.deck, "walls", "gate")["point"][0] - low
    snapshot = run.snapshots[-1] if time == float("inf") else run.snapshots.at(time)
    found = surface.find([state(snapshot)], *(low + part * length for part in LEDGE))
    if found is None:
        raise ScreeError(f"{run.folder}: no slope is left on the ledge")
    return found


def drum_surface(run: Run) -> surface.Surface:
    radius = named(run.deck, "meshes", "drum")["radius"]
    late = range(len(run.snapshots) // 2, len(run.snapshots))
    found = surface.find([state(run.snapshots[k]) for k in late], -CHORD * radius, CHORD * radius)
    if found is None:
        raise ScreeError(f"{run.folder}: the grains in the drum have no free surface")
    return found


def measure_ledge(run: Run) -> Values:
    """change: of the angle since the snapshot at EARLIER."""
    now, earlier = ledge_surface(run), ledge_surface(run, EARLIER * run.snapshots[-1].time)
    return {"angle": now.angle, "change": now.angle - earlier.angle}


def single(values: Sequence[Values]) -> Values:
    return values[0]


def shear_area(tables: Mapping[str, Any]) -> float:
    low, high = tables["space"]["min"], tables["space"]["max"]
    return float((high[0] - low[0]) * (high[1] - low[1]))


def shear_stress(tables: Mapping[str, Any]) -> float:
    return float(-named(tables, "applied_forces", "press")["fz"] / shear_area(tables))


def averaged(values: np.ndarray, rows: int) -> np.ndarray:
    """Moving averages over this number of rows."""
    rows = max(1, min(rows, len(values)))
    return np.convolve(values, np.ones(rows) / rows, mode="valid")


def shear_curve(run: Run) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Displacement of the lower plate [m], shear and normal stress on the upper one [Pa], from the start of the
    shear."""
    area = shear_area(run.deck)
    moved = np.array(run.history["coordinates/rail/displacement"])
    sheared = np.flatnonzero(moved > 0)
    if len(sheared) < 10:
        raise ScreeError(f"{run.folder}: the plate has not moved yet")
    return (moved[sheared], np.abs(np.array(run.history["contacts/upper/fx"])[sheared]) / area,
            np.array(run.history["contacts/upper/fz"])[sheared] / area)


def measure_shear(run: Run) -> Values:
    moved, shear, normal = shear_curve(run)
    size = 2 * float(np.mean(run.snapshots[-1].particles["radius"]))
    rows = round(PEAK_OVER * size / (moved[-1] - moved[0]) * (len(moved) - 1))
    late = moved > (1 - RESIDUAL) * moved[-1]
    return {"normal": float(normal[late].mean()), "peak": float(averaged(shear, rows).max()),
            "residual": float(shear[late].mean())}


def combine_shear(values: Sequence[Values]) -> Values:
    """Straight lines shear = cohesion + tan(angle) normal; through the origin if there is one stress only."""
    normal, found = np.array([each["normal"] for each in values]), {}
    for name in ("peak", "residual"):
        shear = np.array([each[name] for each in values])
        slope, cohesion = np.polyfit(normal, shear, 1) if len(values) > 1 else (shear[0] / normal[0], 0.0)
        found[f"{name}_angle"] = float(np.degrees(np.arctan(slope)))
        found[f"{name}_cohesion"] = float(cohesion)
    return found


def column_area(tables: Mapping[str, Any]) -> float:
    left, right, front, back = (named(tables, "walls", name)["point"] for name in ("left", "right", "front", "back"))
    return float((right[0] - left[0]) * (back[1] - front[1]))


def consolidation_stress(tables: Mapping[str, Any]) -> float:
    return float(-named(tables, "applied_forces", "press")["fz"]["values"][0] / column_area(tables))


def column_curve(run: Run) -> tuple[float, np.ndarray, np.ndarray]:
    """Consolidation stress [Pa]; compression, and stress on the platen [Pa], of the free column."""
    times = named(run.deck, "applied_forces", "press")["fz"]["times"]
    time, stress = run.history.time, np.abs(np.array(run.history["contacts/platen/fz"])) / column_area(run.deck)
    height = named(run.deck, "bodies", "platen")["position"][2] \
        + np.array(run.history["coordinates/guide/displacement"])
    consolidated, free = (time > 0.8 * times[1]) & (time <= times[1]), time >= times[3]
    if free.sum() < HELD:
        raise ScreeError(f"{run.folder}: the column is not free yet")
    compression = 1 - height[free] / height[free][0]
    return float(stress[consolidated].mean()), compression, stress[free]


def measure_column(run: Run) -> Values:
    consolidation, compression, stress = column_curve(run)
    within = compression <= FAILED_BY
    carried = averaged(stress[within], HELD)
    return {"consolidation": consolidation, "strength": float(carried.max()),
            "failed": float(compression.max() > FAILED_BY)}


def combine_column(values: Sequence[Values]) -> Values:
    """The strength at the largest stress, and the mean ratio of strength to stress."""
    last = max(values, key=lambda each: each["consolidation"])
    return {"strength": last["strength"],
            "strength_ratio": float(np.mean([each["strength"] / each["consolidation"] for each in values]))}


TESTS = {
    "repose": Test("angle_of_repose", measure_ledge, single, {"angle": "degrees"}),
    "drum": Test("rotating_drum", lambda run: {"angle": drum_surface(run).angle}, single, {"angle": "degrees"}),
    "shear": Test("direct_shear", measure_shear, combine_shear,
                  {"residual_angle": "degrees", "residual_cohesion": "Pa", "peak_angle": "degrees",
                   "peak_cohesion": "Pa"}, (50.0, 100.0, 200.0), shear_stress),
    "uniaxial": Test("uniaxial", measure_column, combine_column, {"strength": "Pa", "strength_ratio": "1"},
                     (25.0, 50.0, 100.0), consolidation_stress),
}


def template(test: Test, path: pathlib.Path | None, scree: pathlib.Path) -> Deck:
    """The given deck, else that of the repository, else the copy in the program (scree new)."""
    if path is not None or (DECKS / f"{test.deck}.toml").exists():
        return Deck.read(path or DECKS / f"{test.deck}.toml")
    with tempfile.TemporaryDirectory(prefix="scree_calibrate_") as folder:
        file = pathlib.Path(folder) / f"{test.deck}.toml"
        program.call([scree, "new", test.deck, file], {})
        return Deck.read(file)


def gravity(tables: Mapping[str, Any]) -> float:
    return float(np.linalg.norm(tables.get("gravity", 0.0))) or 9.81


def stresses_of(test: Test, grains: materials.Grains) -> list[float]:
    """The stresses [Pa] at which a test runs by default."""
    return [each * grains.density * 9.81 * 2 * grains.size for each in test.stresses]


def deck_for(test: Test, deck: Deck, grains: materials.Grains, seed: int, stress: float | None = None) -> Deck:
    """The deck of a test with these grains: lengths in proportion to their size, masses to their mass, and times to
    the square root of the size, or so that the stresses become those of the run."""
    tables = copy.deepcopy(deck.to_dict())
    of_deck = materials.mean_radius(tables["particles"][0]["radius"], deck.name)
    length = grains.size / of_deck
    density = grains.density / named(tables, "materials", materials.GRAIN)["density"]
    time = length**0.5
    if stress is not None and test.stress is not None:
        time = length * (density * test.stress(tables) / stress) ** 0.5
    tables = scaled_deck(tables, Factors(length, time, density * length**3))
    materials.put(tables, grains)
    for group in tables["particles"]:
        group["seed"] = seed
    tables.get("output", {}).pop("directory", None)
    return Deck(**tables)
