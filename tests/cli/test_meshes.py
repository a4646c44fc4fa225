"""Bad decks of meshes, each with its message; what `scree check` says of good ones.
Usage: SCREE=path/to/scree python3 test_meshes.py"""

import json
import math
import re
import unittest

from test_cli import BAD_INPUT, DONE, IO_FAILED, CommandLineTest

DECK = """gravity = [0.0, 0.0, -9.8066]

[space]
dimension = 3
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]

[time]
end = 1e-3
step = 1e-4
control = "fixed"

[integrator]
particles = "velocity-verlet"

[[contact.pairs]]
stiffness = 1e5

[[meshes]]
name = "rock"
kind = "file"
file = "rock.stl"

[[walls]]
name = "rock"
mesh = "rock"

[[bodies]]
name = "shell"
kind = "spatial"
mass = 1.0
inertia_tensor = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]
position = [0.0, 0.0, 0.5]

[[particles]]
kind = "list"
positions = [[0.0, 0.0, 0.7]]
radius = 0.05
mass = 1.0
"""
CORNERS = [(x, y, z) for z in (0.0, 0.2) for y in (0.0, 0.2) for x in (0.0, 0.2)]
FACES = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6),
         (1, 3, 5), (3, 7, 5)]
TWO_RANKS = ("mpirun", "--oversubscribe", "-n", "2")


def stl(faces, corners=CORNERS):
    rows = "".join("facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {x} {y} {z}\n" for x, y, z in
                                                                (corners[c] for c in face)) +
                   "endloop\nendfacet\n" for face in faces)
    return f"solid rock\n{rows}endsolid rock\n"


def ball(radius, inwards=False, around=48, up=24):
    """A sphere about (0.5, 0, 0) as an STL of its facets."""
    def point(i, j):
        return (0.5 + radius * math.sin(math.pi * j / up) * math.cos(2 * math.pi * (i % around) / around),
                radius * math.sin(math.pi * j / up) * math.sin(2 * math.pi * (i % around) / around),
                radius * math.cos(math.pi * j / up) if 0 < j < up else radius * (1 - 2 * (j > 0)))
    places = {}
    corners = []

    def number(i, j):
        place = point(i if 0 < j < up else 0, j)
        key = tuple(round(x, 9) for x in place)
        if key not in places:
            places[key] = len(corners)
            corners.append(place)
        return places[key]
    faces = []
    for i in range(around):
        for j in range(up):
            a, b, c, d = number(i, j), number(i, j + 1), number(i + 1, j + 1), number(i + 1, j)
            faces += [face for face in ((a, b, c), (a, c, d)) if len(set(face)) == 3]
    return stl([face[::-1] for face in faces] if inwards else faces, corners)


def cup(radius, inside, around=48, up=12):
    """Half a hollow sphere about (0.5, 0, 0), in one piece."""
    def ring(r, j):
        angle = math.pi / 2 * (1 + j / up)
        return [(0.5 + r * math.sin(angle) * math.cos(2 * math.pi * i / around),
                 r * math.sin(angle) * math.sin(2 * math.pi * i / around), r * math.cos(angle)) for i in range(around)]
    rings = [ring(inside, j) for j in range(up - 1, -1, -1)] + [ring(radius, j) for j in range(up)]
    corners = [c for one in rings for c in one] + [(0.5, 0.0, -inside), (0.5, 0.0, -radius)]
    faces = []
    for k in range(len(rings) - 1):
        for i in range(around):
            a, b = k * around + i, k * around + (i + 1) % around
            faces += [(a, b + around, b), (a, a + around, b + around)]
    last = (len(rings) - 1) * around
    for i in range(around):
        faces += [(len(corners) - 2, i, (i + 1) % around), (len(corners) - 1, last + (i + 1) % around, last + i)]
    return stl(faces, corners)


class MeshTest(CommandLineTest):
    def setUp(self):
        super().setUp()
        self.deck = self.write("deck.toml", DECK)

    def refusal(self, *words, launcher=()):
        result = self.expect(BAD_INPUT, "check", self.deck, *words, launcher=launcher)
        message = result.stderr
        self.assertEqual(message.count("error: "), 1, message)
        return message

    def of_file(self, content, launcher=()):
        (self.folder / "rock.stl").write_bytes(content if isinstance(content, bytes) else content.encode())
        message = self.refusal(launcher=launcher)
        self.assertIn("meshes.rock.file", message)
        self.assertIn("rock.stl", message)
        return message


