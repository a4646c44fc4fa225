"""Replaces names that a deck cannot have."""

from __future__ import annotations

import re
from collections.abc import Container

from scree.urdf.notes import Notes
from scree.urdf.xml import Element

GROUND = "ground"  # name of the ground in a deck
LONGEST = 180  # bytes; a deck allows 200, and names of markers, stops and meshes get suffixes
NOT_ALLOWED = re.compile(r"[/\x00-\x1f\x7f]")


def allowed(name: str, taken: Container[str]) -> str:
    """The name, if a deck can have it and it is free, otherwise a similar one."""
    found = NOT_ALLOWED.sub("_", name).encode()[:LONGEST].decode(errors="ignore")
    if found in (".", "..", GROUND):
        found = f"{found.replace('.', '_')}_link"
    others = (f"{found}_{k}" for k in range(2, 2**31))
    return found if found not in taken else next(each for each in others if each not in taken)


def names_of(elements: list[Element], notes: Notes) -> dict[str, str]:
    """Names in the deck by the names of links or joints in the file. Valid names are unchanged."""
    given = list(dict.fromkeys(element.text("name") for element in elements))
    valid = {name for name in given if allowed(name, ()) == name}
    found: dict[str, str] = {}
    for name in given:
        found[name] = name if name in valid else allowed(name, valid | set(found.values()))
    for element in elements:
        if found[element.text("name")] != element.text("name"):
            notes.add('renamed, because names in a deck have no "/", no control characters and at most 200 bytes, and '
                      '"ground" is reserved', f'{element.called} is "{found[element.text("name")]}"')
    return found


def rename(root: Element, notes: Notes) -> dict[str, str]:
    """Renames links and joints of a robot, with all references, to names that a deck can have. Returns the names of
    joints by their names in the file."""
    links, joints = (list(root.all(kind)) for kind in ("link", "joint"))
    link_names, joint_names = names_of(links, notes), names_of(joints, notes)

    def replace(element: Element | None, attribute: str, names: dict[str, str]) -> None:
        if element is not None and attribute in element.attributes:
            name = element.attributes[attribute].strip()
            element.attributes[attribute] = names.get(name, name)

    for joint in joints:
        for end in ("parent", "child"):
            replace(joint.first(end), "link", link_names)
        replace(joint.first("mimic"), "joint", joint_names)
        replace(joint, "name", joint_names)
    for link in links:
        replace(link, "name", link_names)
    return joint_names
