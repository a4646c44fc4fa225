"""Conversion of a URDF file to a deck."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from scree.deck import Deck
from scree.errors import ScreeError
from scree.frames import Pose, of_roll_pitch_yaw, to_z
from scree.urdf import meshes, robot
from scree.urdf.accepted import make_accepted
from scree.urdf.names import GROUND, allowed
from scree.urdf.notes import Notes
from scree.urdf.robot import MOVING, Joint
from scree.urdf.skeleton import HEAD, TAIL
from scree.urdf.tree import Part, Tree, build_tree, make_inertia_possible

DECK_TYPES = {"revolute": "revolute", "continuous": "revolute", "prismatic": "translational", "fixed": "fixed",
              "planar": "planar"}
STOP_DEFLECTION = 0.02  # deflection of a stop under the largest effort of the drive [rad or m]
STICTION = 1e-3  # deflection of the stiction spring at the limit [rad or m]; damping time of stuck joints [s]
MATERIAL = "robot"


@dataclass(frozen=True)
class Options:
    """free: the root link is not fixed to the ground. xyz [m], rpy [rad]: pose of its frame. positions: initial joint
    coordinates [rad or m]. geometry: that gets contacts, "collision", "visual" or "none". packages: folders by package
    name. stop_stiffness: of all stops at limits [N m/rad or N/m]; None: each yields by 0.02 rad or m under the effort
    of its joint's limit. mend_inertia: replace a physically impossible inertia by the nearest possible one."""

    free: bool = False
    xyz: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)
    positions: Mapping[str, float] = field(default_factory=dict)
    geometry: str = "collision"
    packages: Mapping[str, str] = field(default_factory=dict)
    stop_stiffness: float | None = None
    mend_inertia: bool = False


def geometry_of(deck: Deck, part: Part, options: Options, notes: Notes) -> tuple[dict[str, Any], float]:
    """Keys of a body: spheres are shapes, other geometry becomes meshes, which are added to the deck. And the largest
    distance of the geometry from the origin of the part [m]."""
    shapes, used, extent = [], [], 0.0
    for link, geometry, pose in part.geometry():
        made = meshes.mesh_table(geometry, pose, deck.folder, options.packages, notes)
        if made is None:
            continue
        table, distance = made
        extent = max(extent, distance)
        if geometry.kind == "sphere" and part.name != GROUND:
            shapes.append({"radius": table["radius"], "offset": pose.origin.tolist(), "material": MATERIAL})
            continue
        names = [mesh["name"] for mesh in deck.get("meshes", [])]
        numbered = (f"{link.name}_{k}" for k in range(2, len(names) + 3))
        name = next(each for each in (link.name, *numbered) if each not in names)
        deck.add("meshes", name=name, **table)
        used.append({"mesh": name, "material": MATERIAL})
    return {key: tables for key, tables in (("shapes", shapes), ("meshes", used)) if tables}, extent


def add_body(deck: Deck, part: Part, options: Options, notes: Notes) -> float:
    """Adds the body; geometry of the ground becomes walls. Returns the largest distance from the part's origin [m]."""
    geometry, extent = geometry_of(deck, part, options, notes)
    if part.name == GROUND:
        for used in geometry.get("meshes", []):
            deck.add("walls", name=used["mesh"], **used)
        return extent
    mass, center, inertia = part.mass_properties()
    tensor = [*np.diag(inertia).tolist(), *inertia[[0, 0, 1], [1, 2, 2]].tolist()]
    offset = {"center_of_mass": center.tolist()} if center.any() else {}
    pose = {"position": [0.0, 0.0, 0.0]} | part.pose.keys("position")
    deck.add("bodies", name=part.name, kind="spatial", **pose, mass=mass, **offset, inertia_tensor=tensor, **geometry)
    return max(extent, float(np.linalg.norm(center)))


def add_joint(deck: Deck, name: str, kind: str, ends: tuple[tuple[Part, Pose], tuple[Part, Pose]]) -> None:
    """Adds a joint between markers on two parts."""
    markers = [f"{name}_parent", f"{name}_child"]
    for marker, (part, pose) in zip(markers, ends):
        deck.add("markers", name=marker, body=part.name, **pose.keys("local_point"))
    deck.add("joints", name=name, type=kind, markers=markers)


def add_joints(deck: Deck, tree: Tree) -> None:
    if tree.held:
        base = allowed("base", [joint.name for joint, *_ in tree.joints])
        add_joint(deck, base, "fixed", ((tree.parts[0], tree.held.pose), (tree.held, Pose.at())))
    for joint, parent, frame, child in tree.joints:
        if joint.type != "floating":
            rotation = Pose.at(rotation=to_z(joint.axis))
            add_joint(deck, joint.name, DECK_TYPES[joint.type], ((parent, frame @ rotation), (child, rotation)))


