"""Bars, springs and joints of the bodies of a model as lines and points, for any scene."""

import numpy as np

from scree.pictures.model import GROUND, JOINT_KINDS, SLIDES, rotated

COILS = 6  # number of coils of a spring
SHORT = 4  # springs shorter than this many units are straight lines
BARREL = 0.6  # length of the barrel of a hydraulic cylinder over the length of the cylinder at t = 0
MOST_POINTS = 2000  # largest number of points of a body that are connected by bars


def shortest_tree(points):
    """Minimum spanning tree of the points (Prim) as pairs of indices."""
    count = len(points)
    distance, nearest = np.full(count, np.inf), np.zeros(count, dtype=int)
    waiting = np.ones(count, dtype=bool)
    last, pairs = 0, []
    for _ in range(count - 1):
        waiting[last] = False
        to_last = np.linalg.norm(points - points[last], axis=1)
        closer = to_last < distance
        distance[closer], nearest[closer] = to_last[closer], last
        last = int(np.argmin(np.where(waiting, distance, np.inf)))
        pairs.append((nearest[last], last))
    return pairs


def zigzags(ends, width):
    """Springs between ends [n][2][3] as zigzag lines [n][points][3], in the x-y plane if possible."""
    along = ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(along, axis=1)[:, None]
    across = np.stack([-along[:, 1], along[:, 0], np.zeros(len(along))], axis=1)
    size = np.linalg.norm(across, axis=1)[:, None]
    across = np.where(size > 0, across / np.maximum(size, 1e-300), [1.0, 0.0, 0.0])
    amplitude = np.where(length > SHORT * width, width, 0.0)
    fraction = np.concatenate([[0, 0.15], np.linspace(0.2, 0.8, 2 * COILS), [0.85, 1]])
    side = np.array([0, 0, *[1, -1] * COILS, 0, 0])
    return (
        ends[:, None, 0]
        + fraction[None, :, None] * along[:, None]
        + side[None, :, None] * (amplitude * across)[:, None]
    )


def barrels(ends, start_lengths):
    """Barrels [n][2][3] of cylinders between ends [n][2][3], starting at the first end."""
    along = ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(along, axis=1)
    fraction = np.minimum(BARREL * start_lengths / np.maximum(length, 1e-300), 0.9)
    return np.stack([ends[:, 0], ends[:, 0] + fraction[:, None] * along], axis=1)


class Mechanism:
    """motion(snapshot): poses of the bodies; unit: size of small objects in the picture [m]."""

    def __init__(self, model, motion, unit):
        self.model, self.motion, self.unit = model, motion, unit
        self._bars = self._find_bars()

    def _find_bars(self):
        """Bodies and pairs of points on them: the shortest lines that connect the shapes and joints of a body, or its
        centre of mass if it has no shapes."""
        points = [list(own) or [center] for own, center in zip(self.model.offsets, self.model.centers_of_mass)]
        for pairs, local, _ in self.model.connections.values():
            for pair, ends in zip(pairs, local):
                for body, point in zip(pair, ends):
                    if body != GROUND:
                        points[body].append(point)
        known, owner, lines = {}, [], []
        for body, own in enumerate(points):
            own = np.unique(np.array(own).reshape(-1, 3), axis=0)
            if not 1 < len(own) <= MOST_POINTS:
                continue
            key = own.tobytes()  # equal for all bodies of a row
            if key not in known:
                known[key] = [own[[i, j]] for i, j in shortest_tree(own)]
            owner += [body] * len(known[key])
            lines += known[key]
        return np.array(owner, dtype=int), np.array(lines).reshape(-1, 2, 3)

    def _ends(self, motion, kind):
        """Ends of the connections of a kind, the second as the nearest image; their bodies and axes."""
        if kind not in self.model.connections:
            return np.empty((0, 2, 3)), np.empty((0, 2), dtype=int), np.empty((0, 3))
        pairs, local, axes = self.model.connections[kind]
        ends = motion.positions(pairs, local)
        period = self.model.period
        apart = ends[:, 1] - ends[:, 0]
        ends[:, 1] -= period * np.round(apart / np.where(period > 0, period, np.inf))
        return ends, pairs, rotated(axes, motion.rotations[pairs[:, 0]])

    def _start_lengths(self):
        """Lengths of the cylinders at t = 0 [m]."""
        ends = self._ends(self.model.start, "cylinder")[0]
        return np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)

    def draw(self, snapshot):
        """({style: lines [n][points][3]}, {kind of joint: points [n][3]}); "held" are points on the ground."""
        motion = self.motion(snapshot)
        owner, local = self._bars
        bars = motion.positions(owner[:, None], local)
        lines = {"bar": bars, "spring": zigzags(self._ends(motion, "spring")[0], self.unit)}
        lines["rod"] = self._ends(motion, "cylinder")[0]
        lines["barrel"] = barrels(lines["rod"], self._start_lengths())
        points, held, guides = {}, [], []
        for kind in (*JOINT_KINDS, "torsional", "spring", "cylinder"):
            ends, pairs, axes = self._ends(motion, kind)
            held.append(ends[pairs == GROUND] if kind != "torsional" else np.empty((0, 3)))
            if kind == "distance":
                lines["distance"] = ends
            elif kind in SLIDES:
                offset = np.sum((ends[:, 1] - ends[:, 0]) * axes, axis=1)
                ends_along = np.stack([np.minimum(offset, 0), np.maximum(offset, 0)], axis=1)
                ends_along += 12 * self.unit * np.array([-1, 1])
                guides.append(ends[:, :1] + ends_along[:, :, None] * axes[:, None])
            points[kind] = ends[:, 1]
            if kind == "torsional":  # at the centre of a body
                points[kind] = np.where(pairs[:, 1:] == GROUND, ends[:, 0], ends[:, 1])
        points["distance"] = points["spring"] = points["cylinder"] = np.empty((0, 3))
        points["held"], lines["guide"] = np.concatenate(held), np.concatenate(guides)
        return lines, points
