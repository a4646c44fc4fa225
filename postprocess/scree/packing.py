"""Particles for decks, made outside the program: graded by a sieve curve, in layers, or from the state of another run.

    grains = scree.packing.graded([1e-3, 2e-3, 4e-3], [0.0, 0.4, 1.0], low=[0, 0, 0], high=[0.05] * 3, fraction=0.3)
    deck.add("particles", name="grains", density=2650.0, **grains.write("grains.csv"))
"""

from __future__ import annotations

import itertools
import os
import pathlib
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import h5py
import numpy as np

from scree import files
from scree.errors import ScreeError, ScreeWarning
from scree.particle_file import write_columns
from scree.record import CHECKPOINTS
from scree.run import Run

Path = str | os.PathLike[str]
Numbers = Sequence[float] | np.ndarray
AXES = "xyz"
SAME_TIME = 1e-12  # relative difference up to which the times of a snapshot and a checkpoint are the same


@dataclass(frozen=True)
class Packing:
    """Discs or spheres: positions [n][2 or 3] [m] and radii [n] [m]."""

    positions: np.ndarray
    radii: np.ndarray

    def __len__(self) -> int:
        return len(self.radii)

    @property
    def volume(self) -> float:
        """Total volume [m^3]; total area of discs [m^2]."""
        return float(volumes(self.radii, self.positions.shape[1]).sum())

    def __add__(self, other: Packing) -> Packing:
        return Packing(np.concatenate([self.positions, other.positions]), np.concatenate([self.radii, other.radii]))

    def write(self, path: Path) -> dict[str, Any]:
        """Writes CSV, or HDF5 if the name ends in .h5. Returns the keys of [[particles]] that read the file; for the
        path in them see write_columns()."""
        return write_columns(path, dict(zip(AXES, self.positions.T)) | {"radius": self.radii})


def volumes(radii: np.ndarray, dimension: int) -> np.ndarray:
    return np.asarray(np.pi * radii**2 if dimension == 2 else 4 / 3 * np.pi * radii**3)


def curve(diameters: Numbers, passing: Numbers) -> tuple[np.ndarray, np.ndarray]:
    """The sieve diameters [m] and the mass fractions between adjacent sieves. Throws ScreeError for an invalid
    curve."""
    sieves, shares = np.asarray(diameters, dtype=float), np.diff(np.asarray(passing, dtype=float))
    if len(sieves) < 2 or len(shares) + 1 != len(sieves) or sieves[0] <= 0 or (np.diff(sieves) <= 0).any():
        raise ScreeError("a sieve curve: diameters must be above 0 and increase, with a passing fraction for each")
    if passing[0] != 0 or passing[-1] != 1 or (shares < 0).any():
        raise ScreeError("a sieve curve: the passing fraction must increase from 0 at the first sieve to 1 at the last")
    return sieves, shares


def sieve_radii(diameters: Numbers, passing: Numbers, volume: float, dimension: int = 3, seed: int = 1) -> np.ndarray:
    """Radii [m] of particles with this total volume [m^3] (discs: area [m^2]), distributed by a sieve curve.

    diameters: of the sieves [m], increasing. passing: the mass fraction that passes each sieve, from 0 for the first to
    1 for the last. Between two sieves the mass is uniform in the logarithm of the diameter. The mass of each fraction
    is met within half a particle.
    """
    sieves, shares = curve(diameters, passing)
    random, found = np.random.default_rng(seed), []
    for low, high, share in zip(sieves, sieves[1:], shares):
        ends = np.array([low, high]) ** -dimension  # the number density falls with this power of the diameter
        wanted, drawn = share * volume, np.empty(0)
        sums = np.zeros(1)
        while sums[-1] < wanted:
            count = 16 + int(1.1 * (wanted - sums[-1]) / volumes(np.sqrt(low * high) / 2 * np.ones(1), dimension)[0])
            more = (ends[0] - random.random(count) * (ends[0] - ends[1])) ** (-1 / dimension)
            drawn = np.concatenate([drawn, more])
            sums = np.concatenate([[0.0], np.cumsum(volumes(drawn / 2, dimension))])
        found.append(drawn[: int(np.abs(sums - wanted).argmin())] / 2)
    return np.concatenate(found)