def add_efforts(deck: Deck, joint: Joint, start: float, stop_stiffness: float | None, notes: Notes) -> None:
    """Adds stops, damping and friction of a joint."""
    name, called = joint.name, joint.element.called
    if joint.damping > 0:
        deck.add("joint_springs", name=f"{name}_damping", joint=name, damping=joint.damping)
    if joint.friction > 0:
        deck.add("joint_frictions", name=f"{name}_friction", joint=name, effort=joint.friction,
                 stiffness=rounded(joint.friction / STICTION), damping=joint.friction)
    ends = {key: end for key, end in (("lower", joint.lower), ("upper", joint.upper)) if np.isfinite(end)}
    if not ends:
        return
    if not joint.lower <= start <= joint.upper:
        notes.add("starts outside its limits, and the stop pushes it back; --position JOINT=VALUE sets another start",
                  f"{called} at {start:g}, with limits from {joint.lower:g} to {joint.upper:g}")
    stiffness = stop_stiffness or rounded(joint.effort / STOP_DEFLECTION)
    if stiffness > 0:
        deck.add("joint_limits", name=f"{name}_stop", joint=name, **ends, stiffness=stiffness,
                 damping=rounded(stiffness * STICTION))
    else:
        notes.add("limits without an effort, which determines the stiffness of stops: no stops; --stop-stiffness sets "
                  "one", called)


def has_speed_limit(joint: Joint) -> bool:
    limit = joint.element.first("limit")
    return limit is not None and limit.number("velocity", 0.0, infinite=True) > 0


def rounded(value: float) -> float:
    """Without trailing digits from round-off."""
    return float(f"{value:.12g}")


def add_couplers(deck: Deck, joints: list[Joint]) -> None:
    for joint in joints:
        if joint.mimics:
            other, multiple, _ = joint.mimics
            deck.add("couplers", name=f"{joint.name}_mimic", type="sum", joints=[joint.name, other],
                     coefficients=[1.0, -multiple])


def size_of(tree: Tree, extent: float) -> float:
    """Largest distance of the stretched robot from its root [m]. extent: largest distance of a part's geometry from its
    origin."""
    distance = sum(float(np.linalg.norm(joint.pose.origin)) for joint, *_ in tree.joints)
    for joint, *_ in tree.joints:
        if joint.type == "prismatic":
            ends = (joint.lower, joint.upper, tree.coordinates[joint.name])
            distance += max(abs(end) for end in ends if np.isfinite(end))
    return distance + extent


def tail(deck: Deck, moving: list[Joint]) -> str:
    """Comments with names and sizes of this deck."""
    low, high = (np.array(deck[f"space.{end}"], dtype=float) for end in ("min", "max"))
    low[2] += 0.7 * (high[2] - low[2])  # mostly above the robot
    return TAIL.format(body=deck["bodies"][-1]["name"] if "bodies" in deck else "LINK",
                       joint=moving[-1].name if moving else "JOINT",
                       low=low.round(6).tolist(), high=high.round(6).tolist(),
                       radius=float(f"{(high - low).min() / 50:.1g}"))


def to_deck(path: str | os.PathLike[str], options: Options | None = None) -> Deck:
    """The deck of a URDF file: links as bodies, joints between markers, limits as stops, damping and friction, mimics
    as couplers, and geometry with contact. The file has neither a domain nor a time: the domain contains the robot, and
    comments show further additions. Joint coordinates are those of the file.

    If the program is found, the deck passes `scree check`. Throws ScreeError with file and line for errors; warns
    (ScreeWarning) of omissions and changes, once per kind.
    """
    chosen, file = options or Options(), pathlib.Path(path)
    if chosen.geometry not in ("collision", "visual", "none"):
        raise ScreeError(f'geometry = "{chosen.geometry}": must be one of "collision", "visual", "none"')
    notes = Notes()
    found = robot.read(file, chosen.geometry, notes)
    base = Pose.at(chosen.xyz, of_roll_pitch_yaw(*chosen.rpy))
    tree = build_tree(found, base, chosen.free, chosen.positions)
    make_inertia_possible(tree, chosen.mend_inertia, notes)
    deck = Deck.parse(HEAD, os.fspath(path), file.resolve().parent)
    deck["title"] = found.name
    extents = [add_body(deck, part, chosen, notes) for part in tree.parts]
    extent = float(f"{1.1 * size_of(tree, max(extents)) + 0.1:.2g}")
    deck["space.min"] = [round(float(x) - extent, 6) for x in chosen.xyz]
    deck["space.max"] = [round(float(x) + extent, 6) for x in chosen.xyz]
    add_joints(deck, tree)
    moving = [joint for joint, *_ in tree.joints if joint.type in MOVING]
    for joint in moving:
        add_efforts(deck, joint, tree.coordinates[joint.name], chosen.stop_stiffness, notes)
        if has_speed_limit(joint):
            notes.add("limits of velocity are left out, because a deck has none", joint.element.called)
    add_couplers(deck, moving)
    deck["output.history_coordinates"] = len(moving)
    deck["output.history_bodies"] = [part.name for part in tree.parts if part.name != GROUND]
    make_accepted(deck, notes)
    notes.warn(path)
    return Deck.parse(str(deck) + tail(deck, moving), deck.name, deck.folder)
