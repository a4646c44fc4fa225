"""Frames in space: position and rotation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

Vector = Sequence[float] | np.ndarray
ALIGNED = 1e-15  # magnitude of a quaternion's vector part up to which there is no rotation


def of_roll_pitch_yaw(roll: float, pitch: float, yaw: float) -> np.ndarray:
    """Rotation [3][3] about the fixed axes x, then y, then z [rad]."""
    return np.asarray(about([0, 0, 1], yaw) @ about([0, 1, 0], pitch) @ about([1, 0, 0], roll))


def about(axis: Vector, angle: float) -> np.ndarray:
    """Rotation [3][3] about a unit vector (Rodrigues) [rad]."""
    x, y, z = axis
    across = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.asarray(np.eye(3) + np.sin(angle) * across + (1 - np.cos(angle)) * across @ across)


def quaternion_of(rotation: np.ndarray) -> np.ndarray:
    """Unit quaternion, scalar first, from its largest component (Shepperd, 1978)."""
    trace = np.trace(rotation)
    squares = np.array([trace, *np.diag(rotation)]) * 2 - trace + 1  # four times the square of each component
    k = int(squares.argmax())
    r = rotation
    products = {
        0: [squares[0], r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]],
        1: [r[2, 1] - r[1, 2], squares[1], r[1, 0] + r[0, 1], r[0, 2] + r[2, 0]],
        2: [r[0, 2] - r[2, 0], r[1, 0] + r[0, 1], squares[2], r[2, 1] + r[1, 2]],
        3: [r[1, 0] - r[0, 1], r[0, 2] + r[2, 0], r[2, 1] + r[1, 2], squares[3]],
    }
    found = np.array(products[k])
    return np.asarray(found / np.linalg.norm(found))


def to_z(axis: Vector) -> np.ndarray:
    """Rotation [3][3] of z to a unit vector; x becomes the perpendicular direction nearest to a global axis."""
    z = np.asarray(axis, dtype=float)
    x = np.eye(3)[int(np.abs(z).argmin())]
    y = np.cross(z, x)
    y /= np.linalg.norm(y)
    return np.stack([np.cross(y, z), y, z], axis=1)


@dataclass(frozen=True)
class Pose:
    """Pose of a frame in another: origin [m], and rotation [3][3] from its components to those of the other."""

    origin: np.ndarray
    rotation: np.ndarray

    @staticmethod
    def at(origin: Vector = (0.0, 0.0, 0.0), rotation: np.ndarray | None = None) -> Pose:
        return Pose(np.asarray(origin, dtype=float), np.eye(3) if rotation is None else rotation)

    def __matmul__(self, inner: Pose) -> Pose:
        """Pose of a frame that is given in this frame."""
        return Pose(self.transform(inner.origin), self.rotation @ inner.rotation)

    def transform(self, point: Vector) -> np.ndarray:
        """A point of this frame in the other frame."""
        return np.asarray(self.origin + self.rotation @ np.asarray(point, dtype=float))

    def keys(self, origin: str) -> dict[str, list[float]]:
        """Keys of a deck: the origin under this name, and a quaternion; zero values are omitted."""
        quaternion = quaternion_of(self.rotation)
        found = {origin: self.origin.tolist()} if self.origin.any() else {}
        if np.abs(quaternion[1:]).max() > ALIGNED:
            found["quaternion"] = quaternion.tolist()
        return found
