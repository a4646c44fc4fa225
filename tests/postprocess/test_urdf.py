"""Robots from URDF as decks, and that they move as the same mechanisms written by hand.

    SCREE=build/release/scree python3 tests/postprocess/test_urdf.py

Needs postprocess/requirements.txt."""

import contextlib
import io
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import warnings

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

import pyvista
import scree
from scree.cli import main
from scree.frames import Pose, about, of_roll_pitch_yaw, quaternion_of, to_z
from scree.urdf import Options, to_deck
from scree.urdf.robot import read
from scree.urdf.tree import Part

PROGRAM = os.environ["SCREE"]
ROUND_OFF = 1e-12  # of positions after 500 steps [m]


def link(name, mass=1.0, center="0 0 0", rpy="0 0 0", moments=(0.01, 0.02, 0.02), more=""):
    xx, yy, zz = moments
    inertia = f'<inertia ixx="{xx}" ixy="0" ixz="0" iyy="{yy}" iyz="0" izz="{zz}"/>'
    origin = f'<origin xyz="{center}" rpy="{rpy}"/>'
    return f'<link name="{name}"><inertial>{origin}<mass value="{mass}"/>{inertia}</inertial>{more}</link>\n'


def joint(name, kind, parent, child, xyz="0 0 0", rpy="0 0 0", axis="0 1 0", more=""):
    return f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>' \
           f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>{more}</joint>\n'


LIMITS = '<limit lower="-1" upper="1" effort="10"/>'
BASE = '<link name="world"/>\n'
PENDULUM = BASE + link("upper", 1.2, "0.2 0.01 0", "0.1 0.2 0.3") + link("lower", 0.8, "0.15 0 0.02") \
    + joint("shoulder", "continuous", "world", "upper", "0 0 0.5", "0 0 0.4", "0 1 0.2") \
    + joint("elbow", "continuous", "upper", "lower", "0.4 0 0", "0.3 0 0")
# Crank, coupler and rocker of a four-bar linkage in the x-z plane: 0.1, 0.3, 0.25 m, with 0.3 m between its feet.
FOUR_BAR = BASE + link("crank", 0.3, "0.05 0 0", moments=(1e-4, 1e-3, 1e-3)) \
    + link("coupler", 0.9, "0.15 0 0") + link("rocker", 0.7, "0.125 0 0") \
    + joint("a", "continuous", "world", "crank") + joint("b", "continuous", "crank", "coupler", "0.1 0 0") \
    + joint("c", "continuous", "coupler", "rocker", "0.3 0 0")


def four_bar_start():
    """Angles about y from x of crank, coupler and rocker, which end at the second foot, for a crank that points up."""
    foot, crank = np.array([0.3, 0.0]), np.array([0.0, 0.1])
    apart = np.linalg.norm(foot - crank)
    along = (0.3**2 - 0.25**2 + apart**2) / (2 * apart)
    across = np.sqrt(0.3**2 - along**2)
    step = (foot - crank) / apart
    knee = crank + along * step + across * np.array([-step[1], step[0]])

    def turn(vector):
        return -np.arctan2(vector[1], vector[0])

    return turn(crank), turn(knee - crank), turn(foot - knee)


class UrdfTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="scree_urdf_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def file(self, text, name="robot.urdf"):
        path = self.folder / name
        path.write_text(f'<?xml version="1.0"?>\n<robot name="arm">\n{text}</robot>\n')
        return path

    def deck(self, text, **options):
        """As the program checks it."""
        with warnings.catch_warnings():
            warnings.simplefilter("error", scree.ScreeWarning)
            deck = to_deck(self.file(text), Options(**options))
        deck.check(PROGRAM)
        return deck

    def refused(self, text, said, **options):
        with self.assertRaisesRegex(scree.ScreeError, said):
            to_deck(self.file(text), Options(**options))

    def motion(self, deck, bodies, name):
        deck["time"] = {"end": 0.5, "step": 1e-3, "control": "fixed"}
        history = deck.run(self.folder / name, quiet=True, scree=PROGRAM).history
        return np.array([history[f"bodies/{body}/{axis}"] for body in bodies for axis in "xyz"])


