"""Robots as one finds them: what is odd in them, and that `scree check` takes each deck that is made of them.

    SCREE=build/release/scree python3 tests/postprocess/test_urdf_kinds.py

Needs postprocess/requirements.txt."""

import contextlib
import io
import itertools
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

import scree
from scree.cli import main
from scree.urdf import inertia, surface

PROGRAM = os.environ["SCREE"]
FIXED_LIMIT = '<limit lower="0.5" upper="0.5" effort="10" velocity="1"/>'


def link(name, shape="", mass=1.0, moments="0.01 0.02 0.02", kind="collision"):
    xx, yy, zz = moments.split()
    body = f'<inertial><origin xyz="0.1 0 0"/><mass value="{mass}"/>' \
           f'<inertia ixx="{xx}" iyy="{yy}" izz="{zz}" ixy="0" ixz="0" iyz="0"/></inertial>' if mass else ""
    geometry = f"<{kind}><geometry>{shape}</geometry></{kind}>" if shape else ""
    return f'<link name="{name}">{body}{geometry}</link>\n'


def joint(name, parent, child, kind="revolute", axis="0 1 0", more='<limit lower="-1" upper="1" effort="10"/>'):
    return f'<joint name="{name}" type="{kind}"><origin xyz="0.5 0 0"/><parent link="{parent}"/>' \
           f'<child link="{child}"/><axis xyz="{axis}"/>{more}</joint>\n'


def box(center=(0.0, 0.0, 0.0), half=0.1):
    """Triangles of a cube, wound outward: [12][3][3]."""
    low, high = (np.array(center) + sign * half for sign in (-1, 1))
    found = []
    for axis, end in itertools.product(range(3), (0, 1)):
        corners = []
        for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
            place = np.empty(3)
            place[axis], place[(axis + 1) % 3], place[(axis + 2) % 3] = \
                ((low, high)[each][k] for each, k in ((end, axis), (u, (axis + 1) % 3), (v, (axis + 2) % 3)))
            corners.append(place)
        corners = corners if end else corners[::-1]
        found += [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]]
    return np.array(found)


def turned(triangles):
    return triangles[:, ::-1]


def with_corner_twice(triangles):
    return np.concatenate([triangles, triangles[:1, [0, 1, 1]]])


def with_sliver(triangles):
    """A third corner in the middle of an edge of the first triangle, which a sliver closes again."""
    a, b, c = triangles[0]
    middle = (a + b) / 2
    return np.concatenate([[[a, middle, c], [middle, b, c], [a, b, middle]], triangles[1:]])


CUBE = box()
SHEETS = {"rib": np.concatenate([CUBE, box(half=0.05)]), "crossing": np.concatenate([CUBE, box((0.15, 0, 0))]),
          "turned": turned(CUBE), "void": np.concatenate([CUBE, turned(box((1, 0, 0)))])}
FAULTY = {"corner": with_corner_twice(CUBE), "sliver": with_sliver(CUBE),
              "twice": np.concatenate([CUBE, CUBE[:2]]), "twice_turned": np.concatenate([CUBE, turned(CUBE[:1])]),
          "anyhow": np.concatenate([turned(CUBE[:3]), CUBE[3:]])}
SOLIDS = {"cube": CUBE, "apart": np.concatenate([CUBE, box((1, 0, 0))]),
          "cavity": np.concatenate([CUBE, turned(box(half=0.05))])}


class KindsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="scree_urdf_kinds_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def stl(self, name, triangles):
        facets = "".join("facet normal 0 0 0\nouter loop\n"
                         + "".join(f"vertex {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in corners)
                         + "endloop\nendfacet\n" for corners in triangles)
        (self.folder / f"{name}.stl").write_text(f"solid {name}\n{facets}endsolid {name}\n")
        return f'<mesh filename="{name}.stl"/>'

    def convert(self, text, *words, code=0):
        """The deck that the command writes and `scree check` takes, and the lines of warnings."""
        path, deck = self.folder / "robot.urdf", self.folder / "robot.toml"
        path.write_text(f'<?xml version="1.0"?>\n<robot name="arm">\n{text}</robot>\n', encoding="utf-8")
        said = io.StringIO()
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(said):
            self.assertEqual(main(["urdf", str(path), "-o", str(deck), "--overwrite", *words]), code, said.getvalue())
        lines = said.getvalue().splitlines()
        if code != 0:
            return None, lines
        checked = subprocess.run([PROGRAM, "check", deck], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertEqual(checked.returncode, 0, checked.stderr)
        return scree.Deck.read(deck), lines

    def one_line(self, lines, *parts):
        found = [line for line in lines if parts[0] in line]
        self.assertEqual(len(found), 1, lines)
        for part in parts:
            self.assertIn(part, found[0])


class JointTest(KindsTest):
    def test_joints_without_an_axis(self):
        deck, lines = self.convert(link("base") + link("arm") + link("tool") + link("drone") + joint("j", "base", "arm")
                                   + joint("flange", "arm", "tool", "fixed", axis="0 0 0", more="")
                                   + joint("sky", "base", "drone", "floating", axis="0 0 0", more=""))
        self.assertEqual(deck["joints.flange.type"], "fixed")
        self.assertEqual(lines, [])
        self.convert(link("base") + link("arm") + joint("j", "base", "arm", axis="0 0 0"), code=2)

    def test_limits_without_a_range(self):
        limits = {"none": "", "efforts": '<limit effort="10" velocity="1"/>', "blank": '<limit lower="" upper=""/>',
                  "turned": '<limit lower="1" upper="-1" effort="10"/>',
                  "infinite": '<limit lower="-inf" upper="inf" effort="10"/>',
                  "half": '<limit lower="-1" upper="inf" effort="10"/>', "upper": '<limit upper="1" effort="10"/>'}
        text = link("base")
        for k, (name, limit) in enumerate(limits.items()):
            kind = ("revolute", "prismatic")[k % 2]
            text += link(f"{name}_arm") + joint(name, "base", f"{name}_arm", kind, more=limit)
        deck, lines = self.convert(text)
        self.assertEqual([(stop["joint"], stop.get("lower"), stop.get("upper")) for stop in deck["joint_limits"]],
                         [("half", -1.0, None), ("upper", 0.0, 1.0)])
        self.one_line(lines, "limits without lower and upper: no stops (3 times)",
                      "joint none (line ")
        self.one_line(lines, "the lower limit is above the upper one", "joint turned")

    def test_there_is_room_for_joints_that_start_far_out(self):
        text = link("base") + link("arm", '<sphere radius="0.1"/>') + joint("j", "base", "arm", "prismatic", more="")
        deck, _ = self.convert(text, "--position", "j=7")
        self.assertGreater(deck["space.max"][1], 7.1)

    def test_lower_as_upper_is_held_there(self):
        text = link("base") + link("arm") + link("wrist") + link("finger") + link("thumb") \
            + joint("hinge", "base", "arm", more=FIXED_LIMIT) \
            + joint("follow", "arm", "wrist", more='<mimic joint="hinge" multiplier="2" offset="0.1"/>') \
            + joint("again", "wrist", "finger", "prismatic", more='<mimic joint="follow"/>') \
            + joint("turn", "finger", "thumb", "continuous", more="")
        deck, lines = self.convert(text)
        self.assertEqual([each["type"] for each in deck["joints"]], ["fixed"] * 4 + ["revolute"])
        self.assertNotIn("joint_limits", deck)
        np.testing.assert_allclose(deck["bodies.arm.quaternion"], [np.cos(0.25), 0, np.sin(0.25), 0], atol=1e-15)
        np.testing.assert_allclose(deck["bodies.wrist.quaternion"], [np.cos(0.8), 0, np.sin(0.8), 0], atol=1e-15)
        ends = [np.array(deck[f"bodies.{name}.position"]) for name in ("wrist", "finger")]
        np.testing.assert_allclose(np.linalg.norm(ends[1] - ends[0]), np.hypot(0.5, 1.1))  # slid by 1.1 along y
        self.one_line(lines, "made a fixed joint: lower = upper", "joint hinge (line ", "at 0.5")
        self.one_line(lines, "mimics a joint that does not move (2 times)", "joint again (line ")
        moving = link("base") + link("a") + link("b") + joint("j", "base", "a") \
            + joint("k", "a", "b", more='<limit lower="0" upper="0"/><mimic joint="j"/>')
        deck, _ = self.convert(moving)
        self.assertEqual([each["type"] for each in deck["joints"]], ["fixed", "revolute", "revolute"])

    def test_names_that_a_deck_has_not(self):
        names = ["ground", "arm/upper", "arm_upper", "..", "a" * 250, "b" * 199, 'quo"ted \\ *', "é" * 150, "arm.0"]
        text = link("world", "<box size='1 1 1'/>")
        for name in names:
            quoted = name.replace('"', "&quot;")
            more = '<limit lower="-1" upper="1" effort="1"/><dynamics damping="1" friction="1"/>'
            text += link(quoted, '<box size="0.1 0.1 0.1"/>') + joint(quoted, "world", quoted, more=more)
        text += link("last") + joint("base", "ground", "last", more='<mimic joint="arm/upper"/>')
        deck, lines = self.convert(text, "--position", "arm/upper=0.3")
        found = [body["name"] for body in deck["bodies"]]
        self.assertEqual(len(set(found)), len(names) + 2)
        for name in ("ground_link", "arm_upper", "arm_upper_2", "___link", 'quo"ted \\ *', "arm.0", "last"):
            self.assertIn(name, found)
        self.assertEqual(deck["couplers.base_mimic.joints"], ["base", "arm_upper_2"])
        self.assertEqual([each["name"] for each in deck["joints"]][:1], ["base_2"])
        np.testing.assert_allclose(deck["bodies.arm_upper_2.quaternion"], [np.cos(0.15), 0, np.sin(0.15), 0],
                                   atol=1e-15)
        self.one_line(lines, "renamed", "link ground", 'is "ground_link"', "and 2 more")

    def test_one_line_for_each_kind(self):
        text = link("link_0")
        for k in range(67):
            text += link(f"link_{k + 1}", '<mesh filename="x.dae"/>') + joint(
                f"joint_{k}", f"link_{k}", f"link_{k + 1}", more='<limit effort="1" velocity="1"/>')
        lines = self.convert(text)[1]
        self.assertEqual(len(lines), 3)
        for line in lines:
            self.assertIn("(67 times): ", line)
            self.assertTrue(line.endswith(" and 57 more"), line)


class InertiaTest(KindsTest):
    IMPOSSIBLE = "1 2 3.1"

    def test_what_stands_on_the_ground(self):
        for moments in (self.IMPOSSIBLE, "0 0 0", "-1 1 1", "0 1 1"):
            text = link("base", moments=moments) + link("plate", moments=moments) + link("arm") \
                + joint("screws", "base", "plate", "fixed") + joint("j", "plate", "arm")
            _, lines = self.convert(text)
            self.one_line(lines, "impossible inertia was replaced by the nearest possible one: it is fixed to the "
                                 "ground", "(2 times)", "link base (line 3)", "link plate (line 4)")
            _, lines = self.convert(text, "--free", code=2)
            self.one_line(lines, "error: ", 'robot.urdf:3: link "base": inertia: principal moments', "--mend-inertia")

    def test_what_moves(self):
        for moments in (self.IMPOSSIBLE, "0 0 0", "-1 1 1", "0 1 1", "1e-9 1e-9 1"):
            text = link("base") + link("arm", moments=moments) + joint("j", "base", "arm")
            self.one_line(self.convert(text, code=2)[1], 'link "arm": inertia', "--mend-inertia takes the nearest")
            _, lines = self.convert(text, "--mend-inertia")
            self.one_line(lines, "as requested by --mend-inertia", "link arm (line 4)", "now ")
        text = '<link name="arm"><inertial><mass value="1"/></inertial></link>' + link("base") \
            + joint("j", "base", "arm")
        self.convert(text, code=2)
        self.convert(text, "--mend-inertia")
        self.convert('<link name="base"><inertial><origin xyz="1 0 0"/></inertial></link>' + link("arm")
                     + joint("j", "base", "arm"))

    def test_the_nearest(self):
        np.testing.assert_allclose(np.diag(inertia.nearest(np.diag([1, 2, 3.1]), 1.0, 0.0)), [1.05, 2.05, 3.1])
        possible = np.array([[2.0, 0.3, 0.1], [0.3, 1.8, 0.2], [0.1, 0.2, 1.5]])
        np.testing.assert_allclose(inertia.nearest(possible, 1.0), possible)
        radius = (3 / (4e3 * np.pi)) ** (1 / 3)  # of 1 kg of water
        np.testing.assert_allclose(inertia.nearest(np.zeros((3, 3)), 1.0), 0.4 * radius**2 * np.eye(3), atol=1e-16)
        rounded = np.diag([0.123456, 0.234567, 0.358023 + 3e-7])  # a plate's, in six digits
        self.assertGreater(inertia.excess(rounded), 0)
        self.assertLess(inertia.excess(inertia.without_rounding(rounded, 1.0)), 0)
        np.testing.assert_allclose(inertia.without_rounding(rounded, 1.0), rounded, rtol=1e-5, atol=1e-12)


class GeometryTest(KindsTest):
    def robot(self, *shapes):
        """A base, and an arm for each shape."""
        return link("base") + "".join(link(f"arm_{k}", shape) + joint(f"j_{k}", "base", f"arm_{k}")
                                      for k, shape in enumerate(shapes))

    def test_shapes(self):
        deck, lines = self.convert(self.robot(
            '<capsule radius="0.05" length="0.9"/>', '<capsule radius="0.05" length="0"/>',
            '<cylinder radius="1" length="0"/>', '<box size="1 0 1"/>', '<plane normal="0 0 1"/>', "",
            '<sphere radius="0.1"/>', '<sphere radius="-1"/>'))
        self.assertEqual([each.unwrap() for each in deck["meshes"]],
                         [{"name": "arm_0", "kind": "capsule", "radius": 0.05, "length": 0.9}])
        self.assertEqual([deck[f"bodies.arm_{k}.shapes"][0]["radius"] for k in (1, 6)], [0.05, 0.1])
        self.one_line(lines, "a dimension is not above 0, left out (3 times)", "cylinder (line ", "box (line ",
                      "sphere (line ")
        self.one_line(lines, "neither box, cylinder, capsule, sphere nor mesh", "plane (line ")
        self.convert(link("base").replace("</link>", "<collision/></link>"))

    def test_none_looks_at_none(self):
        for shape in ('<plane/>', '<box size="wide"/>', '<mesh filename="gone.stl"/>', '<mesh/>',
                      '<sphere radius="-1"/>', '<mesh filename="package://gone/x.dae" scale="0 0 0"/>',
                      '<capsule radius="x"/>'):
            deck, lines = self.convert(self.robot(shape), "--geometry", "none")
            self.assertEqual(lines, [])
            self.assertNotIn("meshes", deck)

    def test_mirrored_and_stretched_meshes(self):
        mesh = self.stl("cube", box((0.3, 0.2, 0.1)))
        scales = ("1 -1 1", "-0.001 0.001 0.001", "-1 -1 -1", "1 2 3", "0.001 0.001 0.001", "-1 -1 1")
        deck, lines = self.convert(self.robot(*(mesh.replace("/>", f' scale="{scale}"/>') for scale in scales)))
        self.assertEqual(lines, [])
        self.assertEqual([(each.get("scale"), each.get("stretch")) for each in deck["meshes"]],
                         [(None, [1, -1, 1]), (0.001, [-1, 1, 1]), (None, [-1, -1, -1]), (None, [1, 2, 3]),
                          (0.001, None), (None, [-1, -1, 1])])
        self.assertFalse(any("sheet" in each for each in deck["meshes"]))

    def test_meshes_as_they_are(self):
        for name, triangles in SOLIDS.items():
            deck, lines = self.convert(self.robot(self.stl(name, triangles)))
            self.assertEqual((lines, "sheet" in deck["meshes"][0]), ([], False), name)
        shapes = [self.stl(name, triangles) for name, triangles in SHEETS.items()]
        deck, lines = self.convert(self.robot(*shapes))
        self.assertEqual([each["sheet"] for each in deck["meshes"]], [True] * len(SHEETS))
        self.assertEqual(len(lines), 1)
        self.one_line(lines, "imported as an open surface (sheet) with contact on both sides, because it does not "
                             f"bound a solid ({len(SHEETS)} times)", "rib.stl (line 4) has parts inside others",
                      "turned.stl (line 8) is inside out")
        deck, lines = self.convert(self.robot(self.stl("open", CUBE[:7])))
        self.assertEqual((lines, deck["meshes.arm_0.sheet"]), ([], True))

    def test_triangles_without_area_twice_and_wound_anyhow(self):
        for name, triangles in FAULTY.items():
            fault = {"corner": "without area", "sliver": "without area", "anyhow": "that are wound both ways"}
            deck, lines = self.convert(self.robot(self.stl(name, triangles)))
            self.one_line(lines, "imported as an open surface",
                          f"{name}.stl (line 4) has triangles {fault.get(name, 'twice')}")
            self.assertEqual((len(lines), deck["meshes.arm_0.sheet"]), (1, True))

    def test_files_that_are_no_meshes(self):
        (self.folder / "lfs.stl").write_text("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 12\n")
        (self.folder / "empty.stl").write_text("solid\nendsolid\n")
        (self.folder / "text.ply").write_text("a letter\n")
        (self.folder / "bytes.stl").write_bytes(bytes(range(256)))
        names = ("lfs.stl", "empty.stl", "text.ply", "bytes.stl", "gone.dae")
        deck, lines = self.convert(self.robot(*(f'<mesh filename="{name}"/>' for name in names)))
        self.assertNotIn("meshes", deck)
        self.one_line(lines, "unreadable mesh, left out", "(4 times)",
                      "lfs.stl (line 4) is a Git LFS pointer: git lfs pull")
        self.one_line(lines, "not STL, OBJ or PLY", "gone.dae (line 12)")
        self.convert(self.robot('<mesh filename="gone.stl"/>'), code=2)
        (self.folder / "sub").mkdir()
        self.stl("sub/cube", CUBE)
        self.assertIn("meshes", self.convert(self.robot(r'<mesh filename="sub\cube.stl"/>'))[0])

    def test_what_only_the_program_finds(self):
        line = np.array([[[0, 0, 0], [k, 0, 0], [k + 1, 0, 0]] for k in range(1, 4)])
        shapes = [self.stl("cube", CUBE), self.stl("rib", SHEETS["rib"]), self.stl("line", line)]
        with mock.patch.object(surface, "find_defect", return_value=(False, "")):
            surface.read.cache_clear()
            deck, lines = self.convert(self.robot(*shapes))
        surface.read.cache_clear()
        wanted = [("arm_0", False), ("arm_1", True)]
        self.assertEqual([(each["name"], "sheet" in each) for each in deck["meshes"]], wanted)
        self.assertNotIn("meshes", deck["bodies.arm_2"])
        self.one_line(lines, "imported as an open surface",
                      "rib.stl, by scree check: the mesh is no surface: a shell lies")
        self.one_line(lines, "refused by scree check, left out", "line.stl: the mesh is no surface")
        deck, lines = self.convert(self.robot(*shapes))
        self.assertEqual([(each["name"], "sheet" in each) for each in deck["meshes"]], wanted)
        with mock.patch("scree.program.find", return_value=None):
            self.one_line(self.convert(self.robot(shapes[0]))[1], "not checked, because the program scree is not found")


class MixtureTest(KindsTest):
    """Robots of links and joints drawn by chance from all that is odd."""

    def test_robots_of_all_kinds_together(self):
        meshes = {**SHEETS, **SOLIDS, **FAULTY}
        shapes = ["", '<box size="0.1 0.1 0.1"/>', '<capsule radius="0.05" length="0.1"/>', '<plane/>',
                  '<mesh filename="x.dae"/>', '<sphere radius="0.02"/>',
                  *(self.stl(name, triangles) for name, triangles in meshes.items())]
        limits = ["", FIXED_LIMIT, '<limit effort="5"/>', '<limit lower="0" upper="0"/>',
                  '<limit lower="1" upper="-1"/>', '<limit lower="0.2" upper="1" effort="-1"/>',
                  '<limit lower="-3" upper="3" effort="1e30"/>']
        for seed in range(12):
            draw = random.Random(seed)
            names = draw.sample(["ground", "a/b", "a_b", "..", "base", "arm.0", "left", "right", "c d", "x" * 300], 6)
            root = draw.choice(["0 0 0", "0.01 0.02 0.02"])
            text = link("world", draw.choice(shapes), mass=draw.choice([0, 1]), moments=root)
            for k, name in enumerate(names):
                scale = draw.choice(["", ' scale="1 -1 1"', ' scale="0.5 0.5 0.5"'])
                shape = draw.choice(shapes)
                shape = shape.replace("/>", f"{scale}/>") if shape.startswith("<mesh") else shape
                text += link(name, shape, moments=draw.choice(["0.01 0.02 0.02", "1 2 3.1"]))
                kind = draw.choice(["revolute", "prismatic", "continuous", "fixed", "fixed"])
                follow = f'<mimic joint="{names[0]}"/>' if k and draw.random() < 0.3 else ""
                axis = "0 0 0" if kind == "fixed" else "1 2 3"
                text += joint(name, draw.choice(["world", *names[:k]]), name, kind, axis, draw.choice(limits) + follow)
            with self.subTest(seed=seed):
                self.convert(text, "--mend-inertia", *draw.choice([[], ["--stop-stiffness", "1e4"]]))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
