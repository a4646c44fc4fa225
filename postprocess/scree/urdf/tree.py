"""The bodies of a robot in a deck: poses of links, and groups of links that form one body."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from scree.errors import ScreeError
from scree.frames import Pose
from scree.urdf import inertia
from scree.urdf.names import GROUND
from scree.urdf.notes import Notes
from scree.urdf.robot import MOVING, Geometry, Joint, Link, Robot, joint_motion


@dataclass
class Part:
    """Links that form one body, in the frame of the first one. name: of the first link with a mass, or "ground"."""

    name: str
    pose: Pose  # at t = 0
    links: list[tuple[Link, Pose]] = field(default_factory=list)  # links with their frames in the frame of the part

    def mass_properties(self) -> tuple[float, np.ndarray, np.ndarray]:
        """Mass [kg], centre of mass and inertia tensor about it [kg m^2], in the part's frame."""
        heavy = [(link, pose) for link, pose in self.links if link.mass > 0]
        masses = np.array([link.mass for link, _ in heavy])
        centers = np.array([pose.transform(link.center) for link, pose in heavy])
        center = masses @ centers / masses.sum()
        inertia = np.zeros((3, 3))
        for (link, pose), offset in zip(heavy, centers - center):
            inertia += pose.rotation @ link.inertia @ pose.rotation.T
            inertia += link.mass * (offset @ offset * np.eye(3) - np.outer(offset, offset))
        return float(masses.sum()), center, inertia

    def geometry(self) -> list[tuple[Link, Geometry, Pose]]:
        return [(link, each, pose @ each.pose) for link, pose in self.links for each in link.geometry]


@dataclass(frozen=True)
class Tree:
    parts: list[Part]  # the ground is the first
    joints: list[tuple[Joint, Part, Pose, Part]]  # joint, parent's part, joint frame in it, child's part
    held: Part | None  # part of a root with mass that is fixed to the ground
    coordinates: dict[str, float]  # initial joint coordinates [rad or m]


def find_root(robot: Robot) -> Link:
    """The root link. Throws ScreeError if links and joints do not form a tree."""
    above: dict[str, Joint] = {}
    for joint in robot.joints.values():
        for name in (joint.parent, joint.child):
            if name not in robot.links:
                joint.element.fail(f'there is no link "{name}"')
        if joint.child in above:
            joint.element.fail(f'closes a loop: link "{joint.child}" is a child of joint "{above[joint.child].name}". '
                               "The file of a robot is a tree; leave the joint out and add it to the deck")
        above[joint.child] = joint
    roots = [link for name, link in robot.links.items() if name not in above]
    for name in robot.links:
        seen = [name]
        while seen[-1] in above:
            seen.append(above[seen[-1]].parent)
            if seen[-1] == name:
                raise ScreeError(f"{robot.path}: links form a circle: {' <- '.join(seen)}")
            if seen.count(seen[-1]) > 1:
                break  # another circle further up, which is found from its own links
    if len(roots) != 1:
        names = ", ".join(f'"{link.name}"' for link in roots)
        raise ScreeError(f"{robot.path}: {f'several links have no parent: {names}' if roots else 'has no links'}; "
                         "there must be one")
    return roots[0]


def start_coordinates(robot: Robot, given: Mapping[str, float]) -> dict[str, float]:
    """Initial joint coordinates: as given, by the names in the file or in the deck, otherwise 0. Joints that mimic
    another one follow it."""
    given = {robot.joint_names.get(name, name): value for name, value in given.items()}
    for name in given:
        if name not in robot.joints or robot.joints[name].type not in MOVING:
            raise ScreeError(f"{robot.path}: no joint {name} with a coordinate; there are: "
                             f"{', '.join(j.name for j in robot.joints.values() if j.type in MOVING) or 'none'}")
        if robot.joints[name].mimics:
            raise ScreeError(f"{robot.path}: joint {name} mimics another one, which determines its start")
    found: dict[str, float] = {}

    def start(joint: Joint, followers: tuple[str, ...]) -> float:
        if joint.mimics is None:
            return given.get(joint.name, 0.0)
        name, multiple, added = joint.mimics
        other = robot.joints.get(name)
        if other is None or other.type not in MOVING:
            joint.element.fail(f'mimics "{name}", which is not a joint with a coordinate')
        if name in followers:
            joint.element.fail("mimics itself")
        return multiple * start(other, (*followers, name)) + added

    for joint in robot.joints.values():
        if joint.type in MOVING:
            found[joint.name] = start(joint, (joint.name,))
            if joint.type != "prismatic" and abs(found[joint.name]) > np.pi:
                raise ScreeError(f"{robot.path}: joint {joint.name} starts at {found[joint.name]:.6g}: must be from "
                                 "-pi to pi")
    return found


