"""Particles for decks, made outside the program: graded by a sieve curve, in layers, or as another run has left them.

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
from scree.record import CHECKPOINTS
from scree.run import Run

Path = str | os.PathLike[str]
Numbers = Sequence[float] | np.ndarray
AXES = "xyz"
SAME_TIME = 1e-12  # of a time: by which a snapshot's may differ from that of a checkpoint


def write_columns(path: Path, columns: Mapping[str, np.ndarray]) -> dict[str, Any]:
    """A particle file of `kind = "file"`: HDF5 where the name ends in .h5 or .hdf5, else CSV, with all bits. Returns
    what [[particles]] says of it, with the path as it is given here: relative to the current folder, as in a deck made
    in Python, whose write() puts it right; a deck that was read takes paths relative to its own folder."""
    target = pathlib.Path(path)
    if target.suffix in (".h5", ".hdf5"):
        with h5py.File(target, "w") as file:
            for name, values in columns.items():
                file[name] = np.asarray(values, dtype=float)
    else:
        rows = zip(*(np.asarray(values, dtype=float).tolist() for values in columns.values()))
        target.write_text("\n".join([",".join(columns), *(",".join(map(repr, row)) for row in rows)]) + "\n",
                          encoding="utf-8")
    return {"kind": "file", "file": os.fspath(target)}


@dataclass(frozen=True)
class Grains:
    """Discs or spheres: places [n][2 or 3] [m] and radii [n] [m]."""

    positions: np.ndarray
    radii: np.ndarray

    def __len__(self) -> int:
        return len(self.radii)

    @property
    def volume(self) -> float:
        """Of all together [m^3], of discs the area [m^2]."""
        return float(volumes(self.radii, self.positions.shape[1]).sum())

    def __add__(self, other: Grains) -> Grains:
        return Grains(np.concatenate([self.positions, other.positions]), np.concatenate([self.radii, other.radii]))

    def write(self, path: Path) -> dict[str, Any]:
        """As CSV, or HDF5 by a name that ends in .h5. Returns what [[particles]] says of the file, with the path as it
        is given: see write_columns()."""
        return write_columns(path, dict(zip(AXES, self.positions.T)) | {"radius": self.radii})


def volumes(radii: np.ndarray, dimension: int) -> np.ndarray:
    return np.asarray(np.pi * radii**2 if dimension == 2 else 4 / 3 * np.pi * radii**3)


def curve(diameters: Numbers, passing: Numbers) -> tuple[np.ndarray, np.ndarray]:
    """The sieves [m] and the share of the mass between each two of them. Throws ScreeError for what is no curve."""
    sieves, shares = np.asarray(diameters, dtype=float), np.diff(np.asarray(passing, dtype=float))
    if len(sieves) < 2 or len(shares) + 1 != len(sieves) or sieves[0] <= 0 or (np.diff(sieves) <= 0).any():
        raise ScreeError("a sieve curve: diameters must be above 0 and grow, with a share that passes for each")
    if passing[0] != 0 or passing[-1] != 1 or (shares < 0).any():
        raise ScreeError("a sieve curve: what passes must grow from 0 for the first sieve to 1 for the last")
    return sieves, shares


def sieve_radii(diameters: Numbers, passing: Numbers, volume: float, dimension: int = 3, seed: int = 1) -> np.ndarray:
    """Radii [m] of as many grains as have this volume together [m^3] (discs: area [m^2]), by a sieve curve.

    diameters: of the sieves [m], growing. passing: the share of the mass that passes each, from 0 for the first to 1
    for the last. Between two sieves mass is spread evenly over the logarithm of the diameter. Each share is met to
    within half a grain.
    """
    sieves, shares = curve(diameters, passing)
    random, found = np.random.default_rng(seed), []
    for low, high, share in zip(sieves, sieves[1:], shares):
        ends = np.array([low, high]) ** -dimension  # numbers fall with this power of the diameter
        wanted, drawn = share * volume, np.empty(0)
        sums = np.zeros(1)
        while sums[-1] < wanted:
            count = 16 + int(1.1 * (wanted - sums[-1]) / volumes(np.sqrt(low * high) / 2 * np.ones(1), dimension)[0])
            more = (ends[0] - random.random(count) * (ends[0] - ends[1])) ** (-1 / dimension)
            drawn = np.concatenate([drawn, more])
            sums = np.concatenate([[0.0], np.cumsum(volumes(drawn / 2, dimension))])
        found.append(drawn[: int(np.abs(sums - wanted).argmin())] / 2)
    return np.concatenate(found)


def place(radii: Numbers, low: Numbers, high: Numbers, gap: float = 0.0, seed: int = 1, tries: int = 10000) -> Grains:
    """Random places in the box, wholly inside it and without overlap, the largest first; gap: least distance between
    surfaces [m]. Throws ScreeError where none is found for a grain: with one size that is from 0.3 of the box on, in
    the plane from 0.5, with several sizes later. Denser beds settle in the program (`settled`)."""
    sizes = np.sort(np.asarray(radii, dtype=float))[::-1]
    lower, upper = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    if not len(sizes) or (upper - lower < 2 * sizes[0]).any():
        raise ScreeError("no grains to place" if not len(sizes) else "the box is smaller than the largest grain")
    random, places = np.random.default_rng(seed), np.empty((len(sizes), len(lower)))
    width = 2 * sizes[0] + gap
    cells: dict[tuple[int, ...], list[int]] = {}
    around = list(itertools.product((-1, 0, 1), repeat=len(lower)))
    for k, radius in enumerate(sizes):
        for place in lower + radius + random.random((tries, len(lower))) * (upper - lower - 2 * radius):
            cell = tuple(int(c) for c in (place - lower) // width)
            near = [i for step in around for i in cells.get(tuple(map(sum, zip(cell, step))), ())]
            apart = ((places[near] - place) ** 2).sum(axis=1)
            if (apart >= (sizes[near] + radius + gap) ** 2).all():
                places[k] = place
                cells.setdefault(cell, []).append(k)
                break
        else:
            share = volumes(sizes[:k], len(lower)).sum() / np.prod(upper - lower)
            raise ScreeError(f"places for {k} of {len(sizes)} grains, {share:.3g} of the box; not one in {tries} tries")
    return Grains(places, sizes)


def mean_volume(diameters: Numbers, passing: Numbers, dimension: int) -> float:
    """Of the grains of a sieve curve [m^3], of discs the area [m^2]."""
    sieves, shares = curve(diameters, passing)
    # Between two sieves, where volume is even over the logarithm of the diameter d, the mean of 1 / d^dimension.
    each = -np.diff(sieves**-dimension) / (dimension * np.diff(np.log(sieves)))
    return float(1 / (shares @ each) * volumes(np.ones(1) / 2, dimension)[0])


def graded(diameters: Numbers, passing: Numbers, low: Numbers, high: Numbers, fraction: float | None = None,
           seed: int = 1, *, count: int | None = None) -> Grains:
    """Grains by a sieve curve (sieve_radii) at random places in a box, of which they fill this fraction; or about so
    many of them, as the curve has on average in that volume."""
    if (fraction is None) == (count is None):
        raise ScreeError("graded grains: either fraction or count must be given")
    box = float(np.prod(np.asarray(high, dtype=float) - np.asarray(low, dtype=float)))
    volume = count * mean_volume(diameters, passing, len(low)) if count is not None else (fraction or 0.0) * box
    return place(sieve_radii(diameters, passing, volume, len(low), seed), low, high, seed=seed)


def layers(low: Numbers, high: Numbers, heights: Numbers, curves: Sequence[tuple[Numbers, Numbers]], fraction: float,
           seed: int = 1) -> list[Grains]:
    """One sample per layer, from the bottom of the box up its last axis. heights: of the layers [m], together no more
    than the box's; curves: (diameters, passing) of each."""
    if sum(heights) > (high[-1] - low[-1]) * (1 + 1e-12) or len(heights) != len(curves):
        raise ScreeError("layers: there must be a curve for each, and their heights must fit into the box")
    found, bottom = [], float(low[-1])
    for number, (height, (diameters, passing)) in enumerate(zip(heights, curves)):
        box = [*low[:-1], bottom], [*high[:-1], bottom + height]
        found.append(graded(diameters, passing, *box, fraction, seed + number))
        bottom += height
    return found


