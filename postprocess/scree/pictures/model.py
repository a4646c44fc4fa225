"""Domain, walls and bodies of a resolved deck, and the poses of the bodies in a snapshot."""

import numpy as np

from scree.fields import POSITION

CENTER = 1  # kind of the points of bodies that are centres of mass
GROUND = -1  # index of the ground: the last row of a motion
SIDES = ("x_min", "x_max", "y_min", "y_max", "z_min", "z_max")
JOINT_KINDS = ("revolute", "translational", "fixed", "distance", "spherical", "universal", "constant-velocity",
               "cylindrical", "screw", "planar", "point-on-line", "point-on-plane")
SLIDES = ("translational", "cylindrical", "screw", "point-on-line")  # along an axis
SPRING_TABLES = {"spring_dampers": "spring", "torsional_spring_dampers": "torsional"}
HOLLOW = ("drum", "pipe", "funnel", "hopper", "file")  # meshes that may hold particles
UNDRIVEN = (None, 0, {"kind": "constant", "value": 0})  # actuators of plain springs


def in_space(vector):
    """A vector of the deck, which has two components in 2D, with three components."""
    return np.array([*vector, 0.0][:3], dtype=float)


def about_z(angles):
    """Rotations [..., 3, 3] by these angles [rad], from the frames of planar bodies to the global frame."""
    return of_quaternions(np.stack([np.cos(angles / 2), 0 * angles, 0 * angles, np.sin(angles / 2)], axis=-1))


