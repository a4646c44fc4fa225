"""A robot's file as a deck."""

from __future__ import annotations

import os
import pathlib
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from scree.deck import Deck
from scree.errors import ScreeError, ScreeWarning
from scree.frames import Pose, of_roll_pitch_yaw, to_z
from scree.urdf import meshes, robot
from scree.urdf.robot import MOVING, Joint
from scree.urdf.skeleton import HEAD, TAIL
from scree.urdf.tree import GROUND, Part, Tree, plant

DECK_TYPES = {"revolute": "revolute", "continuous": "revolute", "prismatic": "translational", "fixed": "fixed",
              "planar": "planar"}
GIVES_WAY = 0.02  # of a stop under the largest effort of the joint's drive [rad or m]
STICKS = 1e-3  # way on which friction grows [rad or m], and time in which what sticks comes to rest [s]
MATERIAL = "robot"


@dataclass(frozen=True)
class Options:
    """free: the root link is held by nothing. xyz [m], rpy [rad]: its frame in the space. positions: coordinates of
    joints at t = 0 [rad or m]. geometry: what particles touch, "collision", "visual" or "none". packages: folders that
    package://NAME stands for. stop_stiffness: of all stops at limits [N m/rad or N/m]; none: each gives way by 0.02 rad
    or m under the effort of its joint's limit."""

    free: bool = False
    xyz: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)
    positions: Mapping[str, float] = field(default_factory=dict)
    geometry: str = "collision"
    packages: Mapping[str, str] = field(default_factory=dict)
    stop_stiffness: float | None = None


def warn(text: str) -> None:
    warnings.warn(ScreeWarning(text), stacklevel=3)


def geometry_of(deck: Deck, part: Part, options: Options) -> dict[str, Any]:
    """What a body's table says of it: spheres are shapes, all else meshes, which are added to the deck."""
    shapes, used = [], []
    for link, geometry, pose in part.geometry(options.geometry):
        if geometry.kind == "sphere" and part.name != GROUND:
            shapes.append({"radius": float(geometry.numbers[0]), "offset": pose.origin.tolist(), "material": MATERIAL})
            continue
        table = meshes.mesh_table(geometry, pose, deck.folder, options.packages)
        if table is not None:
            names = [mesh["name"] for mesh in deck.get("meshes", [])]
            numbered = (f"{link.name}_{k}" for k in range(2, len(names) + 3))
            name = next(each for each in (link.name, *numbered) if each not in names)
            deck.add("meshes", name=name, **table)
            used.append({"mesh": name, "material": MATERIAL})
    return {key: tables for key, tables in (("shapes", shapes), ("meshes", used)) if tables}


def add_body(deck: Deck, part: Part, options: Options) -> None:
    """What stands on the ground becomes walls."""
    geometry = geometry_of(deck, part, options)
    if part.name == GROUND:
        for used in geometry.get("meshes", []):
            deck.add("walls", name=used["mesh"], **used)
        return
    mass, center, inertia = part.mass_properties()
    tensor = [*np.diag(inertia).tolist(), *inertia[[0, 0, 1], [1, 2, 2]].tolist()]
    away = {"center_of_mass": center.tolist()} if center.any() else {}
    pose = {"position": [0.0, 0.0, 0.0]} | part.pose.keys("position")
    deck.add("bodies", name=part.name, kind="spatial", **pose, mass=mass, **away, inertia_tensor=tensor, **geometry)


def add_joint(deck: Deck, name: str, kind: str, ends: tuple[tuple[Part, Pose], tuple[Part, Pose]]) -> None:
    """Between a marker on each of two parts."""
    markers = [f"{name}_parent", f"{name}_child"]
    for marker, (part, pose) in zip(markers, ends):
        deck.add("markers", name=marker, body=part.name, **pose.keys("local_point"))
    deck.add("joints", name=name, type=kind, markers=markers)


def add_joints(deck: Deck, tree: Tree) -> None:
    if tree.held:
        if "base" in (joint.name for joint, *_ in tree.joints):
            raise ScreeError(f'{deck.name}: a joint is named "base", which is that of the root with the ground here')
        add_joint(deck, "base", "fixed", ((tree.parts[0], tree.held.pose), (tree.held, Pose.at())))
    for joint, parent, frame, child in tree.joints:
        if joint.type != "floating":
            turn = Pose.at(rotation=to_z(joint.axis))
            add_joint(deck, joint.name, DECK_TYPES[joint.type], ((parent, frame @ turn), (child, turn)))