def shared(groups: Sequence[Mapping[str, Any]], key: str) -> Any:
    """The value that a run's groups of particles have in common, if it is one number; else None."""
    values = {str(group.get(key)): group.get(key) for group in groups}
    value = next(iter(values.values())) if len(values) == 1 else None
    return value.get("value") if isinstance(value, Mapping) else value


def of_checkpoint(run: Run, number: int) -> dict[str, np.ndarray]:
    """Spins [rad/s] and masses [kg] of a snapshot's particles, of a checkpoint at its time; empty where there is none,
    and without spins where particles do not rotate."""
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
    """The particles of a snapshot, the last one if not said, for another deck: a file for each material and what
    [[particles]] says of it. Positions, velocities, spins and radii go along, what contacts remember does not: springs
    of friction begin anew.

    Spins and masses are those of the snapshot (output.fields with "angular_velocity" and "mass"), else those of a
    checkpoint of its time, as a run leaves at its end; masses, too, those of the run's deck, where that has one mass or
    density for all particles of the material. Warns where particles rotate and no spins are known. Throws ScreeError
    where there are no masses, or no radius.
    """
    if not len(run.snapshots):
        raise ScreeError(f"{run.folder}: holds no snapshots")
    particles, deck = run.snapshots[number].particles, run.deck
    if particles.count == 0:
        raise ScreeError(f"{run.folder}: the snapshot holds no particles")
    for name in ("radius", "velocity"):
        if name not in particles:
            raise ScreeError(f"{run.folder}: the snapshots have no {name}; output.fields must name it")
    names = [material["name"] for material in deck.get("materials", [])] or ["default"]
    if len(names) > 1 and "material" not in particles:
        raise ScreeError(f"{run.folder}: the snapshots have no material; output.fields must name it")
    materials = particles["material"].values if "material" in particles else np.zeros(particles.count, dtype=int)
    more = of_checkpoint(run, number)
    turns = any(pair.get("friction", 0) for pair in deck.get("contact", {}).get("pairs", []))
    if turns and "angular_velocity" not in {*particles, *more}:
        warnings.warn(f"{run.folder}: spins stay behind, as neither the snapshot nor a checkpoint of its time has "
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