class FramesTest(unittest.TestCase):
    def test_rotations(self):
        np.testing.assert_allclose(of_roll_pitch_yaw(0.3, 0, 0) @ [0, 1, 0], [0, np.cos(0.3), np.sin(0.3)])
        np.testing.assert_allclose(of_roll_pitch_yaw(0, 0, np.pi / 2) @ of_roll_pitch_yaw(0, 0.2, 0),
                                   of_roll_pitch_yaw(0, 0.2, np.pi / 2), atol=1e-15)
        axis = np.array([1.0, -2.0, 0.5]) / np.sqrt(5.25)
        for angle in (0.0, 1e-9, 2.0, 3.1):
            w, *v = quaternion_of(about(axis, angle))
            np.testing.assert_allclose([abs(w), *np.abs(v)], np.abs([np.cos(angle / 2), *(np.sin(angle / 2) * axis)]),
                                       atol=1e-15)
        np.testing.assert_allclose(to_z(axis)[:, 2], axis)
        np.testing.assert_allclose(to_z(axis).T @ to_z(axis), np.eye(3), atol=1e-15)
        self.assertEqual(Pose.at([1, 0, 0]).keys("offset"), {"offset": [1, 0, 0]})


class MotionTest(UrdfTest):
    def test_a_double_pendulum_moves_as_one_written_by_hand(self):
        bodies = ("upper", "lower")
        robot = self.deck(PENDULUM, positions={"elbow": 0.5})
        upper = Pose.at([0, 0, 0.5], of_roll_pitch_yaw(0, 0, 0.4))
        hinge = upper @ Pose.at([0.4, 0, 0], of_roll_pitch_yaw(0.3, 0, 0))
        lower = hinge @ Pose.at(rotation=about([0, 1, 0], 0.5))
        hand = scree.Deck(gravity=[0, 0, -9.80665], space={"dimension": 3, "min": [-2] * 3, "max": [2] * 3})
        hand["output"] = {"history_interval": 0.01, "history_bodies": list(bodies)}
        tensor = np.diag([0.01, 0.02, 0.02])
        for name, pose, mass, center, turn in (
                ("upper", upper, 1.2, [0.2, 0.01, 0], of_roll_pitch_yaw(0.1, 0.2, 0.3)),
                ("lower", lower, 0.8, [0.15, 0, 0.02], np.eye(3))):
            axes = pose.rotation @ turn  # the body's frame: its centre of mass and the axes of its inertia
            hand.add("bodies", name=name, kind="spatial", mass=mass, inertia_tensor=[*np.diag(tensor), 0, 0, 0],
                     position=pose.transform(center), quaternion=quaternion_of(axes))
        hand.add("joints", name="shoulder", type="revolute", bodies=["ground", "upper"], point=upper.origin,
                 axis=upper.rotation @ [0, 1, 0.2])
        hand.add("joints", name="elbow", type="revolute", bodies=["upper", "lower"], point=hinge.origin,
                 axis=hinge.rotation @ [0, 1, 0])
        found, wanted = self.motion(robot, bodies, "robot"), self.motion(hand, bodies, "hand")
        np.testing.assert_allclose(found, wanted, atol=ROUND_OFF)
        self.assertGreater(np.ptp(found, axis=1).max(), 0.3)  # it does move

    def test_a_four_bar_linkage_is_closed_in_the_deck(self):
        bodies = ("crank", "coupler", "rocker")
        turns = four_bar_start()
        robot = self.deck(FOUR_BAR, positions=dict(zip("abc", np.diff([0.0, *turns]))))
        robot.add("markers", name="foot", body="ground", local_point=[0.3, 0, 0], z_axis=[0, 1, 0])
        robot.add("markers", name="end", body="rocker", local_point=[0.25, 0, 0])
        robot.add("joints", name="loop", type="point-on-line", markers=["foot", "end"])
        hand = scree.Deck(gravity=[0.0, -9.80665], space={"dimension": 2, "min": [-2, -2], "max": [2, 2]})
        hand["output"] = {"history_interval": 0.01, "history_bodies": list(bodies)}
        place, before = np.zeros(2), "ground"
        masses, inertias = (0.3, 0.9, 0.7), (1e-3, 0.02, 0.02)
        for name, turn, length, mass, inertia in zip(bodies, turns, (0.1, 0.3, 0.25), masses, inertias):
            step = length * np.array([np.cos(turn), -np.sin(turn)])
            hand.add("bodies", name=name, mass=mass, inertia=inertia, position=place + step / 2, angle=-turn)
            hand.add("joints", name=f"before_{name}", type="revolute", bodies=[before, name], point=place)
            place, before = place + step, name
        hand.add("joints", name="foot", type="revolute", bodies=["ground", "rocker"], point=place)
        found, flat = self.motion(robot, bodies, "robot"), self.motion(hand, bodies, "hand")
        np.testing.assert_allclose(found[[0, 2, 3, 5, 6, 8]], flat[[0, 1, 3, 4, 6, 7]], atol=ROUND_OFF)
        self.assertGreater(np.ptp(found, axis=1).max(), 0.05)


