from __future__ import annotations

import argparse
import pathlib
import sys
import warnings
from collections.abc import Sequence

from scree.errors import ScreeError, ScreeWarning


def describe(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("robot", type=pathlib.Path, metavar="URDF")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="DECK",
                        help="default: the name of URDF, with .toml")
    parser.add_argument("--overwrite", action="store_true", help="replace an existing deck of this name")
    parser.add_argument("--free", action="store_true",
                        help="release the root, which is otherwise fixed to the ground")
    parser.add_argument("--xyz", type=float, nargs=3, default=(0.0, 0.0, 0.0), metavar=("X", "Y", "Z"),
                        help="position of the root's frame [m]")
    parser.add_argument("--rpy", type=float, nargs=3, default=(0.0, 0.0, 0.0), metavar=("R", "P", "Y"),
                        help="rotation of the root's frame about x, y and z [rad]")
    parser.add_argument("--position", nargs="+", default=[], action="extend", metavar="JOINT=VALUE",
                        help="initial joint coordinates [rad or m]; default: 0")
    parser.add_argument("--geometry", choices=("collision", "visual", "none"), default="collision",
                        help="geometry of the links that gets contacts (default collision)")
    parser.add_argument("--package", nargs="+", default=[], action="extend", metavar="NAME=FOLDER",
                        help="folder for package://NAME")
    parser.add_argument("--stop-stiffness", type=float, metavar="K",
                        help="stiffness of the stops at joint limits [N m/rad or N/m]; default: each yields by 0.02 "
                             "rad or m under the effort of its limit")
    parser.add_argument("--mend-inertia", action="store_true",
                        help="replace a physically impossible inertia by the nearest possible one, and print it")


def pairs(words: Sequence[str]) -> dict[str, str]:
    for word in words:
        if "=" not in word:
            raise ScreeError(f"{word}: must have the form NAME=VALUE")
    return dict(word.split("=", 1) for word in words)


def number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ScreeError(f"{text}: must be a number") from None


def run(arguments: argparse.Namespace) -> int:
    """A robot's URDF as a deck, to which loop joints and particles can be added

    Links become bodies, joints become joints with stops at their limits, damping and friction, joints that mimic others
    become couplers, and geometry becomes meshes with contact. Omissions and changes are listed, one line per kind.
    """
    from scree import urdf

    path = arguments.output or arguments.robot.with_suffix(".toml")
    if path.exists() and not arguments.overwrite:
        raise ScreeError(f"{path}: exists already; --overwrite replaces it")
    options = urdf.Options(arguments.free, tuple(arguments.xyz), tuple(arguments.rpy),
                           {name: number(text) for name, text in pairs(arguments.position).items()}, arguments.geometry,
                           pairs(arguments.package), arguments.stop_stiffness, arguments.mend_inertia)
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always", ScreeWarning)
        deck = urdf.to_deck(arguments.robot, options)
    for each in warned:
        print(f"warning: {each.message}", file=sys.stderr)
    deck.write(path)
    print(path)
    return 0