def add_efforts(deck: Deck, joint: Joint, start: float, stop_stiffness: float | None) -> None:
    """Stops, damping, friction."""
    name, place = joint.name, joint.element.place
    if joint.damping > 0:
        deck.add("joint_springs", name=f"{name}_damping", joint=name, damping=joint.damping)
    if joint.friction > 0:
        deck.add("joint_frictions", name=f"{name}_friction", joint=name, effort=joint.friction,
                 stiffness=rounded(joint.friction / STICKS), damping=joint.friction)
    if not np.isfinite([joint.lower, joint.upper]).all():
        return
    if not joint.lower <= start <= joint.upper:
        warn(f"{place}: joint {name} starts at {start:g}, outside its limits from {joint.lower:g} to {joint.upper:g}; "
             f"--position {name}=VALUE starts it elsewhere")
    stiffness = stop_stiffness or rounded(joint.effort / GIVES_WAY)
    if stiffness > 0:
        deck.add("joint_limits", name=f"{name}_stop", joint=name, lower=joint.lower, upper=joint.upper,
                 stiffness=stiffness, damping=rounded(stiffness * STICKS))
    else:
        warn(f"{place}: joint {name} has limits but no effort from which the stiffness of its stops would follow, and "
             "goes past them; --stop-stiffness gives one")


def has_speed_limit(joint: Joint) -> bool:
    limit = joint.element.first("limit")
    return limit is not None and limit.number("velocity", 0.0) > 0


def rounded(value: float) -> float:
    """Without the last digits, which arithmetic leaves."""
    return float(f"{value:.12g}")


def add_couplers(deck: Deck, joints: list[Joint]) -> None:
    for joint in joints:
        if joint.mimics:
            other, multiple, _ = joint.mimics
            deck.add("couplers", name=f"{joint.name}_mimic", type="sum", joints=[joint.name, other],
                     coefficients=[1.0, -multiple])


def size_of(tree: Tree, kind: str) -> float:
    """How far from the root's place the robot may reach, stretched out [m]."""
    far = sum(float(np.linalg.norm(joint.pose.origin)) for joint, *_ in tree.joints)
    far += sum(max(abs(joint.lower), abs(joint.upper)) for joint, *_ in tree.joints
               if joint.type == "prismatic" and np.isfinite(joint.upper))
    shapes = [float(np.linalg.norm(pose.origin)) + meshes.reach(geometry)
              for part in tree.parts for _, geometry, pose in part.geometry(kind)]
    centers = [float(np.linalg.norm(part.mass_properties()[1])) for part in tree.parts if part.name != GROUND]
    return far + max([*shapes, *centers, 0.0])


def tail(deck: Deck, moving: list[Joint]) -> str:
    """Comments with names and measures of this deck."""
    low, high = (np.array(deck[f"space.{end}"], dtype=float) for end in ("min", "max"))
    low[2] += 0.7 * (high[2] - low[2])  # above the robot, in most cases
    return TAIL.format(body=deck["bodies"][-1]["name"] if "bodies" in deck else "LINK",
                       joint=moving[-1].name if moving else "JOINT",
                       low=low.round(6).tolist(), high=high.round(6).tolist(),
                       radius=float(f"{(high - low).min() / 50:.1g}"))


def to_deck(path: str | os.PathLike[str], options: Options | None = None) -> Deck:
    """Of a URDF: links as bodies, joints between markers, limits as stops, damping and friction, mimics as couplers,
    and geometry that particles touch; of what the file does not say, a space that has room for it, a time, and comments
    where the rest goes. Joint coordinates are those of the file.

    Throws ScreeError with file and line for what is wrong; warns (ScreeWarning) of what is left out.
    """
    chosen, file = options or Options(), pathlib.Path(path)
    if chosen.geometry not in ("collision", "visual", "none"):
        raise ScreeError(f'geometry = "{chosen.geometry}": must be one of "collision", "visual", "none"')
    found = robot.read(file)
    if found.ignored:
        warn(f"{file}: not read: {', '.join(f'<{name}>' for name in found.ignored)}")
    base = Pose.at(chosen.xyz, of_roll_pitch_yaw(*chosen.rpy))
    tree = plant(found, base, chosen.free, chosen.positions)
    deck = Deck.parse(HEAD, os.fspath(path), file.resolve().parent)
    deck["title"] = found.name
    reach = float(f"{1.1 * size_of(tree, chosen.geometry) + 0.1:.2g}")
    deck["space.min"] = [round(float(x) - reach, 6) for x in chosen.xyz]
    deck["space.max"] = [round(float(x) + reach, 6) for x in chosen.xyz]
    for part in tree.parts:
        add_body(deck, part, chosen)
    add_joints(deck, tree)
    moving = [joint for joint, *_ in tree.joints if joint.type in MOVING]
    for joint in moving:
        add_efforts(deck, joint, tree.coordinates[joint.name], chosen.stop_stiffness)
    add_couplers(deck, moving)
    with_speeds = [joint.name for joint in moving if has_speed_limit(joint)]
    if with_speeds:
        warn(f"{file}: limits of velocity are left out, as a deck has none: of {', '.join(with_speeds)}")
    deck["output.history_coordinates"] = len(moving)
    deck["output.history_bodies"] = [part.name for part in tree.parts if part.name != GROUND]
    return Deck.parse(str(deck) + tail(deck, moving), deck.name, deck.folder)
