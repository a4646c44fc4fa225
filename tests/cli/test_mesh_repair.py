"""Some hundred meshes with the defects of real files, made from good ones: each through `scree check`, with the count
of what is put right, the volume and the mass.
Usage: SCREE=path/to/scree python3 test_mesh_repair.py"""

import itertools
import math
import random
import re
import struct
import unittest

from test_cli import BAD_INPUT, DONE, CommandLineTest

DECK = """gravity = [0.0, 0.0, -9.81]
[space]
dimension = 3
min = [-1000.0, -10.0, -10.0]
max = [1000.0, 10.0, 10.0]
leaving = "ballistic"
[time]
end = 1e-3
step = 1e-4
control = "fixed"
[[contact.pairs]]
stiffness = 1e5
"""
GRID = 2.0 ** -10  # coordinates are whole multiples, so that middles of edges lie on these in every format
PER_DECK = 20      # `check` shows so many meshes


def rounded(point):
    return tuple(round(x / GRID) * GRID for x in point)


class Mesh:
    """Corners and triangles as they should be, and as they stand in the file: each with whether it is turned."""

    def __init__(self, corners, faces):
        self.corners, self.faces = [rounded(c) for c in corners], list(faces)
        self.file = [(face, False) for face in self.faces]
        self.left_out = 0  # without area

    def add(self, point):
        self.corners.append(point)
        return len(self.corners) - 1

    def moved(self, shift):
        return Mesh([tuple(x + s for x, s in zip(c, shift)) for c in self.corners], self.faces)

    def scaled(self, factor):
        return Mesh([tuple(factor * x for x in c) for c in self.corners], self.faces)

    def inverted(self):
        return Mesh(self.corners, [face[::-1] for face in self.faces])

    def __add__(self, other):
        first = len(self.corners)
        return Mesh(self.corners + other.corners,
                    self.faces + [tuple(first + c for c in face) for face in other.faces])

    def volume(self):
        return sum(dot(a, cross(b, c)) for a, b, c in ([self.corners[i] for i in face] for face in self.faces)) / 6

    def area(self):
        return sum(math.hypot(*cross(difference(b, a), difference(c, a))) for a, b, c in
                   ([self.corners[i] for i in face] for face in self.faces)) / 2


def difference(a, b):
    return tuple(x - y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def tube(sections, closed=True):
    """Rings of as many points, each joined to the next one, the first and the last to a corner each."""
    count = len(sections[0])
    corners = [c for ring in sections for c in ring]
    faces = []
    for k, i in itertools.product(range(len(sections) - 1), range(count)):
        a, b = k * count + i, k * count + (i + 1) % count
        faces += [(a, b, b + count), (a, b + count, a + count)]
    if closed:
        for ring, start, turned in ((sections[0], 0, True), (sections[-1], (len(sections) - 1) * count, False)):
            middle = len(corners)
            corners.append(tuple(sum(x) / count for x in zip(*ring)))
            cap = [(start + i, start + (i + 1) % count, middle) for i in range(count)]
            faces += [face[::-1] for face in cap] if turned else cap
    return Mesh(corners, faces)


def ring(count, radius, z, twist=0.0):
    angles = [2 * math.pi * i / count + twist for i in range(count)]
    return [(radius(i) * math.cos(angle), radius(i) * math.sin(angle), z) for i, angle in enumerate(angles)]


def box():
    return tube([[(x, y, z) for x, y in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))] for z in (-0.25, 0.25)])


def ball():
    return tube([ring(16, lambda _, t=t: 0.5 * math.sin(t), -0.5 * math.cos(t)) for t in
                 (math.pi * k / 9 for k in range(1, 9))])


def screw():
    return tube([ring(12, lambda i: 0.4 if i % 4 else 0.6, 0.1 * k, 0.3 * k) for k in range(12)])


def hollow():
    return ball().scaled(2) + box().scaled(0.75).inverted()


def apart():
    return box() + ball().moved((2, 0, 0))


GOOD = {"box": box, "ball": ball, "screw": screw, "hollow": hollow, "apart": apart}