class BadDeckTest(MeshTest):
    def setUp(self):
        super().setUp()
        self.write("rock.stl", stl(FACES))

    def test_every_slip_is_named(self):
        box = '{name="rock",kind="box",size=[0.2,0.2,0.2]}'
        plate = '{name="rock",kind="rectangle",size=[0.2,0.2]}'
        drum = '{name="rock",kind="drum",radius=0.2,length=0.1,wall=0.02'
        screw = '{name="rock",kind="screw",radius=0.2,core_radius=0.05,length=0.4,pitch=0.1,thickness=0.02'
        body = 'bodies=[{name="b",kind="spatial",position=[0,0,0.5],%s}]'
        mass = "mass=1.0,inertia_tensor=[1,1,1,0,0,0]"
        attraction = 'contact.pairs=[{stiffness=1e5,attraction=1e-3,attraction_range=1e-3}]'
        works = 'output.surface_fields=["sliding_work","wear_depth"]'
        cases = [
            (['output.surface_fields=["slidng_work"]'], 'there is no field "slidng_work" of surfaces; did you mean'),
            (['output.surface_fields=["shear","shear"]'], '"shear" is repeated'),
            ([works, "walls=[]", "meshes=[]"],
             "only triangles have dissipation and wear, and no wall or body has a mesh"),
            ([works], "wear_depth needs a pair in contact.pairs with a wear_coefficient above 0"),
            (["contact.pairs.0.wear_coefficient=1e-12"], "wear_coefficient=1e-12: needs friction above 0"),
            (["contact.pairs.0.wear_coefficient=-1e-12"], "wear_coefficient must be a number from 0 to 1"),
            (["walls.rock.mesh=rocks"], "no mesh named \"rocks\""),
            (["walls.rock.normal=[0,0,1]"], "not used together with mesh"),
            ([body % (mass + ',meshes=[{mesh="sand"}]')], "no mesh named \"sand\""),
            ([body % (mass + ',meshes=[{mesh="rock"},{mesh="rock"}]')], "has this mesh already"),
            ([body % 'solids=[{kind="mesh",mesh="rock",density=1.0}]', f"meshes=[{plate}]"], "encloses no volume"),
            (["meshes=[{name=\"rock\",kind=\"line\",points=[[0,0,0],[1,0,0]]}]"], "needs space.dimension = 2"),
            ([f"meshes=[{box},{box}]"], "rock"),
            ([f"meshes=[{drum},lifters=4}}]"], "lifter_height: missing"),
            ([f"meshes=[{drum},lifters=40,lifter_height=0.02,lifter_width=0.05}}]"], "do not fit"),
            ([f"meshes=[{drum},lifter_width=0.05}}]"], "not used without lifters"),
            ([f"meshes=[{screw[:-4]}0.2}}]"], "must be less than the pitch"),
            ([f"meshes=[{screw},core_length=0.1}}]"], "core_length = 0.1: must be at least length"),
            (["meshes.rock.size=[1,1]"], "not used with kind = \"file\""),
            (["meshes.rock.scale=0"], "must be"),
            (["meshes.rock.feature_angle=2"], "must be"),
            (["meshes.rock.refine=1e-6"], "triangles"),
            ([attraction, "integrator.particles=hht"], 'needs integrator.particles = "velocity-verlet"'),
            (["meshes.rock.coarsen=0"], "meshes.rock.coarsen must be a number above 0"),
            (['meshes=[{name="rock",kind="sphere",radius=0.1,coarsen=0.01}]'], "not used with kind = \"sphere\""),
            (["particles.0.positions=[[0.1,0.1,0.1]]"], "particle 0 and wall \"rock\" overlap at t = 0 by 2 of"),
        ]
        for settings, text in cases:
            with self.subTest(settings=settings):
                self.assertIn(text, self.refusal(*(word for setting in settings for word in ("--set", setting))))

    def test_a_planar_deck_has_lines_alone(self):
        message = self.refusal("--set", "space={dimension=2,min=[-1,-1],max=[1,1]}", "--set", "gravity=[0,-10]",
                               "--set", "bodies=[]", "--set", "particles.0.positions=[[0,0.5]]")
        self.assertIn("must be \"line\", as space.dimension = 2", message)