def build_tree(robot: Robot, base: Pose, free: bool, given: Mapping[str, float]) -> Tree:
    """base: pose of the root link. free: the root is not fixed; otherwise a root with mass is fixed to the ground, and
    a root without mass is part of it. Links without mass become parts of those to which they are fixed."""
    root, coordinates = find_root(robot), start_coordinates(robot, given)
    ground = Part(GROUND, Pose.at())
    parts, joints = [ground], []
    where: dict[str, tuple[Part, Pose]] = {}  # part of each link, and the frame of the link in it

    def assign(link: Link, part: Part, pose: Pose) -> None:
        if part.name == "" and link.mass > 0:
            part.name = link.name
        part.links.append((link, pose))
        where[link.name] = part, pose

    def begin_part(link: Link, pose: Pose) -> None:
        parts.append(Part("", pose))
        assign(link, parts[-1], Pose.at())

    if root.mass > 0 or free:
        begin_part(root, base)
    else:
        assign(root, ground, base)
    pending = [root.name]
    while pending:
        above = pending.pop(0)
        for joint in (each for each in robot.joints.values() if each.parent == above):
            child, (part, pose) = robot.links[joint.child], where[above]
            frame = pose @ joint.pose
            if joint.type == "fixed" and (child.mass == 0 or part.name == ""):
                assign(child, part, frame)
            else:
                begin_part(child, part.pose @ frame @ joint_motion(joint, coordinates.get(joint.name, 0.0)))
                joints.append((joint, part, frame, parts[-1]))
            pending.append(child.name)
    for part in parts:
        if part.name == "":
            part.links[0][0].element.fail("moves, but neither it nor a link fixed to it has a mass")
    return Tree(parts, joints, parts[1] if root.mass > 0 and not free else None, coordinates)


def fixed_to_ground(tree: Tree) -> set[str]:
    """Names of the parts that are fixed to the ground, whose masses have no effect."""
    found = {GROUND} | ({tree.held.name} if tree.held else set())
    for joint, above, _, part in tree.joints:  # from the root outwards
        if joint.type == "fixed" and above.name in found:
            found.add(part.name)
    return found


def make_inertia_possible(tree: Tree, mend: bool, notes: Notes) -> None:
    """Mends the inertia of parts fixed to the ground, and with `mend` of all parts. Throws ScreeError for an impossible
    inertia of a moving part."""
    static = fixed_to_ground(tree)
    for part in tree.parts:
        for k, (link, pose) in enumerate(part.links):
            tensor = inertia.without_rounding(link.inertia, link.mass)
            if link.mass > 0 and inertia.excess(tensor) > inertia.OF_PROGRAM:
                moments = f"principal moments {inertia.text_of(tensor)} kg m^2"
                if not mend and part.name not in static:
                    link.element.fail(f"inertia: {moments} are impossible; they must be above 0, and none above the "
                                      "sum of the two others; --mend-inertia takes the nearest possible ones")
                tensor = inertia.nearest(tensor, link.mass)
                kind = "it is fixed to the ground, where inertia has no effect" if part.name in static else \
                    "as requested by --mend-inertia"
                notes.add(f"an impossible inertia was replaced by the nearest possible one: {kind}",
                          f"{link.element.called} with {moments}, now {inertia.text_of(tensor)}")
            part.links[k] = replace(link, inertia=tensor), pose
