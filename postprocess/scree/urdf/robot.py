"""Links and joints of a robot as its file has them, each checked by itself."""

from __future__ import annotations

import pathlib
from dataclasses import dataclass, field

import numpy as np

from scree.frames import Pose, of_roll_pitch_yaw
from scree.urdf import xml
from scree.urdf.xml import Element

TYPES = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")
MOVING = ("revolute", "continuous", "prismatic")  # those with one coordinate
READ = ("link", "joint", "material")  # elements of a robot; what others say is not of its mechanics


@dataclass(frozen=True)
class Geometry:
    """kind: "box", "cylinder", "sphere" or "mesh"; numbers [m]: its edges, its radius and length, its radius, or the
    scales along x, y and z of the mesh's file."""

    element: Element
    kind: str
    pose: Pose  # in the link's frame
    numbers: np.ndarray
    file: str = ""


@dataclass(frozen=True)
class Link:
    """Mass [kg], centre of mass and inertia tensor about it [kg m^2], in the link's frame; no mass: all zero."""

    element: Element
    name: str
    mass: float
    center: np.ndarray
    inertia: np.ndarray
    geometry: dict[str, list[Geometry]]  # of "collision" and of "visual"


@dataclass(frozen=True)
class Joint:
    """pose: of its frame, which at coordinate 0 is the child's, in the parent's."""

    element: Element
    name: str
    type: str
    parent: str
    child: str
    pose: Pose
    axis: np.ndarray  # of length 1, in the joint's frame
    lower: float  # [rad or m]; infinite: no limit
    upper: float
    effort: float  # largest one of its drive [N m or N]; 0: not said
    damping: float  # [N m s/rad or N s/m]
    friction: float  # [N m or N]
    mimics: tuple[str, float, float] | None  # another joint, the multiple of its coordinate, and what is added


@dataclass(frozen=True)
class Robot:
    path: pathlib.Path
    name: str
    links: dict[str, Link] = field(default_factory=dict)
    joints: dict[str, Joint] = field(default_factory=dict)
    ignored: tuple[str, ...] = ()  # names of elements that were not read


def pose_of(element: Element) -> Pose:
    """Of its <origin>."""
    origin = element.first("origin")
    if origin is None:
        return Pose.at()
    return Pose.at(origin.numbers("xyz", 3, [0, 0, 0]), of_roll_pitch_yaw(*origin.numbers("rpy", 3, [0, 0, 0])))


def read_inertia(link: Element) -> tuple[float, np.ndarray, np.ndarray]:
    inertial = link.first("inertial")
    mass = inertial.required("mass").number("value") if inertial else 0.0
    if inertial is None or mass == 0:
        return 0.0, np.zeros(3), np.zeros((3, 3))
    if mass < 0:
        link.fail(f"mass = {mass:g}: must not be below 0")
    element, pose = inertial.required("inertia"), pose_of(inertial)
    xx, yy, zz = (element.number(name) for name in ("ixx", "iyy", "izz"))
    xy, xz, yz = (element.number(name, 0.0) for name in ("ixy", "ixz", "iyz"))
    tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    principal = np.linalg.eigvalsh(tensor)
    if principal[0] <= 0 or principal[2] > (principal[0] + principal[1]) * (1 + 1e-6):
        moments = ", ".join(f"{value:.6g}" for value in principal)
        link.fail(f"inertia: principal moments {moments} kg m^2 are those of no body; they must be above 0, and none "
                  "above the sum of the two others")
    return mass, pose.origin, pose.rotation @ tensor @ pose.rotation.T


def read_geometry(owner: Element) -> Geometry:
    geometry, pose = owner.required("geometry"), pose_of(owner)
    shape = next(iter(geometry.children), None)
    if shape is None:
        owner.fail("its <geometry> is empty")
    if shape.name == "mesh":
        return Geometry(shape, "mesh", pose, shape.numbers("scale", 3, [1, 1, 1]), shape.text("filename"))
    if shape.name == "box":
        numbers = shape.numbers("size", 3)
    elif shape.name == "cylinder":
        numbers = np.array([shape.number("radius"), shape.number("length")])
    elif shape.name == "sphere":
        numbers = np.array([shape.number("radius")])
    else:
        shape.fail("unknown; known: box, cylinder, sphere, mesh")
    if (numbers <= 0).any():
        shape.fail("its measures must be above 0")
    return Geometry(shape, shape.name, pose, numbers)


def named(element: Element) -> str:
    name = element.text("name")
    if "/" in name or name in (".", ".."):
        element.fail('a deck\'s names have no "/"')
    return name


def read_link(element: Element) -> Link:
    name = named(element)
    if name == "ground":
        element.fail('is what a deck calls the space; give the link another name')
    mass, center, inertia = read_inertia(element)
    geometry = {kind: [read_geometry(each) for each in element.all(kind)] for kind in ("collision", "visual")}
    return Link(element, name, mass, center, inertia, geometry)


def read_limits(joint: Element, kind: str) -> tuple[float, float, float]:
    """Lower, upper, effort."""
    limit = joint.first("limit")
    if kind in ("revolute", "prismatic"):
        limit = joint.required("limit")
        lower, upper = limit.number("lower", 0.0), limit.number("upper", 0.0)
        if lower > upper:
            joint.fail(f"limits from {lower:g} to {upper:g}: the lower one is above the upper one")
        return lower, upper, limit.number("effort", 0.0)
    return -np.inf, np.inf, limit.number("effort", 0.0) if limit else 0.0


def read_axis(joint: Element) -> np.ndarray:
    element = joint.first("axis")
    axis = element.numbers("xyz", 3) if element else np.array([1.0, 0.0, 0.0])
    if not axis.any():
        joint.fail("axis = 0 0 0: has no direction")
    return np.asarray(axis / np.linalg.norm(axis))


def read_joint(element: Element) -> Joint:
    kind = element.text("type")
    if kind not in TYPES:
        element.fail(f'type = "{kind}": must be one of {", ".join(TYPES)}')
    dynamics, mimic = element.first("dynamics"), element.first("mimic")
    damping, friction = (dynamics.number(name, 0.0) if dynamics else 0.0 for name in ("damping", "friction"))
    if damping < 0 or friction < 0:
        element.fail("dynamics: damping and friction must not be below 0")
    mimics = (mimic.text("joint"), mimic.number("multiplier", 1.0), mimic.number("offset", 0.0)) if mimic else None
    parent, child = (element.required(name).text("link") for name in ("parent", "child"))
    return Joint(element, named(element), kind, parent, child, pose_of(element), read_axis(element),
                 *read_limits(element, kind), damping, friction, mimics)


def read(path: pathlib.Path) -> Robot:
    """Throws ScreeError for what cannot be read, with file and line."""
    root = xml.read(path)
    if root.name != "robot":
        root.fail("the file of a robot begins with <robot>")
    links: dict[str, Link] = {}
    joints: dict[str, Joint] = {}
    for element in root.children:
        if element.name == "link":
            link = read_link(element)
            if link.name in links:
                element.fail("a second link of this name")
            links[link.name] = link
        elif element.name == "joint":
            joint = read_joint(element)
            if joint.name in joints:
                element.fail("a second joint of this name")
            joints[joint.name] = joint
    ignored = dict.fromkeys(child.name for child in root.children if child.name not in READ)
    return Robot(path, root.attributes.get("name", path.stem), links, joints, tuple(ignored))
