"""The triangles of meshes in a picture: whose they are, and the edges that outline them."""

import numpy as np

SHARP = np.cos(np.radians(30))  # edges at which faces turn by more are drawn


def sharp_edges(points, triangles):
    """Pairs of points [n][2]: edges of one triangle alone, or between two that lie at an angle."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.maximum(np.linalg.norm(normals, axis=1), np.finfo(float).tiny)[:, None]
    pairs = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, of_pair, uses = np.unique(pairs, axis=0, return_inverse=True, return_counts=True)
    # The faces of an edge add to a vector of length 2 where they are in one plane.
    total = np.zeros((len(edges), 3))
    np.add.at(total, of_pair.reshape(-1), np.repeat(normals, 3, axis=0))
    smooth = (uses == 2) & ((total**2).sum(axis=1) / 2 - 1 > SHARP)
    return edges[~smooth]


class Surfaces:
    """Of a run that has meshes."""

    def __init__(self, series):
        self._series = series
        triangles, body = series.triangles(), series.numbers("body")
        self.bodies = np.unique(body[body >= 0])  # those that have meshes
        self.triangles = {"walls": triangles[body < 0], "bodies": triangles[body >= 0]}
        points = series.rows(0, "Points")
        self._edges = {whose: sharp_edges(points, found) for whose, found in self.triangles.items()}

    def points(self, snapshot):
        return self._series.rows(snapshot, "Points")

    def lines(self, snapshot):
        """Edges [n][2][3] of walls and of bodies."""
        points = self.points(snapshot)
        return {whose: points[edges] for whose, edges in self._edges.items()}

    def bounds(self, snapshots):
        boxes = [self.points(snapshot) for snapshot in snapshots]
        return np.min([box.min(axis=0) for box in boxes], axis=0), np.max([box.max(axis=0) for box in boxes], axis=0)
