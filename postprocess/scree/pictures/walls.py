"""Walls as polygons, clipped by a box."""

import numpy as np


def cut(polygon, point, normal):
    """The part of a convex polygon [n][k] on the normal's side of a plane (Sutherland and Hodgman)."""
    height = (polygon - point) @ normal
    clipped = []
    for i in range(len(polygon)):
        j = (i + 1) % len(polygon)
        if height[i] >= 0:
            clipped.append(polygon[i])
        if (height[i] < 0) != (height[j] < 0):
            fraction = height[i] / (height[i] - height[j])
            clipped.append(polygon[i] + fraction * (polygon[j] - polygon[i]))
    return np.array(clipped).reshape(-1, polygon.shape[1])


def rectangle(low, high):
    return np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]], dtype=float)


def solids(model, low, high):
    """Solid regions behind walls within the rectangle from low to high: polygons [n][2], each with (point, normal) of
    its wall. Walls inside the domain end at its sides."""
    view = rectangle(low, high)
    inside = rectangle(np.maximum(low, model.low[:2]), np.minimum(high, model.high[:2]))
    found = []
    for walls, region in ((model.side_walls(), view), (model.walls, inside)):
        for point, normal in walls:
            polygon = cut(region, point[:2], -normal[:2]) if (region[2] > region[0]).all() else region[:0]
            if len(polygon) > 2:
                found.append((polygon, (point[:2], normal[:2])))
    return found


def section(low, high, point, normal):
    """Intersection of a plane and a box: a polygon [n][3], empty without intersection."""
    normal = normal / np.linalg.norm(normal)
    start = np.eye(3)[np.argmin(np.abs(normal))]
    right = np.cross(normal, start)
    right /= np.linalg.norm(right)
    across = np.cross(normal, right)
    size = 2 * np.linalg.norm(high - low)
    center = (low + high) / 2
    center = center - normal * ((center - point) @ normal)
    polygon = center + size * np.array([-right - across, right - across, right + across, across - right])
    for axis in np.eye(3):
        polygon = cut(polygon, low, axis)
        polygon = cut(polygon, high, -axis) if len(polygon) else polygon
        if len(polygon) < 3:
            return np.empty((0, 3))
    return polygon