def sheet():
    return tube([ring(16, lambda _, k=k: 0.25 + 0.1 * k, 0.2 * k) for k in range(5)], closed=False)


# Defects, each some times over.
def slivers(mesh, chance):
    """Three corners on a line between two triangles."""
    for _ in range(6):
        at = chance.randrange(len(mesh.file))
        (a, b, c), turned = mesh.file[at]
        m = mesh.add(tuple((x + y) / 2 for x, y in zip(mesh.corners[a], mesh.corners[b])))
        if on_a_line(mesh, (a, b, c)):
            continue
        mesh.file[at:at + 1] = [((a, m, c), turned), ((m, b, c), turned), ((a, b, m), turned)]
        mesh.left_out += 1


def on_a_line(mesh, face):
    a, b, c = (mesh.corners[i] for i in face)
    return math.hypot(*cross(difference(b, a), difference(c, a))) == 0


def points(mesh, chance):
    """A corner twice, or three times."""
    for face in chance.sample(mesh.faces, 4):
        mesh.file.append(((face[0], face[0], chance.choice(face)), False))
        mesh.left_out += 1


def twins(mesh, chance):
    for face, turned in chance.sample(mesh.file, 5):
        mesh.file.append((face[1:] + face[:1], turned) if chance.random() < 0.5 else (face[::-1], not turned))
        mesh.left_out += on_a_line(mesh, face)


def leaves(mesh, chance):
    """Two triangles back to back that stick out of a surface."""
    for face in chance.sample(mesh.faces, 3):
        top = mesh.add((chance.randrange(1024) * GRID, 0.0, 4.0))
        mesh.file += [((face[0], face[1], top), None), ((face[1], face[0], top), None)]


