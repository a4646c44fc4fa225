"""What check says of the facets of meshes, their number and their cost, of shells that cut through each other; keys of
0 that are as if they were left out. Usage: SCREE=path/to/scree python3 test_facets.py"""

import json
import math
import re
import unittest

from test_cli import BAD_INPUT, DONE, CommandLineTest
from test_meshes import stl

DECK = """gravity = [0.0, 0.0, -9.81]
[space]
dimension = 3
min = [-0.5, -0.5, -0.5]
max = [0.5, 0.5, 0.5]
leaving = "ballistic"
[time]
end = 2e-3
step = 1e-5
control = "fixed"
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e5
[[meshes]]
name = "m"
%s
[[walls]]
name = "w"
mesh = "m"
[[particles]]
name = "grains"
kind = "list"
positions = [[0.0, 0.0, 0.45], [0.1, 0.0, 0.45]]
radius = 0.005
density = 2000.0
"""
SCREW = """kind = "screw"
radius = 0.045
core_radius = 0.012
pitch = 0.07
thickness = 0.005
length = 0.2"""
PIPE = """kind = "pipe"
radius = 0.2
inner_radius = 0.19
length = 0.5"""
# Two that meet off their middles.
MEETING = """gravity = [0.0, 0.0, -9.81]
[space]
dimension = 3
min = [-0.5, -0.5, -0.5]
max = [0.5, 0.5, 0.5]
z_min = "wall"
[time]
end = 0.02
step = 1e-4
control = "fixed"
[[contact.pairs]]
%s
[[particles]]
name = "grains"
kind = "list"
positions = [[0.0, 0.0, -0.4501], [0.02, 0.01, -0.352]]
velocity = [0.1, 0.0, -0.5]
radius = 0.05
density = 1000.0
"""


def boxes(*shifts):
    """Boxes of 0.1 x 0.1 x 0.04 m in one file."""
    faces = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7), (0, 4, 2),
             (2, 4, 6), (1, 3, 5), (3, 7, 5)]
    corners = [(x + dx, y + dy, z + dz) for dx, dy, dz in shifts for z in (-0.02, 0.02) for y in (-0.05, 0.05)
               for x in (-0.05, 0.05)]
    return stl([tuple(8 * k + c for c in face) for k in range(len(shifts)) for face in faces], corners)


