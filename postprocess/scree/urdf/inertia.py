"""Which inertia tensors a body can have, and the one next to one that it cannot."""

from __future__ import annotations

import numpy as np

ROUNDING = 1e-6  # of moments: what digits of a file leave out
LEAST = 1e-3  # second moment of a mended body along an axis, over the largest one: a rod of 30 diameters
WATER = 1000.0  # density of the sphere that stands for a body without any moment [kg/m^3]
OF_PROGRAM = 1e-10  # by which a moment may pass the sum of the others, so that the program takes it


def excess(tensor: np.ndarray) -> float:
    """By how much the largest principal moment passes the sum of the others, over that; infinite where one of them is
    not above 0."""
    principal = np.linalg.eigvalsh(tensor)
    return float(principal[2] / (principal[0] + principal[1]) - 1) if principal[0] > 0 else np.inf


def text_of(tensor: np.ndarray) -> str:
    return ", ".join(f"{value:.4g}" for value in np.linalg.eigvalsh(tensor))


def nearest(tensor: np.ndarray, mass: float, least: float = LEAST) -> np.ndarray:
    """Of the same axes. A body's second moments along its principal axes, the integrals of x^2 dm, are half the trace
    less the principal moments. None of them is below 0 in a body: those below a share of the largest are raised to
    that. Where there is none above 0, the moments are those of a sphere of water of this mass [kg]."""
    principal, axes = np.linalg.eigh(tensor)
    second = principal.sum() / 2 - principal
    if not second.max() > 0:
        radius = (3 * mass / (4 * np.pi * WATER)) ** (1 / 3)
        second = np.full(3, mass * radius**2 / 5)
    second = np.maximum(second, least * second.max())
    return np.asarray(axes @ np.diag(second.sum() - second) @ axes.T)


def without_rounding(tensor: np.ndarray, mass: float) -> np.ndarray:
    """The tensor; where no more than digits are missing, the possible one beside it."""
    return nearest(tensor, mass, ROUNDING) if OF_PROGRAM < excess(tensor) <= ROUNDING else tensor