def place(radii: Numbers, low: Numbers, high: Numbers, gap: float = 0.0, seed: int = 1, tries: int = 10000) -> Packing:
    """Random positions completely inside the box and without overlap, the largest particles first.

    gap: smallest distance between surfaces [m]. Throws ScreeError if no position is found for a particle. With a single
    size this happens from a volume fraction of 0.3 on, in 2D from an area fraction of 0.5, with several sizes later.
    Denser beds are made by settling in the program (`settled`).
    """
    sizes = np.sort(np.asarray(radii, dtype=float))[::-1]
    lower, upper = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    if not len(sizes) or (upper - lower < 2 * sizes[0]).any():
        raise ScreeError("no particles to place" if not len(sizes) else "the box is smaller than the largest particle")
    random, positions = np.random.default_rng(seed), np.empty((len(sizes), len(lower)))
    width = 2 * sizes[0] + gap
    cells: dict[tuple[int, ...], list[int]] = {}
    around = list(itertools.product((-1, 0, 1), repeat=len(lower)))
    for k, radius in enumerate(sizes):
        for position in lower + radius + random.random((tries, len(lower))) * (upper - lower - 2 * radius):
            cell = tuple(int(c) for c in (position - lower) // width)
            near = [i for step in around for i in cells.get(tuple(map(sum, zip(cell, step))), ())]
            squares = ((positions[near] - position) ** 2).sum(axis=1)
            if (squares >= (sizes[near] + radius + gap) ** 2).all():
                positions[k] = position
                cells.setdefault(cell, []).append(k)
                break
        else:
            fraction = volumes(sizes[:k], len(lower)).sum() / np.prod(upper - lower)
            raise ScreeError(f"positions for {k} of {len(sizes)} particles, which fill {fraction:.3g} of the box; no "
                             f"further one in {tries} tries")
    return Packing(positions, sizes)


def mean_volume(diameters: Numbers, passing: Numbers, dimension: int) -> float:
    """Mean volume of the particles of a sieve curve [m^3]; of discs the mean area [m^2]."""
    sieves, shares = curve(diameters, passing)
    # Mean of 1 / d^dimension between two sieves; the volume is uniform in the logarithm of the diameter d.
    each = -np.diff(sieves**-dimension) / (dimension * np.diff(np.log(sieves)))
    return float(1 / (shares @ each) * volumes(np.ones(1) / 2, dimension)[0])


def graded(diameters: Numbers, passing: Numbers, low: Numbers, high: Numbers, fraction: float | None = None,
           seed: int = 1, *, count: int | None = None) -> Packing:
    """Particles by a sieve curve (sieve_radii) at random positions in a box. fraction: of the box that they fill; or
    count: their approximate number."""
    if (fraction is None) == (count is None):
        raise ScreeError("graded particles: either fraction or count must be given")
    box = float(np.prod(np.asarray(high, dtype=float) - np.asarray(low, dtype=float)))
    volume = count * mean_volume(diameters, passing, len(low)) if count is not None else (fraction or 0.0) * box
    return place(sieve_radii(diameters, passing, volume, len(low), seed), low, high, seed=seed)


def layers(low: Numbers, high: Numbers, heights: Numbers, curves: Sequence[tuple[Numbers, Numbers]], fraction: float,
           seed: int = 1) -> list[Packing]:
    """One packing per layer, from the bottom of the box upwards along its last axis. heights: of the layers [m], with a
    sum of at most the height of the box; curves: (diameters, passing) of each layer."""
    if sum(heights) > (high[-1] - low[-1]) * (1 + 1e-12) or len(heights) != len(curves):
        raise ScreeError("layers: there must be a curve for each layer, and their heights must fit into the box")
    found, bottom = [], float(low[-1])
    for number, (height, (diameters, passing)) in enumerate(zip(heights, curves)):
        box = [*low[:-1], bottom], [*high[:-1], bottom + height]
        found.append(graded(diameters, passing, *box, fraction, seed + number))
        bottom += height
    return found


def shared(groups: Sequence[Mapping[str, Any]], key: str) -> Any:
    """The common value of this key in all groups of particles, if it is a single number; else None."""
    values = {str(group.get(key)): group.get(key) for group in groups}
    value = next(iter(values.values())) if len(values) == 1 else None
    return value.get("value") if isinstance(value, Mapping) else value


def from_checkpoint(run: Run, number: int) -> dict[str, np.ndarray]:
    """Spins [rad/s] and masses [kg] of the particles of a snapshot, from a checkpoint at its time. Empty without such a
    checkpoint; without spins if particles do not rotate."""
    names = ("angular_velocity", "mass")

    def take(file: h5py.File) -> tuple[float, np.ndarray, dict[str, np.ndarray]]:
        rows = file["real_rows/particles"]
        return (float(file["reals/clock/time"][0]), file["integer_rows/particles/global_id"][:],
                {name: rows[name][:] for name in names if name in rows})

    snapshot = run.snapshots[number]
    wanted = snapshot.particles["global_id"].values
    for path in (run.folder / name for name in CHECKPOINTS):
        if path.exists():
            time, ids, found = files.read(path, take)
            if abs(time - snapshot.time) <= SAME_TIME * abs(time) and np.isin(wanted, ids).all():
                order = np.argsort(ids)
                rows = order[np.searchsorted(ids, wanted, sorter=order)]
                return {name: values[rows] for name, values in found.items()}
    return {}


def settled(run: Run, folder: Path, number: int = -1) -> list[dict[str, Any]]:
    """The particles of a snapshot, by default the last one, for another deck: writes one file per material and returns
    the [[particles]] that read them. They have positions, velocities, spins and radii. The contact history is not
    transferred: tangential springs start from zero.

    Spins and masses are those of the snapshot (output.fields with "angular_velocity" and "mass"), otherwise those of a
    checkpoint at its time, as a run writes at its end. If the deck has one mass or density for all particles of a
    material, the table takes it. Warns if particles rotate and no spins are known. Throws ScreeError if masses or radii
    are missing.
    """
    if not len(run.snapshots):
        raise ScreeError(f"{run.folder}: holds no snapshots")
    particles, deck = run.snapshots[number].particles, run.deck
    if particles.count == 0:
        raise ScreeError(f"{run.folder}: the snapshot has no particles")
    for name in ("radius", "velocity"):
        if name not in particles:
            raise ScreeError(f"{run.folder}: the snapshots have no {name}; output.fields must name it")
    names = [material["name"] for material in deck.get("materials", [])] or ["default"]
    if len(names) > 1 and "material" not in particles:
        raise ScreeError(f"{run.folder}: the snapshots have no material; output.fields must name it")
    materials = particles["material"].values if "material" in particles else np.zeros(particles.count, dtype=int)
    more = from_checkpoint(run, number)
    rotates = any(pair.get("friction", 0) for pair in deck.get("contact", {}).get("pairs", []))
    if rotates and "angular_velocity" not in {*particles, *more}:
        warnings.warn(f"{run.folder}: spins are lost, because neither the snapshot nor a checkpoint of its time has "
                      'them; output.fields must name "angular_velocity"', ScreeWarning, stacklevel=2)
    pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
    tables = []
    for index in np.unique(materials):
        name, rows = names[int(index)], materials == index
        table: dict[str, Any] = {"name": f"settled_{name}"}
        if len(names) > 1:
            table["material"] = name
        groups = [group for group in deck.get("particles", []) if group.get("material", names[0]) == name]
        density = next((m.get("density") for m in deck.get("materials", []) if m["name"] == name), None)
        known = {key: value for key in ("mass", "density") if (value := shared(groups, key)) is not None}
        from_material = density is not None and not any("mass" in group for group in groups)
        if "mass" in particles or known or from_material:
            fields = {key: values for key, values in more.items() if key != "mass"}
        elif "mass" in more:
            fields = more
        else:
            raise ScreeError(f"{run.folder}: the snapshots have no mass; output.fields must name it")
        path = pathlib.Path(folder) / f"settled_{name}.h5"
        table |= particles.to_particle_file(path, deck["space"]["dimension"], rows, fields)
        if (factor := shared(groups, "inertia_factor")) is not None:
            table["inertia_factor"] = factor
        tables.append(table if "mass" in particles or "mass" in fields else table | known)
    return tables