class FacetsTest(CommandLineTest):
    def check(self, text, *settings):
        words = [word for setting in settings for word in ("--set", setting)]
        result = self.expect(DONE, "check", self.write("deck.toml", text), *words)
        return result.stdout, result.stderr

    def refused(self, text):
        message = self.expect(BAD_INPUT, "check", self.write("deck.toml", text)).stderr
        self.assertEqual(message.count("error: "), 1, message)
        return message

    def hash(self, text, output):
        deck = self.write(f"{output}.toml", text)
        self.expect(DONE, "run", deck, "--output", self.folder / output)
        return json.loads((self.folder / output / "run_record.json").read_text())["run"]["state_hash"]

    def test_facets_lie_as_far_from_the_true_surface_as_they_do(self):
        # The sections of a screw divide its length evenly, and its blades bend between them: test_unit_mesh
        # compares with samples of the surface.
        for shape, radius, within in ((PIPE, 0.2, 0.02), (SCREW, 0.045, 0.15)):
            for segments in (8, 12, 48):
                with self.subTest(radius=radius, segments=segments):
                    report, _ = self.check(DECK % f"{shape}\nsegments = {segments}")
                    said = float(re.search(r"facets deviate by up to (\S+) m from the true surface", report)[1])
                    self.assertAlmostEqual(said / (radius * (1 - math.cos(math.pi / segments))), 1, delta=within)

    def test_of_files_the_report_says_what_it_cannot_know(self):
        self.write("boxes.stl", boxes((0, 0, 0)))
        report, _ = self.check(DECK % 'kind = "file"\nfile = "boxes.stl"')
        self.assertIn("no curve found from the angles between facets; edges of 30 degrees or more count as "
                      "sharp", report)

    def test_segments_left_out_are_in_the_report_and_in_the_resolved_deck(self):
        for radius, segments in (("0.005", 32), ("0.02", 16), ("0.001", 68)):
            with self.subTest(radius=radius):
                report, warnings = self.check(DECK % SCREW, f"particles.grains.radius={radius}", "time.step=1e-7")
                self.assertIn(f"segments = {segments}, from the smallest particle's radius, {radius} m", report)
                self.assertNotIn("small beside", warnings)
        deck = self.write("deck.toml", DECK % SCREW)
        self.expect(DONE, "run", deck, "--output", self.folder / "out")
        record = json.loads((self.folder / "out" / "run_record.json").read_text())
        self.assertIn("segments = 32\n", json.dumps(record).replace("\\n", "\n"))
        named = DECK % f"{SCREW}\nsegments = 32"
        self.assertEqual(self.hash(named, "named"), record["run"]["state_hash"])

    def test_what_a_mesh_costs(self):
        report, warnings = self.check(DECK % f"{SCREW}\nsegments = 96")
        self.assertRegex(report, r"a particle of 0\.005 m is \S+ triangles wide; about \d+ are near a contact")
        self.assertRegex(warnings,
                         r'mesh "m": its triangles are small beside the particles: .* costs time: segments = 32')
        self.assertRegex(
            report, r"device memory .*; \S+ [kM]B of it meshes; each particle that comes near one \d+ B more\)")

    def test_shells_that_cut_through_each_other(self):
        solid = DECK.replace('[[walls]]\nname = "w"\nmesh = "m"\n', '[[bodies]]\nname = "b"\nkind = "spatial"\n'
                             'position = [0.0, 0.0, 0.0]\nsolids = [{ kind = "mesh", mesh = "m", density = 1000.0 }]\n'
                             'meshes = [{ mesh = "m" }]\n') % 'kind = "file"\nfile = "boxes.stl"'
        wall = DECK % 'kind = "file"\nfile = "boxes.stl"'
        for shifts, pair in ((((0, 0, 0), (0.03, -0.03, 0)), "0 and 1"), (((0, 0, 0), (0.03, 0.03, 0.01)), "0 and 1"),
                             (((0.3, 0, 0), (0, 0, 0), (0.03, 0.01, 0.035)), "1 and 2")):
            with self.subTest(shifts=shifts):
                self.write("boxes.stl", boxes(*shifts))
                message = self.refused(solid)
                self.assertRegex(message, r'bodies\.b\.solids\.0\.mesh = "m": its shells ' + pair +
                                 r" cut through each other, first at \(.*\) \(triangles .*: unite the shells")
                report, warnings = self.check(wall)
                self.assertIn(f'mesh "m": its shells {pair} cut through each other', warnings)
        # One on the other, and one beside the other with a side in common.
        for shift in ((0.02, 0.03, 0.04), (0.1, 0.02, 0.01)):
            with self.subTest(shift=shift):
                self.write("boxes.stl", boxes((0, 0, 0), shift))
                report, warnings = self.check(solid)
                self.assertIn("as a solid 0.8 kg", report)
                self.assertNotIn("cut through", warnings)

    def test_keys_of_0_give_the_bits_of_keys_left_out(self):
        linear, hertz = "stiffness = 1e5\nfriction = 0.4\n", "restitution = 0.8\nfriction = 0.4\n"
        soft = '[[materials]]\nname = "soft"\nyoung_modulus = 1e7\npoisson_ratio = 0.3\n'
        explicit = "[integrator]\nparticles = \"velocity-verlet\"\n[time]"
        for name, pair, more, zeros in (
                ("linear", linear, "", "rolling_friction = 0.0\nrolling_stiffness = 2.0\nattraction = 0.0\n"
                 "rolling_damping = 0.0\ntwisting_friction = 0.0\n"),
                ("hertz", hertz, soft, "rolling_friction = 0.0\nwork_of_adhesion = 0.0\n")):
            for method in ("[time]", explicit):
                with self.subTest(law=name, method=method):
                    text = more + MEETING.replace("[time]", method)
                    text = text.replace("gravity = [0.0, 0.0, -9.81]\n", "")
                    text = "gravity = [0.0, 0.0, -9.81]\n" + text
                    self.assertEqual(self.hash(text % (pair + zeros), f"{name}{len(method)} zeros"),
                                     self.hash(text % pair, f"{name}{len(method)} without"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