def turns(mesh, chance):
    """Few triangles of each piece, so that it is clear how the piece is wound."""
    for at in chance.sample(range(len(mesh.file)), max(1, len(mesh.file) // 6)):
        face, turned = mesh.file[at]
        if turned is not None:
            mesh.file[at] = (face[::-1], not turned)


def inwards(mesh, _):
    mesh.file = [(face[::-1], turned if turned is None else not turned) for face, turned in mesh.file]


def shuffled(mesh, chance):
    chance.shuffle(mesh.file)


def nothing(_mesh, _chance):
    pass


DEFECTS = {"nothing": [nothing], "slivers": [slivers], "points": [points], "twins": [twins], "leaves": [leaves],
           "turns": [turns], "inwards": [inwards], "most": [turns, slivers, points, twins, shuffled],
           "all": [turns, slivers, points, twins, leaves, shuffled],
           "all inwards": [slivers, points, twins, inwards, shuffled]}


def expected(mesh, is_sheet):
    """How many triangles are left out for want of area, as twins, and turned."""
    seen, twin, turned, pieces = set(), 0, 0, 0
    for face, is_turned in mesh.file:
        if len(set(face)) < 3 or on_a_line(mesh, face):
            continue
        key = tuple(sorted(face))
        leaf = is_turned is None
        twin += key in seen or leaf
        if key not in seen and not leaf:
            turned += is_turned
            pieces += 1
        seen.add(key)
    return mesh.left_out, twin, min(turned, pieces - turned) if is_sheet else turned


# Formats.
def ascii_stl(mesh):
    rows = "".join("facet normal 0 0 0\nouter loop\n" + "".join("vertex {!r} {!r} {!r}\n".format(*mesh.corners[c])
                                                                for c in face) +
                   "endloop\nendfacet\n" for face, _ in mesh.file)
    return f"solid part\n{rows}endsolid part\n".encode()


def binary_stl(mesh):
    return b"\0" * 80 + struct.pack("<I", len(mesh.file)) + b"".join(
        struct.pack("<12fH", 0, 0, 0, *(x for c in face for x in mesh.corners[c]), 0) for face, _ in mesh.file)


def obj(mesh):
    return ("".join("v {!r} {!r} {!r}\n".format(*c) for c in mesh.corners) +
            "".join("f {} {} {}\n".format(*(c + 1 for c in face)) for face, _ in mesh.file)).encode()


def ply_header(mesh, form, number):
    return (f"ply\nformat {form} 1.0\nelement vertex {len(mesh.corners)}\n" +
            "".join(f"property {number} {axis}\n" for axis in "xyz") +
            f"element face {len(mesh.file)}\nproperty list uchar int vertex_indices\nend_header\n").encode()


def ascii_ply(mesh):
    return ply_header(mesh, "ascii", "double") + (
        "".join("{!r} {!r} {!r}\n".format(*c) for c in mesh.corners) +
        "".join("3 {} {} {}\n".format(*face) for face, _ in mesh.file)).encode()


def binary_ply(mesh):
    return ply_header(mesh, "binary_big_endian", "float") + b"".join(
        struct.pack(">3f", *c) for c in mesh.corners) + b"".join(
        struct.pack(">B3i", 3, *face) for face, _ in mesh.file)


FORMATS = [(ascii_stl, "stl"), (binary_stl, "stl"), (obj, "obj"), (ascii_ply, "ply"), (binary_ply, "ply")]


def said(text):
    """The counts of a warning."""
    def count(pattern):
        found = re.search(pattern, text)
        return int(found[1]) if found else 0
    return (count(r"(\d+) triangles? without area"), count(r"(\d+) triangles? with the corners of others"),
            count(r"(?:all of its |^|; )(\d+) "
                  r"(?:triangles ran|of its \d+ triangles (?:is|are) (?:turned|wound against))"))


class RepairTest(CommandLineTest):
    def batch(self, meshes, sheet):
        """meshes: name, content, ending. Returns what `check` says of each mesh, and the warnings of each."""
        deck = DECK
        for number, (name, content, ending) in enumerate(meshes):
            (self.folder / f"{name}.{ending}").write_bytes(content)
            deck += f'[[meshes]]\nname = "{name}"\nkind = "file"\nfile = "{name}.{ending}"\n'
            deck += "sheet = true\n" if sheet else ""
            solid = f'solids = [{{ kind = "mesh", mesh = "{name}", density = 1000.0 }}]\n'
            given = "mass = 1.0\ninertia_tensor = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]\n"
            deck += (f'[[bodies]]\nname = "{name}"\nkind = "spatial"\nposition = [{10.0 * number}, 0.0, 0.0]\n'
                     f'{given if sheet else solid}meshes = [{{ mesh = "{name}" }}]\n')
        result = self.expect(DONE, "check", self.write("batch.toml", deck))
        lines = dict(re.findall(r'^mesh +"(.*?)": (.*)$', result.stdout, re.M))
        warnings = re.findall(r'^warning: mesh "(.*?)" \(.*?\): (.*)$', result.stderr, re.M)
        return lines, warnings

    def of_all(self, good, sheet):
        """Every good mesh with every defect in every format. Returns the number of meshes."""
        cases = []
        for shape, kind, (form, ending) in itertools.product(good, DEFECTS, FORMATS):
            if sheet and (leaves in DEFECTS[kind] or inwards in DEFECTS[kind]):
                continue
            chance = random.Random(f"{shape} {kind} {form.__name__}")
            mesh = good[shape]()
            for defect in DEFECTS[kind]:
                defect(mesh, chance)
            cases.append((f"{shape} {kind} {form.__name__}", mesh, form(mesh), ending))
        for first in range(0, len(cases), PER_DECK):
            batch = cases[first:first + PER_DECK]
            lines, warnings = self.batch([(name, content, ending) for name, _, content, ending in batch], sheet)
            self.assertEqual(len(lines), len(batch))
            for name, mesh, _, _ in batch:
                with self.subTest(name):
                    counts = expected(mesh, sheet)
                    texts = [text for of, text in warnings if of == name]
                    self.assertEqual(len(texts), int(any(counts)), texts)
                    self.assertEqual(said(texts[0]) if texts else (0, 0, 0), counts, texts)
                    if any(counts):
                        self.assertIn("(the first: triangle ", texts[0])
                    if not sheet:
                        found = re.search(r"closed; .*volume (\S+) m\^3, as a solid (\S+) kg", lines[name])
                        volume, mass = found.groups()
                        self.assertAlmostEqual(float(volume) / mesh.volume(), 1, delta=1e-5)
                        self.assertAlmostEqual(float(mass) / mesh.volume() / 1000, 1, delta=1e-5)
                    else:
                        area = re.search(r"an open surface; .*area (\S+) m\^2", lines[name])[1]
                        self.assertAlmostEqual(float(area) / mesh.area(), 1, delta=1e-5)
        return len(cases)

    def test_closed_meshes(self):
        self.assertEqual(self.of_all(GOOD, sheet=False), 5 * 10 * 5)

    def test_sheets(self):
        self.assertEqual(self.of_all({"cone": sheet, "ball": ball}, sheet=True), 2 * 6 * 5)

    def test_what_is_no_solid_is_refused_with_the_key_that_takes_it(self):
        hole, fin, strip = box(), box(), Mesh([], [])
        hole.file.pop(3)
        fin.file.append(((0, 1, fin.add((0.0, 0.0, 2.0))), False))
        for k in range(8):  # turned by half a turn when it comes around
            angle, lean = math.pi * k / 4, math.pi * k / 8
            for side in (-0.125, 0.125):
                radius = 1 + side * math.cos(lean)
                strip.add(rounded((radius * math.cos(angle), radius * math.sin(angle), side * math.sin(lean))))
        for k in range(8):
            a, b, c, d = 2 * k, 2 * k + 1, *((2 * k + 2, 2 * k + 3) if k < 7 else (1, 0))
            strip.file += [((a, b, d), False), ((a, d, c), False)]
        for name, mesh, word in (("hole", hole, "3 edges have one triangle"), ("fin", fin, "an edge has more than two"),
                                 ("strip", strip, "16 edges have one triangle")):
            with self.subTest(name):
                self.write("one.toml", DECK + f'[[meshes]]\nname = "{name}"\nkind = "file"\nfile = "{name}.obj"\n'
                           f'[[walls]]\nname = "wall"\nmesh = "{name}"\n')
                (self.folder / f"{name}.obj").write_bytes(obj(mesh))
                message = self.expect(BAD_INPUT, "check", "one.toml").stderr
                self.assertIn(word, message)
                self.assertIn("; sheet = true takes it as a surface that is touched from both sides", message)
                self.expect(DONE, "check", "one.toml", "--set", f"meshes.{name}.sheet=true")


class ContainerTest(CommandLineTest):
    """Grains in a closed mesh: a solid holds none."""

    def test_the_key_that_makes_a_container_is_named_however_the_mesh_is_wound(self):
        deck = DECK + ('[[meshes]]\nname = "bin"\nkind = "file"\nfile = "bin.stl"\n'
                       '[[walls]]\nname = "bin"\nmesh = "bin"\n'
                       '[[particles]]\nname = "grains"\nkind = "list"\nradius = 0.03\nmass = 0.1\n'
                       'positions = [[0.1, 0.2, 0.0], [-0.2, 0.1, 0.1]]\n')
        self.write("bin.toml", deck)
        for turned in (False, True):
            with self.subTest(turned=turned):
                mesh = box()
                if turned:
                    inwards(mesh, None)
                (self.folder / "bin.stl").write_bytes(binary_stl(mesh))
                message = self.expect(BAD_INPUT, "check", "bin.toml").stderr
                self.assertIn('particle 0 and wall "bin" overlap at t = 0 by 2 of the smaller radius', message)
                self.assertIn("of 2 overlaps 2 are above it; particle 0: of particles.grains at (0.1, 0.2, 0), radius "
                              "0.03 m", message)
                self.assertIn('the centre of particle 0 is inside the solid that mesh "bin" encloses: sheet = true '
                              'in meshes.bin makes it a container', message)
                self.assertEqual(message.count("all of its 16 triangles ran clockwise seen from outside"), int(turned))
                self.expect(DONE, "check", "bin.toml", "--set", "meshes.bin.sheet=true")


if __name__ == "__main__":
    unittest.main()
