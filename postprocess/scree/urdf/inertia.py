"""Physically possible inertia tensors, and the nearest possible one."""

from __future__ import annotations

import numpy as np

ROUNDING = 1e-6  # relative rounding of moments in a file
LEAST = 1e-3  # smallest second moment of mass after mending over the largest: a rod of 30 diameters
WATER = 1000.0  # density of the sphere that replaces a body without moments [kg/m^3]
OF_PROGRAM = 1e-10  # relative excess of a moment over the sum of the others that the program accepts


def excess(tensor: np.ndarray) -> float:
    """Relative excess of the largest principal moment over the sum of the others; infinite if a moment is not above
    0."""
    principal = np.linalg.eigvalsh(tensor)
    return float(principal[2] / (principal[0] + principal[1]) - 1) if principal[0] > 0 else np.inf


def text_of(tensor: np.ndarray) -> str:
    return ", ".join(f"{value:.4g}" for value in np.linalg.eigvalsh(tensor))


def nearest(tensor: np.ndarray, mass: float, least: float = LEAST) -> np.ndarray:
    """The nearest possible tensor with the same principal axes. The second moments of mass along these axes, the
    integrals of x^2 dm, are half the trace minus the principal moments, and are not negative in a body. Smaller ones
    are raised to the fraction `least` of the largest. If none is above 0, the moments are those of a sphere of water of
    this mass [kg]."""
    principal, axes = np.linalg.eigh(tensor)
    second = principal.sum() / 2 - principal
    if not second.max() > 0:
        radius = (3 * mass / (4 * np.pi * WATER)) ** (1 / 3)
        second = np.full(3, mass * radius**2 / 5)
    second = np.maximum(second, least * second.max())
    return np.asarray(axes @ np.diag(second.sum() - second) @ axes.T)


def without_rounding(tensor: np.ndarray, mass: float) -> np.ndarray:
    """The tensor, or the nearest possible one if they differ only by rounding."""
    return nearest(tensor, mass, ROUNDING) if OF_PROGRAM < excess(tensor) <= ROUNDING else tensor
