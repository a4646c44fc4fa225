"""Links and joints of a robot as in its file, each checked separately."""

from __future__ import annotations

import pathlib
from dataclasses import dataclass, field, replace

import numpy as np

from scree.frames import Pose, about, of_roll_pitch_yaw
from scree.urdf import names, xml
from scree.urdf.notes import Notes
from scree.urdf.xml import Element

TYPES = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")
MOVING = ("revolute", "continuous", "prismatic")  # types with one coordinate
READ = ("link", "joint", "material")  # elements that are read; others are not part of the mechanics


@dataclass(frozen=True)
class Geometry:
    """kind: "box", "cylinder", "capsule", "sphere" or "mesh"; numbers [m]: edges of a box; radius and length (of a
    capsule without its half spheres); radius of a sphere; scales along x, y and z of a mesh file."""

    element: Element
    kind: str
    pose: Pose  # in the link's frame
    numbers: np.ndarray
    file: str = ""


@dataclass(frozen=True)
class Link:
    """Mass [kg], centre of mass and inertia tensor about it [kg m^2], in the frame of the link, possibly impossible;
    all zero without mass."""

    element: Element
    name: str
    mass: float
    center: np.ndarray
    inertia: np.ndarray
    geometry: list[Geometry]  # geometries of the requested kind


@dataclass(frozen=True)
class Joint:
    """pose: of the joint frame in the frame of the parent; at coordinate 0 it is the frame of the child."""

    element: Element
    name: str
    type: str
    parent: str
    child: str
    pose: Pose
    axis: np.ndarray  # unit vector in the joint frame
    lower: float  # [rad or m]; infinite: no limit; equal to the upper one: fixed there
    upper: float
    effort: float  # largest effort of the drive [N m or N]; 0: not given
    damping: float  # [N m s/rad or N s/m]
    friction: float  # [N m or N]
    mimics: tuple[str, float, float] | None  # another joint, multiplier and offset of its coordinate


@dataclass(frozen=True)
class Robot:
    path: pathlib.Path
    name: str
    links: dict[str, Link] = field(default_factory=dict)
    joints: dict[str, Joint] = field(default_factory=dict)
    joint_names: dict[str, str] = field(default_factory=dict)  # names in the deck by those in the file


def pose_of(element: Element) -> Pose:
    """Pose in its <origin>."""
    origin = element.first("origin")
    if origin is None:
        return Pose.at()
    return Pose.at(origin.numbers("xyz", 3, [0, 0, 0]), of_roll_pitch_yaw(*origin.numbers("rpy", 3, [0, 0, 0])))


def read_inertia(link: Element) -> tuple[float, np.ndarray, np.ndarray]:
    inertial = link.first("inertial")
    weight = inertial.first("mass") if inertial else None
    mass = weight.number("value") if weight else 0.0
    if inertial is None or mass == 0:
        return 0.0, np.zeros(3), np.zeros((3, 3))
    if mass < 0:
        link.fail(f"mass = {mass:g}: must not be below 0")
    element, pose = inertial.first("inertia"), pose_of(inertial)
    if element is None:
        return mass, pose.origin, np.zeros((3, 3))
    xx, yy, zz = (element.number(name) for name in ("ixx", "iyy", "izz"))
    xy, xz, yz = (element.number(name, 0.0) for name in ("ixy", "ixz", "iyz"))
    tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return mass, pose.origin, pose.rotation @ tensor @ pose.rotation.T


def read_geometry(owner: Element, notes: Notes) -> Geometry | None:
    """None, with a note, if a deck cannot have the geometry."""
    geometry = owner.first("geometry")
    shape = next(iter(geometry.children), None) if geometry is not None else None
    if shape is None:
        notes.add("without a geometry, left out", f"{owner.name} (line {owner.line})")
        return None
    kind, pose = shape.name, pose_of(owner)
    if kind == "mesh":
        numbers = shape.numbers("scale", 3, [1, 1, 1])
    elif kind == "box":
        numbers = shape.numbers("size", 3)
    elif kind in ("cylinder", "capsule"):
        numbers = np.array([shape.number("radius"), shape.number("length")])
    elif kind == "sphere":
        numbers = np.array([shape.number("radius")])
    else:
        notes.add("neither box, cylinder, capsule, sphere nor mesh, left out", f"{kind} (line {shape.line})")
        return None
    if kind == "capsule" and numbers[1] == 0:
        kind, numbers = "sphere", numbers[:1]
    if (numbers == 0).any() or (kind != "mesh" and (numbers < 0).any()):
        notes.add("a dimension is not above 0, left out", f"{kind} (line {shape.line})")
        return None
    return Geometry(shape, kind, pose, numbers, shape.text("filename") if kind == "mesh" else "")


def read_link(element: Element, geometry: str, notes: Notes) -> Link:
    shapes = [] if geometry == "none" else [read_geometry(each, notes) for each in element.all(geometry)]
    return Link(element, element.text("name"), *read_inertia(element), [each for each in shapes if each])


