"""Names that a deck can have, in place of those that it cannot."""

from __future__ import annotations

import re
from collections.abc import Container

from scree.urdf.notes import Notes
from scree.urdf.xml import Element

GROUND = "ground"  # what a deck calls the space
LONGEST = 180  # bytes, of a deck's 200: the names of markers, stops and meshes are longer by their endings
NOT_ALLOWED = re.compile(r"[/\x00-\x1f\x7f]")


def allowed(name: str, taken: Container[str]) -> str:
    """The name itself, where a deck can have it and it is not taken, else one like it."""
    found = NOT_ALLOWED.sub("_", name).encode()[:LONGEST].decode(errors="ignore")
    if found in (".", "..", GROUND):
        found = f"{found.replace('.', '_')}_link"
    others = (f"{found}_{k}" for k in range(2, 2**31))
    return found if found not in taken else next(each for each in others if each not in taken)


def names_of(elements: list[Element], notes: Notes) -> dict[str, str]:
    """Of each name that links, or joints, have in the file the one in the deck. What a deck can have as it is stays."""
    given = list(dict.fromkeys(element.text("name") for element in elements))
    kept = {name for name in given if allowed(name, ()) == name}
    found: dict[str, str] = {}
    for name in given:
        found[name] = name if name in kept else allowed(name, kept | set(found.values()))
    for element in elements:
        if found[element.text("name")] != element.text("name"):
            notes.add('renamed, as a deck\'s names have no "/", no control characters and at most 200 bytes, and '
                      '"ground" is its space', f'{element.called} is "{found[element.text("name")]}"')
    return found


def rename(root: Element, notes: Notes) -> dict[str, str]:
    """Gives the links and joints of a robot, and what refers to them, names that a deck can have. Returns those of the
    joints by the names in the file."""
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
