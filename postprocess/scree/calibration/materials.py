"""The grains of a materials file in the decks of the tests."""

from __future__ import annotations

import pathlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from scree.deck import Deck
from scree.errors import ScreeError

GRAIN, ROUGH, SMOOTH = "grain", "rough", "smooth"  # materials of the decks of the tests
NORMAL = ("stiffness", "exponent", "damping", "restitution", "limit_damping", "largest_overlap", "impact_speed")
MODULI = ("young_modulus", "poisson_ratio")


@dataclass(frozen=True)
class Grains:
    """What a materials file says of its grains."""

    name: str  # of the file
    material: dict[str, Any]
    pair: dict[str, Any]  # contact law of the grains with each other, without its materials
    radius: Any  # a number or a distribution [m]
    density: float  # [kg/m^3]

    @property
    def size(self) -> float:
        """Radius of a grain of the mean volume [m]."""
        return mean_radius(self.radius, self.name)


def mean_radius(radius: Any, name: str) -> float:
    """Radius of a particle of the mean volume [m]."""
    if not isinstance(radius, Mapping):
        return float(radius)
    kind, by_mass = radius.get("kind"), radius.get("by") == "mass"
    if kind == "constant":
        return float(radius["value"])
    if kind == "table":
        values = np.array(radius["values"])
        weights = np.array(radius.get("weights", [1.0] * len(values)))
        return float(np.cbrt(np.average(values**3, weights=weights / values**3 if by_mass else weights)))
    if kind in ("lognormal", "rosin_rammler") or (by_mass and kind in ("uniform", "normal")):
        return mean_of_density(radius, kind, by_mass)
    if kind == "uniform":
        low, high = radius["min"], radius["max"]
        return float(np.cbrt(0.25 * (high**2 + low**2) * (high + low)))
    if kind == "normal":
        return float(np.cbrt(radius["mean"] ** 3 + 3 * radius["mean"] * radius["sd"] ** 2))
    raise ScreeError(f"{name}: particles: radius: kind = {kind!r}: must be constant, uniform, normal, lognormal, "
                     "rosin_rammler or table")


def mean_of_density(radius: Mapping[str, Any], kind: str, by_mass: bool) -> float:
    """mean_radius() of a truncated distribution by its density, over the logarithm of the radius."""
    log = np.linspace(np.log(radius["min"]), np.log(radius["max"]), 20001)
    x = np.exp(log)
    if kind == "rosin_rammler":
        power = radius["exponent"] * (log - np.log(radius["scale"]))
        exponent = power - np.exp(np.minimum(power, 700.0))
    elif kind == "lognormal":
        exponent = -0.5 * ((log - np.log(radius["median"])) / np.log(radius["geometric_sd"])) ** 2
    elif kind == "normal":
        exponent = log - 0.5 * ((x - radius["mean"]) / radius["sd"]) ** 2
    else:
        exponent = log
    density = np.exp(exponent - np.max(exponent)) / (x**3 if by_mass else 1.0)
    density[[0, -1]] *= 0.5  # trapezoidal rule
    return float(np.cbrt(np.sum(density * x**3) / np.sum(density)))


def own_pair(file: Deck, material: Any, several: bool) -> Any:
    """The pair of a material with itself."""
    for pair in file["contact.pairs"] if "contact.pairs" in file else ():
        if list(pair.get("materials", [] if several else [material] * 2)) == [material] * 2:
            return pair
    raise ScreeError(f'{file.name}: contact.pairs: none is of "{material}" with itself')


def read(path: pathlib.Path, values: Mapping[str, Any] | None = None) -> Grains:
    """The grains of the first [[particles]] of a deck. values: keys to change first: of the pair of the grains with
    themselves, as friction, or with a dot of the deck, as materials.sand.young_modulus."""
    file = Deck.read(path)
    if "particles" not in file or file.get("space.dimension") != 3:
        raise ScreeError(f"{path}: must be a deck in three dimensions with the grains in its first [[particles]]")
    for key, value in (values or {}).items():
        if "." in key:
            file[key] = value
    group, materials = file["particles"][0], file["materials"] if "materials" in file else []
    named = group.get("material") or (materials[0]["name"] if len(materials) == 1 else None)
    material = next((each for each in materials if each["name"] == named), None)
    if material is None:
        raise ScreeError(f"{path}: particles.0.material: must name one of the [[materials]]")
    if "radius" not in group:
        raise ScreeError(f"{path}: particles.0.radius: missing")
    density = group.get("density", material.get("density"))
    if not isinstance(density, (int, float)):
        raise ScreeError(f"{path}: materials.{named}.density: must be a number above 0 [kg/m^3]")
    pair = dict(own_pair(file, named, len(materials) > 1).unwrap())
    pair.pop("materials", None)
    pair |= {key: value for key, value in (values or {}).items() if "." not in key}
    radius = group["radius"]
    return Grains(pathlib.Path(path).stem, dict(material.unwrap()), pair,
                  radius.unwrap() if hasattr(radius, "unwrap") else radius, float(density))


def softened(grains: Grains, factor: float) -> Grains:
    """With moduli or stiffnesses times the factor, and the same pull-off forces. Those of JKR, DMT and liquid bridges
    do not depend on the stiffness. That of elasto-plastic contacts (plasticity_ratio), 3/2 pi g a, grows with the
    contact radius a, which a given load makes as factor^(-1/3) with Hertz's law, and factor^(-1/2) with a linear one.
    """
    material, pair = dict(grains.material), dict(grains.pair)
    for table, key in ((material, "young_modulus"), (pair, "stiffness"), (pair, "tangential_stiffness")):
        if key in table:
            table[key] *= factor
    if pair.get("plasticity_ratio", 0) > 0 and "work_of_adhesion" in pair:
        pair["work_of_adhesion"] *= factor ** (1 / 2 if "stiffness" in pair else 1 / 3)
    return Grains(grains.name, material, pair, grains.radius, grains.density)


def put(tables: dict[str, Any], grains: Grains) -> None:
    """Puts the grains into the tables of a deck of a test: "rough" surfaces have the law of the grains, "smooth" ones
    its normal force without friction and adhesion. Other pairs stay as they are."""
    moduli = {key: grains.material[key] for key in MODULI if key in grains.material}
    for material in tables["materials"]:
        name = material["name"]
        material.clear()
        material |= {"name": name} | ({"density": grains.density} if name == GRAIN else {}) | moduli
    normal = {key: grains.pair[key] for key in NORMAL if key in grains.pair}
    laws = {frozenset([GRAIN]): grains.pair, frozenset([GRAIN, ROUGH]): grains.pair, frozenset([GRAIN, SMOOTH]): normal}
    for pair in tables["contact"]["pairs"]:
        law = laws.get(frozenset(pair["materials"]))
        if law is not None:
            names = pair["materials"]
            pair.clear()
            pair |= {"materials": names} | law
    for group in tables["particles"]:
        group["radius"] = grains.radius