class ReportTest(MeshTest):
    def setUp(self):
        super().setUp()
        self.write("rock.stl", stl(FACES))

    def report(self, *settings):
        result = self.expect(DONE, "check", self.deck, *(word for setting in settings for word in ("--set", setting)))
        return result.stdout, result.stderr

    def test_size_and_mass(self):
        body = ('bodies=[{name="b",kind="spatial",position=[0,0,-0.5],'
                'solids=[{kind="mesh",mesh="rock",density=1000.0}]}]')
        report, warnings = self.report(body, "meshes.rock.scale=0.5")
        self.assertIn('mesh           "rock": 12 triangles, 8 vertices, 1 shell, closed; '
                      '(0, 0, 0) to (0.1, 0.1, 0.1) m, area 0.06 m^2, volume 0.001 m^3, as a solid 1 kg', report)
        self.assertNotIn("warning", warnings)

    def test_snapshots_are_as_large_as_check_says(self):
        ball = 'meshes=[{name="rock",kind="sphere",radius=0.1,levels=5}]'
        twice = 'bodies.shell.meshes=[{mesh="rock"}]'
        for settings in ((ball,), (ball, twice)):
            said, unit = re.search(r"snapshots      2 of about \S+ \S+, (\S+) (kB|MB) together",
                                   self.report(*settings)[0]).groups()
            self.expect(DONE, "run", self.deck, "--output", self.folder / "out", "--overwrite",
                        *(word for setting in settings for word in ("--set", setting)))
            size = sum(path.stat().st_size for path in (self.folder / "out").glob("*.[vx][td]*")) / 1e6
            self.assertAlmostEqual(float(said) * {"kB": 1e-3, "MB": 1}[unit] / size, 1, delta=0.1)

    def test_a_file_made_coarser(self):
        self.write("rock.stl", ball(0.2))
        report, _ = self.report("meshes.rock.coarsen=0.005")
        coarser = re.search(r"simplified from (\d+) triangles, which are at most (\S+) m away", report)
        before, moved = coarser.groups()
        self.assertEqual(int(before), 48 * 2 * 23)
        self.assertLessEqual(float(moved), 0.005)
        count = int(re.search(r'"rock": (\d+) triangles', report)[1])
        self.assertLess(count, int(before) // 4)
        fine = int(re.search(r'"rock": (\d+) triangles', self.report("meshes.rock.coarsen=0.005",
                                                                    "meshes.rock.refine=0.02")[0])[1])
        self.assertGreater(fine, count)
        self.assertNotIn("simplified from", self.report()[0])
        # A wall of 5 mm: its sides come to cut through each other.
        self.write("rock.stl", ball(0.2) + ball(0.195, inwards=True))
        self.report("meshes.rock.coarsen=0.001")
        message = self.expect(BAD_INPUT, "check", self.deck, "--set", "meshes.rock.coarsen=0.05").stderr
        self.assertIn("meshes.rock.coarsen=0.05: is too large: it brings parts of the mesh together, which cut through "
                      "each other, first at (", message)
        fits = re.search(r"\); (\S+) keeps them apart", message)[1]
        self.report(f"meshes.rock.coarsen={fits}")
        # A shell of one piece: a tray with walls as thin; as a sheet, two layers that hang together.
        tray = cup(0.2, 0.195)
        self.write("rock.stl", tray)
        for settings in ((), ("meshes.rock.sheet=true",)):
            self.report("meshes.rock.coarsen=0.001", *settings)
            message = self.refusal("--set", "meshes.rock.coarsen=0.05", *(w for s in settings for w in ("--set", s)))
            self.assertIn("it brings parts of the mesh together", message)

    def test_warnings(self):
        for settings, text in [
                (["walls=[]"], 'mesh "rock": no wall, body or solid uses it'),
                (["meshes.rock.refine=0.005"], "of them, and each costs time: a larger refine"),
                (['meshes=[{name="rock",kind="pipe",radius=0.1,inner_radius=0.09,length=0.1}]'],
                 "more than half as wide as its narrowest concave part, of radius about 0.0894 m"),
                (['meshes=[{name="rock",kind="sphere",radius=0.5,levels=1}]'], "beside the smooth surface")]:
            with self.subTest(settings=settings):
                self.assertIn(text, self.report(*settings)[1])

    def test_a_line_of_a_planar_body_reaches_no_farther_than_its_ends(self):
        # Pushed there, 0.1 m from its centre, the body is as heavy as 1 / (1/1 + 0.1^2/0.01) = 0.5 kg.
        settings = ("space={dimension=2,min=[-1,-1],max=[1,1]}", "gravity=[0,-10]", "walls=[]",
                    'meshes=[{name="rock",kind="line",points=[[-0.1,0],[0.1,0]]}]',
                    'bodies=[{name="b",mass=1.0,inertia=0.01,position=[0,0],meshes=[{mesh="rock"}]}]',
                    "particles.0.positions=[[0,0.5]]", "time.step=9e-4")
        warnings = self.report(*settings)[1]
        self.assertIn(f"a body on a contact oscillates with {math.sqrt(1e5 / 0.5):.4g} rad/s", warnings)

    def test_works_count_from_the_start_and_keep_their_file(self):
        def setting(*fields):
            return "--set", f"output.surface_fields={list(fields)}".replace("'", '"')
        self.run_deck(DONE, "out")
        self.run_deck(DONE, "works", *setting("impact_work"))
        longer = ("--set", "time.end=2e-3")

        def restart(output):
            return "--restart", self.folder / output / "checkpoint_end.h5", *longer
        message = self.run_deck(BAD_INPUT, "other", *restart("out"), *setting("impact_work")).stderr
        self.assertIn("work or wear, which count from t = 0", message)
        message = self.run_deck(IO_FAILED, "works", *restart("works"), *setting("sliding_work")).stderr
        for word in ("surfaces.vtkhdf", "impact_work", "sliding_work", "keep output.surface_fields unchanged"):
            self.assertIn(word, message)
        self.run_deck(DONE, "more", *restart("works"), *setting("sliding_work", "pressure"))
        self.run_deck(DONE, "none", *restart("works"))
        other = ("--allow-changes", "--set", "meshes.rock.refine=0.1")
        message = self.run_deck(BAD_INPUT, "refined", *restart("works"), *setting("impact_work"), *other).stderr
        self.assertIn("the meshes must not change: meshes.rock.refine", message)
        self.run_deck(DONE, "refined", *restart("works"), *other)

    def test_a_run_goes_on_with_the_same_mesh_alone(self):
        self.run_deck(DONE, "out")
        longer = ("--restart", self.folder / "out" / "checkpoint_end.h5", "--set", "time.end=2e-3")
        self.run_deck(DONE, "more", *longer)
        self.write("rock.stl", stl(FACES, [(x, y, z + 0.1) for x, y, z in CORNERS]))
        self.assertIn("meshes.rock.file", self.run_deck(BAD_INPUT, "other", *longer).stderr)


TRAY = """gravity = [0.0, 0.0, -9.8066]

[space]
dimension = 3
min = [-1.0, -1.0, -1.0]
max = [1.0, 1.0, 1.0]
leaving = "ballistic"

[time]
end = 1.0
step = 5e-4

[integrator]
particles = "velocity-verlet"

[[contact.pairs]]
stiffness = 1e5
restitution = 0.5

[[meshes]]
name = "tray"
kind = "box"
size = [0.4, 0.4, 0.1]
offset = [0.0, 0.0, 0.6]

[[walls]]
name = "tray"
mesh = "tray"

[[walls.motions]]
type = "translation"
direction = [0.0, 0.0, 1.0]
displacement = { kind = "step", end_value = 0.5, start = 0.0, end = 0.8 }

[[particles]]
kind = "list"
positions = [[0.0, 0.0, 0.71]]
radius = 0.05
mass = 1.0

[[particles]]
kind = "list"
positions = [[0.6, 0.0, 0.9]]
velocity = [0.0, 0.0, 4.0]
radius = 0.05
mass = 1.0
"""


class LostLoadTest(CommandLineTest):
    """A tray lifts a grain out of the space; another one flies out beside it, before."""

    def warnings(self, output):
        return json.loads((self.folder / output / "run_record.json").read_text())["warnings"]

    def test_what_is_carried_out_of_the_space_is_warned_of_at_once_and_when_it_is_lost(self):
        deck = self.write("tray.toml", TRAY)
        early = "wall \"tray\" reaches beyond an open side of the domain"
        self.assertIn(early, self.expect(DONE, "check", deck).stderr)
        for launcher in ((), TWO_RANKS):
            with self.subTest(launcher=launcher):
                text = self.expect(DONE, "run", deck, "--output", self.folder / "out", "--overwrite",
                                   launcher=launcher).stderr
                first, lost = self.warnings("out")
                self.assertIn(early, first)
                self.assertIn("particle 0 leaves the domain at t = ", lost)
                self.assertIn("at the surfaces of wall \"tray\": particles that leave are excluded from contact "
                              "detection", lost)
                self.assertEqual(text.count(lost), 1)
        result = self.expect(DONE, "run", deck, "--output", self.folder / "in", "--set", "space.max=[1,1,2]")
        self.assertEqual((result.stderr, self.warnings("in")), ("", []))


if __name__ == "__main__":
    unittest.main()
