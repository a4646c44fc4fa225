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
    parser.add_argument("--overwrite", action="store_true", help="a deck of this name may be there")
    parser.add_argument("--free", action="store_true",
                        help="nothing holds the root, which is otherwise fixed to the ground")
    parser.add_argument("--xyz", type=float, nargs=3, default=(0.0, 0.0, 0.0), metavar=("X", "Y", "Z"),
                        help="where the root's frame is [m]")
    parser.add_argument("--rpy", type=float, nargs=3, default=(0.0, 0.0, 0.0), metavar=("R", "P", "Y"),
                        help="how it is turned, about x, y and z [rad]")
    parser.add_argument("--position", nargs="+", default=[], action="extend", metavar="JOINT=VALUE",
                        help="coordinates at t = 0 [rad or m]; default: 0")
    parser.add_argument("--geometry", choices=("collision", "visual", "none"), default="collision",
                        help="which of the links' geometries particles touch (default collision)")
    parser.add_argument("--package", nargs="+", default=[], action="extend", metavar="NAME=FOLDER",
                        help="what package://NAME stands for")
    parser.add_argument("--stop-stiffness", type=float, metavar="K",
                        help="of the stops at the joints' limits [N m/rad or N/m]; default: each gives way by 0.02 rad "
                             "or m under the effort of its limit")
    parser.add_argument("--mend-inertia", action="store_true",
                        help="makes an inertia that no body can have the nearest that one can, and says to what")


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


def run(words: argparse.Namespace) -> int:
    """A robot's URDF as a deck, to which loop joints and particles can be added

    Links become bodies, joints joints, limits stops, with damping, friction, couplers for joints that mimic others, and
    meshes that particles touch. What is left out or made otherwise is said, once of each kind.
    """
    from scree import urdf

    path = words.output or words.robot.with_suffix(".toml")
    if path.exists() and not words.overwrite:
        raise ScreeError(f"{path}: is there already; --overwrite replaces it")
    options = urdf.Options(words.free, tuple(words.xyz), tuple(words.rpy),
                           {name: number(text) for name, text in pairs(words.position).items()}, words.geometry,
                           pairs(words.package), words.stop_stiffness, words.mend_inertia)
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always", ScreeWarning)
        deck = urdf.to_deck(words.robot, options)
    for each in said:
        print(f"warning: {each.message}", file=sys.stderr)
    deck.write(path)
    print(path)
    return 0