class DeckTest(UrdfTest):
    def test_joints_with_all_that_they_have(self):
        dynamics = '<dynamics damping="0.2" friction="0.5"/>'
        mimic = '<mimic joint="turn" multiplier="-2" offset="0.1"/>'
        deck = self.deck(BASE + link("a") + link("b") + link("c") + link("d") + link("e")
                         + joint("turn", "revolute", "world", "a", "0 0 1", more=LIMITS + dynamics)
                         + joint("slide", "prismatic", "a", "b", "1 0 0", axis="1 0 0", more=LIMITS)
                         + joint("follow", "continuous", "a", "c", more=mimic)
                         + joint("lie", "planar", "world", "d", axis="0 0 1") + joint("fly", "floating", "world", "e"),
                         positions={"slide": 0.25, "turn": 0.1}, stop_stiffness=1e4)
        self.assertEqual([(each["name"], each["type"]) for each in deck["joints"]],
                         [("turn", "revolute"), ("lie", "planar"), ("slide", "translational"), ("follow", "revolute")])
        self.assertEqual(deck["joint_springs.turn_damping.damping"], 0.2)
        self.assertEqual(deck["joint_frictions.turn_friction.effort"], 0.5)
        stop = [deck[f"joint_limits.slide_stop.{key}"] for key in ("lower", "upper", "stiffness")]
        self.assertEqual(stop, [-1, 1, 1e4])
        self.assertEqual(deck["couplers.follow_mimic.coefficients"], [1, 2])
        history = deck.run(self.folder / "out", "--set", "time.end=0.01", quiet=True, scree=PROGRAM).history
        for name, start in (("turn/angle", 0.1), ("slide/displacement", 0.25), ("follow/angle", -0.1)):
            np.testing.assert_allclose(history[f"coordinates/{name}"][0], start, atol=1e-12, err_msg=name)

    def test_links_without_mass_are_parts_of_others(self):
        text = '<link name="root"/><link name="flange"/>' + link("arm", 2.0, "0.5 0 0") + link("tool", 1.0, "0 0 0.1") \
            + joint("hold", "fixed", "root", "arm") + joint("mount", "fixed", "arm", "flange", "1 0 0", "0 0 1.57") \
            + joint("screws", "fixed", "flange", "tool", "0 0 0.2")
        deck = self.deck(text)
        self.assertEqual([each["name"] for each in deck["bodies"]], ["arm", "tool"])
        self.assertEqual(deck["joints.screws.markers"], ["screws_parent", "screws_child"])
        self.assertEqual(deck["joints.hold.type"], "fixed")
        free = self.deck(text, free=True)
        self.assertEqual([each["name"] for each in free["joints"]], ["screws"])

    def test_masses_of_links_that_move_as_one(self):
        text = '<link name="root"/>' + link("a", 2.0, "0.1 0 0") + joint("j", "fixed", "root", "a")
        deck = self.deck(text, free=True, xyz=(1.0, 2.0, 3.0), rpy=(0.0, 0.0, np.pi / 2))
        self.assertEqual(deck["bodies.a.center_of_mass"], [0.1, 0, 0])
        self.assertEqual(deck["bodies.a.position"], [1, 2, 3])
        np.testing.assert_allclose(deck["bodies.a.quaternion"], [np.sqrt(0.5), 0, 0, np.sqrt(0.5)], atol=1e-15)
        robot = read(self.file(link("a", 2.0, "0.1 0 0") + link("b", 1.0, rpy="0 0 1.5707963267948966")))
        mass, center, inertia = Part("a", Pose.at(), [(robot.links["a"], Pose.at()),
                                                      (robot.links["b"], Pose.at([1.3, 0, 0]))]).mass_properties()
        np.testing.assert_allclose((mass, *center), (3.0, 0.5, 0, 0), atol=1e-15)
        apart = 2.0 * 0.4**2 + 1.0 * 0.8**2
        np.testing.assert_allclose(inertia, np.diag([0.03, 0.03 + apart, 0.04 + apart]), atol=1e-15)

    def test_geometry(self):
        pyvista.Cube().triangulate().save(self.folder / "cube.stl")
        pyvista.Plane(i_resolution=1, j_resolution=1).triangulate().save(self.folder / "open.ply")
        (self.folder / "meshes").mkdir()
        (self.folder / "cube.stl").rename(self.folder / "meshes/cube.stl")

        def shape(text, xyz="0 0 0", kind="collision"):
            return f'<{kind}><origin xyz="{xyz}"/><geometry>{text}</geometry></{kind}>'

        parts = shape('<sphere radius="0.1"/>', "0.5 0 0") + shape('<box size="0.1 0.2 0.3"/>') \
            + shape('<mesh filename="package://arm/meshes/cube.stl" scale="0.001 0.001 0.001"/>') \
            + shape('<mesh filename="open.ply"/>') + shape('<cylinder radius="0.1" length="1"/>', kind="visual")
        stand = f'<link name="stand">{shape("""<box size="1 1 0.1"/>""", "0 0 -1")}</link>\n'
        text = stand + link("arm", more=parts) + joint("j", "continuous", "stand", "arm")
        deck = self.deck(text, packages={"arm": str(self.folder)})
        self.assertEqual([mesh["kind"] for mesh in deck["meshes"]], ["box", "box", "file", "file"])
        self.assertEqual((deck["meshes.arm_2.scale"], deck["meshes.arm_2.file"]), (0.001, "meshes/cube.stl"))
        self.assertEqual(([mesh.get("sheet", False) for mesh in deck["meshes"]]), [False, False, False, True])
        self.assertEqual(deck["walls.stand"].unwrap(), {"name": "stand", "mesh": "stand", "material": "robot"})
        self.assertEqual(deck["bodies.arm.shapes"], [{"radius": 0.1, "offset": [0.5, 0, 0], "material": "robot"}])
        self.assertEqual(len(deck["bodies.arm.meshes"]), 3)
        self.assertEqual([mesh["kind"] for mesh in self.deck(text, geometry="visual")["meshes"]], ["cylinder"])
        self.assertNotIn("meshes", self.deck(text, geometry="none"))

    def test_what_stands_as_comments_is_a_deck_too(self):
        text = str(self.deck(PENDULUM))
        tail = text[text.index("\n# A joint that closes"):]
        deck = scree.Deck.parse(text + re.sub(r"^# (?=\[|\w+ = )", "", tail, flags=re.M))
        del deck["joints.loop"]  # these markers do not meet
        deck.check(PROGRAM)
        self.assertEqual((len(deck["particles"]), len(deck["motors"])), (1, 1))


