"""Triangles of meshes in a picture: their owners and their outlines."""

import numpy as np

from scree.errors import ScreeError
from scree.fields import POSITION

SHARP = np.cos(np.radians(30))  # cosine of the angle between faces above which their edge is drawn


def sharp_edges(points, triangles):
    """Pairs of points [n][2]: edges of a single triangle, or between two triangles at an angle."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.maximum(np.linalg.norm(normals, axis=1), np.finfo(float).tiny)[:, None]
    pairs = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, of_pair, uses = np.unique(pairs, axis=0, return_inverse=True, return_counts=True)
    # The sum of the normals at an edge has length 2 if the two faces are coplanar.
    total = np.zeros((len(edges), 3))
    np.add.at(total, of_pair.reshape(-1), np.repeat(normals, 3, axis=0))
    smooth = (uses == 2) & ((total**2).sum(axis=1) / 2 - 1 > SHARP)
    return edges[~smooth]


class Surfaces:
    """The meshes of a run."""

    def __init__(self, series, holding):
        """holding: for each mesh on bodies and walls, whether it may hold particles and is drawn semi-transparent."""
        self._series = series
        self.field = None  # field that colours the meshes; limit: upper end of the scale
        self.limit = 0.0
        triangles, body = series.triangles(0), series.rows(0, "body")
        self._rows = {"walls": body < 0, "bodies": body >= 0}
        self.triangles = {owner: triangles[rows] for owner, rows in self._rows.items()}
        through = np.array([*holding, False])[series.rows(0, "surface")]
        self.glass = {owner: through[rows] for owner, rows in self._rows.items()}
        points = series.rows(0, POSITION)
        self._edges = {owner: sharp_edges(points, found) for owner, found in self.triangles.items()}

    def color_by(self, field, snapshots):
        """The scale ends at the largest 99th percentile of the positive values in these snapshots."""
        if not self._series.is_of_cells(field):
            raise ScreeError(f"surfaces have no field {field}; the run's output.surface_fields must name it")
        self.field = field
        values = [self._all_values(snapshot) for snapshot in snapshots]
        self.limit = max((np.percentile(some, 99) for some in (all_[all_ > 0] for all_ in values) if len(some)),
                         default=1.0)

    def label(self):
        return f"{self.field.replace('_', ' ')} [{self._series.label(self.field)[0]}]"

    def _all_values(self, snapshot):
        """Values of the field; of a vector its magnitude."""
        values = self._series.rows(snapshot, self.field)
        return values if values.ndim == 1 else np.linalg.norm(values, axis=1)

    def values(self, snapshot):
        """Values of the field by triangle, for walls and for bodies."""
        values = self._all_values(snapshot)
        return {owner: values[rows] for owner, rows in self._rows.items()}

    def points(self, snapshot):
        return self._series.rows(snapshot, POSITION)

    def lines(self, snapshot):
        """Edges [n][2][3], for walls and for bodies."""
        points = self.points(snapshot)
        return {owner: points[edges] for owner, edges in self._edges.items()}

    def bounds(self, snapshots):
        boxes = [self.points(snapshot) for snapshot in snapshots]
        return np.min([box.min(axis=0) for box in boxes], axis=0), np.max([box.max(axis=0) for box in boxes], axis=0)