def of_quaternions(quaternions):
    """Rotations of quaternions, scalar first, of any length."""
    w, x, y, z = np.moveaxis(quaternions / np.linalg.norm(quaternions, axis=-1, keepdims=True), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def unit(vector):
    return np.asarray(vector, dtype=float) / np.linalg.norm(vector)


def orientation(table):
    """Rotation from the orientation keys of a table."""
    if "quaternion" in table:
        return of_quaternions(np.array(table["quaternion"], dtype=float))
    if "z_axis" in table:
        z = unit(table["z_axis"])  # without x_axis: the global axis most nearly perpendicular to z
        y = unit(np.cross(z, table.get("x_axis", np.eye(3)[np.argmin(np.abs(z))])))
        return np.stack([np.cross(y, z), y, z], axis=-1)
    half = table.get("rotation_angle", 0.0) / 2
    axis = unit(table.get("rotation_axis", [0.0, 0.0, 1.0]))
    return of_quaternions(np.array([np.cos(half), *(np.sin(half) * axis)]))


def start_rotation(body):
    """Initial rotation of a body from its table in the deck."""
    return about_z(np.array(float(body["angle"]))) if body["kind"] == "planar" else orientation(body)


def volume(solid):
    if solid["kind"] == "box":
        return np.prod(solid["size"])
    length, radius = solid.get("length", 0.0), solid["radius"]
    ends = 0.0 if solid["kind"] == "cylinder" else 4 / 3 * np.pi * radius**3
    return np.pi * radius**2 * length + ends


def center_of_mass(body, densities):
    """Centre of mass in the frame of the body. densities: of the materials, by name. The deck does not have the volume
    of a mesh: with a mesh among the solids it is approximated by the mean of their origins."""
    if not body.get("solids"):
        return in_space(body.get("center_of_mass", [0.0, 0.0]))
    if any(s["kind"] == "mesh" for s in body["solids"]):
        return np.mean([in_space(s["offset"]) for s in body["solids"]], axis=0)
    only = next(iter(densities), None)
    masses = [
        volume(s) * (s["density"] if "density" in s else densities[s.get("material", only)])
        for s in body["solids"]
    ]
    return np.average([in_space(s["offset"]) for s in body["solids"]], axis=0, weights=masses)


def rotated(vectors, rotations):
    """Vectors in the frames of bodies, transformed to the global frame."""
    return np.einsum("...ij,...j->...i", rotations, np.asarray(vectors, dtype=float))


def rotated_back(vectors, rotations):
    return rotated(vectors, np.swapaxes(rotations, -2, -1))


class Motion:
    """Poses of the frames of all bodies and, last, of the ground."""

    def __init__(self, origins, rotations):
        self.origins, self.rotations = origins, rotations

    def positions(self, bodies, local):
        """Points fixed to bodies, in the global frame [m]."""
        return self.origins[bodies] + rotated(local, self.rotations[bodies])


class Connections:
    """Joints, springs and dampers of one kind: their bodies, and the points on these in their frames."""

    def __init__(self):
        self.bodies, self.points, self.axes = [], [], []

    def add(self, bodies, points, axis):
        self.bodies.append(bodies)
        self.points.append(points)
        self.axes.append(axis)

    def arrays(self):
        count = len(self.bodies)
        return (
            np.array(self.bodies, dtype=int).reshape(count, 2),
            np.array(self.points, dtype=float).reshape(count, 2, 3),
            np.array(self.axes, dtype=float).reshape(count, 3),
        )


class Model:
    def __init__(self, deck):
        self.title, domain = deck["title"], deck["space"]
        self.planar = domain["dimension"] == 2
        self.low, self.high = in_space(domain["min"]), in_space(domain["max"])
        self.gravity = in_space(deck["gravity"])
        self.boundaries = {side: domain[side] for side in SIDES[: 4 if self.planar else 6]}
        planes = [wall for wall in deck.get("walls", []) if "mesh" not in wall]
        self.walls = [(in_space(wall["point"]), in_space(wall["normal"])) for wall in planes]
        self.holding = self._holding(deck)
        densities = {material["name"]: material.get("density") for material in deck.get("materials", [])}
        self._read_bodies(deck.get("bodies", []), densities)
        self._markers = {marker["name"]: marker for marker in deck.get("markers", [])}
        self._read_connections(deck)

    @staticmethod
    def _holding(deck):
        """For each mesh on bodies and walls, in the order of the results, whether it may hold particles: first meshes
        with contact, then visual-only meshes."""
        kinds = {mesh["name"]: mesh["kind"] for mesh in deck.get("meshes", [])}
        names = {True: [], False: []}  # by whether they have contact
        for body in deck.get("bodies", []):
            for _ in range(body.get("count", 1)):
                for use in body.get("meshes", []):
                    names[body["collides"] and use["collides"]].append(use["mesh"])
        names[True] += [wall["mesh"] for wall in deck.get("walls", []) if "mesh" in wall]
        return [kinds[name] in HOLLOW for name in names[True] + names[False]]

    def _read_bodies(self, tables, densities):
        self.names, self.offsets, self.rows, self.centers_of_mass = [], [], {}, []
        origins, rotations = [], []
        for table in tables:
            offsets = np.array([in_space(s["offset"]) for s in table.get("shapes", [])]).reshape(-1, 3)
            for i in range(table.get("count", 1)):
                self.rows.setdefault(table["name"], []).append(len(self.names))
                self.names.append(f"{table['name']}.{i}" if "count" in table else table["name"])
                self.offsets.append(offsets)
                self.centers_of_mass.append(center_of_mass(table, densities))
                origins.append(in_space(table["position"]) + i * in_space(table["spacing"]))
                rotations.append(start_rotation(table))
        self.centers_of_mass.append(np.zeros(3))  # the ground
        self.start = Motion(np.array([*origins, np.zeros(3)]), np.array([*rotations, np.eye(3)]))
        self._index = {name: i for i, name in enumerate(self.names)} | {"ground": GROUND}

    def _pairs(self, table):
        if "chain" in table:
            row = self.rows[table["chain"]]
            return list(zip(row, row[1:]))
        if "each" in table:
            return [(GROUND, body) for body in self.rows[table["each"]]]
        if "markers" in table:
            return [tuple(self._index[self._markers[name]["body"]] for name in table["markers"])]
        return [tuple(self._index[name] for name in table["bodies"])]

    def _local(self, body, point):
        return rotated_back(point - self.start.origins[body], self.start.rotations[body])

    def _points(self, table, pair, common):
        """Points of a connection in the frames of its bodies. common: one point for both sides."""
        if "markers" in table:
            return [in_space(self._markers[name]["local_point"]) for name in table["markers"]]
        if "local_points" in table:
            return [in_space(p) for p in table["local_points"]]
        if "points" in table:
            return [self._local(body, in_space(p)) for body, p in zip(pair, table["points"])]
        if not common:
            return [self.centers_of_mass[body] for body in pair]
        moving = [self.start.positions(body, self.centers_of_mass[body]) for body in pair if body != GROUND]
        point = in_space(table["point"]) if "point" in table else np.mean(moving, axis=0)
        return [self._local(body, point) for body in pair]

    def _read_connections(self, deck):
        self.connections = {}

        def add(kind, table, common):
            axis = unit(in_space(table.get("axis", [1.0, 0.0])))
            for pair in self._pairs(table):
                local_axis = rotated_back(axis, self.start.rotations[pair[0]])
                if "markers" in table:
                    local_axis = orientation(self._markers[table["markers"][0]])[:, 2]
                self.connections.setdefault(kind, Connections()).add(
                    pair, self._points(table, pair, common), local_axis
                )

        for table in deck.get("joints", []):
            add(table["type"], table, common=table["type"] != "distance")
        for table in deck.get("cylinders", []):
            add("cylinder", table, common=False)
        for key, kind in SPRING_TABLES.items():
            for table in deck.get(key, []):
                add(kind if table.get("actuator") in UNDRIVEN else "cylinder", table, common=False)
        self.connections = {kind: found.arrays() for kind, found in self.connections.items()}

    @property
    def up(self):
        """Unit vector opposite to gravity; without gravity z, in planar runs y."""
        strength = np.linalg.norm(self.gravity)
        if strength > 0:
            return -self.gravity / strength
        return np.array([0.0, 1.0, 0.0]) if self.planar else np.array([0.0, 0.0, 1.0])

    @property
    def period(self):
        """Periods [m]; 0 along axes that are not periodic."""
        periodic = [self.boundaries.get(side) == "periodic" for side in SIDES[::2]]
        return np.where(periodic, self.high - self.low, 0.0)

    def side_walls(self):
        """The sides that are walls, as (point, normal into the domain)."""
        found = []
        for i, side in enumerate(SIDES):
            if self.boundaries.get(side) == "wall":
                normal = np.zeros(3)
                normal[i // 2] = 1 - 2 * (i % 2)
                found.append((self.high if i % 2 else self.low, normal))
        return found

    def motion(self, bodies, snapshot):
        """Poses of the bodies in a snapshot. bodies: their Series, or None without bodies."""
        motion = Motion(self.start.origins.copy(), self.start.rotations.copy())
        if bodies is None:
            return motion
        centers = bodies.rows(snapshot, "kind") == CENTER
        index = bodies.rows(snapshot, "body")[centers]
        motion.rotations[index] = (
            of_quaternions(bodies.rows(snapshot, "orientation")[centers])
            if bodies.has("orientation")  # if some bodies are spatial
            else about_z(bodies.rows(snapshot, "angle")[centers])
        )
        # Points are in the periodic box; origins are not wrapped.
        origins, period = bodies.rows(snapshot, "origin")[centers], self.period
        apart = bodies.rows(snapshot, POSITION)[centers] - origins
        motion.origins[index] = origins + period * np.round(apart / np.where(period > 0, period, np.inf))
        return motion