class CommandTest(UrdfTest):
    def command(self, code, *words):
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            self.assertEqual(main(["urdf", *map(str, words)]), code, said.getvalue())
        return said.getvalue()

    def test_what_it_writes_and_says(self):
        mesh = '<collision><geometry><mesh filename="x.dae"/></geometry></collision>'
        (self.folder / "x.dae").write_text("")
        limit = '<limit lower="0.5" upper="1" effort="0" velocity="1"/>'
        path = self.file(BASE + link("arm", more=mesh) + joint("j", "revolute", "world", "arm", more=limit)
                         + "<transmission/>")
        said = self.command(0, path, "--position", "j=0.2", "-o", self.folder / "other.toml")
        for text in ("not read: <transmission>", "not STL, OBJ or PLY, left out", "x.dae (line 4)",
                     "starts outside its limits", "joint j (line 5) at 0.2, with limits from 0.5 to 1",
                     "without an effort, which determines the stiffness",
                     "limits of velocity are left out, because a deck has none: joint j (line 5)"):
            self.assertIn(text, said)
        subprocess.run([PROGRAM, "check", self.folder / "other.toml"], check=True, stdout=subprocess.DEVNULL)
        self.assertIn("exists already", self.command(2, path, "-o", self.folder / "other.toml"))
        self.command(0, path, "-o", self.folder / "other.toml", "--overwrite")
        self.assertIn("error: j: must have the form NAME=VALUE", self.command(2, path, "--position", "j"))

    def test_what_is_refused(self):
        moving = joint("j", "continuous", "world", "a")
        lost, unknown = (f'<visual><geometry><mesh filename="{name}"/></geometry></visual>'
                         for name in ("n.stl", "package://p/n.stl"))
        for text, said in (
                (BASE + link("a", moments=(0.01, 0.02, 0.09)) + moving, r'urdf:4: link "a": inertia: principal moment'),
                (BASE + link("a", mass=-1) + moving, "mass = -1: must not be below 0"),
                (BASE + '<link name="a"/>' + moving, 'link "a": moves, but neither'),
                (BASE + link("a"), 'several links have no parent: "world", "a"'),
                (BASE + link("a") + moving + joint("k", "fixed", "world", "a"), 'joint "k": closes a loop: link "a"'),
                (BASE + link("a") + link("b") + joint("j", "fixed", "a", "b") + joint("k", "fixed", "b", "a"),
                 "form a circle: a <- b <- a"),
                (BASE + joint("j", "fixed", "world", "b"), 'joint "j": there is no link "b"'),
                (BASE + link("a") + joint("j", "hinge", "world", "a"), 'type = "hinge": must be one of revolute'),
                (BASE + link("a") + joint("j", "continuous", "world", "a", "0 0"), 'xyz = "0 0": must be 3 numbers'),
                (BASE + link("a") + joint("j", "continuous", "world", "a", axis="0 0 0"), "has no direction"),
                (BASE + link("a") + joint("j", "continuous", "world", "a", more='<mimic joint="x"/>'), 'mimics "x"'),
                (BASE + link("a") + link("a"), "a second link of this name"),
                (BASE + link("a", more=lost) + moving, "n.stl: no such file"),
                (BASE + link("a", more=unknown) + moving, "--package p=FOLDER"),
                ('<xacro:include filename="x"/>', "expand them first"), (BASE + link("${name}"), "expand them first"),
                ("<link", "no XML"), ("", "has no links")):
            self.refused(text, said, geometry="visual")
        self.refused(PENDULUM, "no joint wrist with a coordinate; there are: shoulder, elbow", positions={"wrist": 1})
        path = self.folder / "entities.urdf"
        path.write_text('<!DOCTYPE robot [<!ENTITY a "b">]>\n<robot name="&a;"/>\n')
        self.assertIn("entities.urdf:1: has a document type", self.command(2, path))
        self.assertIn("cannot be read: No such file", self.command(2, self.folder / "none.urdf"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