def read_limits(joint: Element, kind: str, notes: Notes) -> tuple[float, float, float]:
    """Lower, upper, effort."""
    limit = joint.first("limit")
    effort = limit.number("effort", 0.0, infinite=True) if limit else 0.0
    effort = effort if np.isfinite(effort) else 0.0
    if kind not in ("revolute", "prismatic"):
        return -np.inf, np.inf, effort
    if limit is None or not (limit.has("lower") or limit.has("upper")):
        notes.add("limits without lower and upper: no stops", joint.called)
        return -np.inf, np.inf, effort
    lower, upper = (limit.number(name, 0.0, infinite=True) for name in ("lower", "upper"))
    if lower > upper:
        notes.add("the lower limit is above the upper one: no stops",
                  f"{joint.called} from {lower:g} to {upper:g}")
        return -np.inf, np.inf, effort
    return lower, upper, effort


def read_axis(joint: Element, kind: str) -> np.ndarray:
    """Unit axis of the joint; x by default."""
    element = joint.first("axis") if kind in (*MOVING, "planar") else None
    axis = element.numbers("xyz", 3) if element else np.array([1.0, 0.0, 0.0])
    if not axis.any():
        joint.fail("axis = 0 0 0: has no direction")
    axis = axis / np.abs(axis).max()
    return np.asarray(axis / np.linalg.norm(axis))


def read_joint(element: Element, notes: Notes) -> Joint:
    kind = element.text("type")
    if kind not in TYPES:
        element.fail(f'type = "{kind}": must be one of {", ".join(TYPES)}')
    dynamics, mimic = element.first("dynamics"), element.first("mimic")
    damping, friction = (dynamics.number(name, 0.0) if dynamics else 0.0 for name in ("damping", "friction"))
    if damping < 0 or friction < 0:
        element.fail("dynamics: damping and friction must not be below 0")
    mimics = (mimic.text("joint"), mimic.number("multiplier", 1.0), mimic.number("offset", 0.0)) if mimic else None
    if mimics and kind not in MOVING:
        notes.add("has no coordinate: cannot mimic another joint", f"{kind} {element.called}")
        mimics = None
    parent, child = (element.required(name).text("link") for name in ("parent", "child"))
    return Joint(element, element.text("name"), kind, parent, child, pose_of(element), read_axis(element, kind),
                 *read_limits(element, kind, notes), damping, friction, mimics)


def joint_motion(joint: Joint, coordinate: float) -> Pose:
    """Pose of the frame of the child in the joint frame."""
    if joint.type == "prismatic":
        return Pose.at(coordinate * joint.axis)
    return Pose.at(rotation=about(joint.axis, coordinate))


def fixed_coordinate(joint: Joint, joints: dict[str, Joint], fixed: dict[str, float]) -> float | None:
    """The coordinate of a joint that cannot move; None if it can. fixed: coordinates of joints that cannot move."""
    if joint.type not in MOVING:
        return None
    if joint.mimics is None:
        return joint.lower if joint.lower == joint.upper else None
    name, multiple, added = joint.mimics
    if name in joints and (multiple == 0 or name in fixed or joints[name].type == "fixed"):
        return multiple * fixed.get(name, 0.0) + added
    return None


def fix_immovable(joints: dict[str, Joint], notes: Notes) -> None:
    """Replaces joints that cannot move by fixed joints at their coordinate."""
    fixed: dict[str, float] = {}
    while True:
        found = {name: at for name, joint in joints.items()
                 if name not in fixed and (at := fixed_coordinate(joint, joints, fixed)) is not None}
        if not found:
            break
        fixed |= found
    for name, at in fixed.items():
        joint = joints[name]
        why = ("mimics a joint that does not move" if joint.mimics else
               "lower = upper; a joint without both has no stops")
        notes.add(f"made a fixed joint: {why}", f"{joint.element.called} at {at:g}")
        joints[name] = replace(joint, type="fixed", pose=joint.pose @ joint_motion(joint, at), mimics=None)
    for name, joint in joints.items():
        if joint.type in MOVING and joint.lower == joint.upper:
            notes.add("lower = upper of a joint that mimics another one: no stops",
                      joint.element.called)
            joints[name] = replace(joint, lower=-np.inf, upper=np.inf)


def read(path: pathlib.Path, geometry: str = "none", notes: Notes | None = None) -> Robot:
    """geometry: "collision", "visual" or "none"; the others are not read. notes: collects changes. Throws ScreeError
    with file and line for errors."""
    root, changes = xml.read(path), notes or Notes()
    if root.name != "robot":
        root.fail("the file of a robot must begin with <robot>")
    joint_names = names.rename(root, changes)
    links: dict[str, Link] = {}
    joints: dict[str, Joint] = {}
    for element in root.all("link"):
        link = read_link(element, geometry, changes)
        if link.name in links:
            element.fail("a second link of this name")
        links[link.name] = link
    for element in root.all("joint"):
        joint = read_joint(element, changes)
        if joint.name in joints:
            element.fail("a second joint of this name")
        joints[joint.name] = joint
    fix_immovable(joints, changes)
    for name in dict.fromkeys(child.name for child in root.children if child.name not in READ):
        changes.add("not read", f"<{name}>")
    return Robot(path, root.attributes.get("name", path.stem), links, joints, joint_names)
