"""Pairs of materials that are made of others, and moments of inertia: messages, what check prints, results.
Usage: SCREE=path/to/scree python3 test_materials.py"""

import json
import re
import unittest

from test_cli import BAD_INPUT, DONE, CommandLineTest

# Grains of two kinds that fall onto each other and onto a floor of a third material.
MIXED = """gravity = [0.5, 0.0, -9.8]
[space]
dimension = 3
min = [0.0, 0.0, 0.0]
max = [1.0, 1.0, 1.0]
z_min = "wall"
wall_material = "floor"
leaving = "ballistic"
[time]
end = 0.25
step = 1e-4
[integrator]
particles = "velocity-verlet"
[contact]
mixing = "geometric"
[[materials]]
name = "glass"
young_modulus = 1e6
poisson_ratio = 0.25
[[materials]]
name = "rubber"
young_modulus = 2e5
poisson_ratio = 0.45
[[materials]]
name = "floor"
young_modulus = 1e7
poisson_ratio = 0.3
[[contact.pairs]]
materials = ["glass", "glass"]
restitution = 0.9
friction = 0.2
[[contact.pairs]]
materials = ["rubber", "rubber"]
restitution = 0.5
friction = 0.8
[[contact.pairs]]
materials = ["floor", "floor"]
restitution = 0.6
friction = 0.5
[[particles]]
kind = "lattice"
origin = [0.3, 0.3, 0.12]
spacing = [0.21, 0.21, 0.21]
size = [2, 2, 1]
radius = 0.1
mass = 1.0
material = "glass"
[[particles]]
kind = "lattice"
origin = [0.31, 0.3, 0.33]
spacing = [0.21, 0.21, 0.21]
size = [2, 2, 1]
radius = 0.1
mass = 1.0
material = "rubber"
[output]
checkpoint_interval = 0.125
history_csv = true
"""
GIVEN = "".join(
    f'[[contact.pairs]]\nmaterials = ["{one}", "{other}"]\nrestitution = {restitution}\nfriction = {friction}\n'
    for one, other, restitution, friction in (
        ("rubber", "glass", (0.9 * 0.5)**0.5, (0.2 * 0.8)**0.5), ("glass", "floor", (0.9 * 0.6)**0.5, (0.2 * 0.5)**0.5),
        ("floor", "rubber", (0.5 * 0.6)**0.5, (0.8 * 0.5)**0.5)))
OF_MIXING = "               from contact.mixing: "


class MaterialsTest(CommandLineTest):
    def hash_of(self, text, name, *words):
        self.deck = self.write(f"{name}.toml", text)
        self.run_deck(DONE, name, *words)
        return json.loads((self.folder / name / "run_record.json").read_text())["run"]["state_hash"]

    def test_a_mixed_deck_runs_as_one_with_all_pairs_written_out(self):
        written_out = MIXED.replace('mixing = "geometric"\n', "") + GIVEN
        mixed = self.hash_of(MIXED, "mixed")
        self.assertEqual(mixed, self.hash_of(written_out, "given"))
        self.assert_same_history("mixed", "given")
        self.assertNotEqual(mixed, self.hash_of(MIXED, "other", "--set", "contact.mixing=minimum"))

    def test_check_prints_the_pairs_that_were_made(self):
        report = self.expect(DONE, "check", self.write("mixed.toml", MIXED)).stdout
        made = {}
        for names, keys in re.findall(r'contact +("\w+" on "\w+"):.*\n(?:' + OF_MIXING + r"(.*)\n)?", report):
            made[names] = keys
        self.assertEqual(made, {
            '"glass" on "glass"': "",
            '"glass" on "rubber"': f"restitution = {(0.9 * 0.5)**0.5}, friction = {(0.2 * 0.8)**0.5}",
            '"glass" on "floor"': f"restitution = {(0.9 * 0.6)**0.5}, friction = {(0.2 * 0.5)**0.5}",
            '"rubber" on "rubber"': "",
            '"rubber" on "floor"': f"restitution = {(0.5 * 0.6)**0.5}, friction = {(0.8 * 0.5)**0.5}"})
        # A pair that is given stays as it is.
        part = MIXED + GIVEN[:GIVEN.index("[[contact.pairs]]", 1)]
        self.assertEqual(self.expect(DONE, "check", self.write("part.toml", part)).stdout.count(OF_MIXING), 2)

    def test_the_rule_stands_in_the_resolved_deck_and_a_restart_wants_it(self):
        self.hash_of(MIXED, "first")
        self.assertIn('mixing = "geometric"', (self.folder / "first/run_record.json").read_text().replace('\\"', '"'))
        restart = ("--restart", self.folder / "first/checkpoint.h5", "--set", "contact.mixing=minimum")
        self.assertIn("contact.mixing", self.run_deck(BAD_INPUT, "second", *restart).stderr)

    def test_refusals_name_file_line_key_and_remedy(self):
        floor = MIXED[MIXED.index('[[contact.pairs]]\nmaterials = ["floor"'):MIXED.index("[[particles]]")]
        cases = (
            (MIXED.replace("geometric", "wet"), "mixing", "contact.mixing = \"wet\"", "\"harmonic\""),
            (MIXED.replace("geometric", "none"), "[[contact.pairs]]", 'no pair with materials = ["glass", "rubber"]',
             "unless contact.mixing says how"),
            (MIXED.replace(floor, ""), "mixing", '["glass", "floor"], which can meet, needs the pair',
             'the pair ["floor", "floor"] in [[contact.pairs]]', "give that pair, or this one"),
            (MIXED.replace("friction = 0.8", "friction = 0.8\nrolling_friction = 0.1"), "rolling_friction",
             'contact.pairs.1.rolling_friction = 0.1: the pair ["glass", "glass"] has none',
             'contact.mixing cannot make the pair ["glass", "rubber"]; give it in [[contact.pairs]]'),
            (MIXED.replace("friction = 0.5", "friction = 0.5\nlimit_damping = false"), "limit_damping",
             'limit_damping = false: differs from the true of the pair ["glass", "glass"]', "give it in"))
        for text, line, *parts in cases:
            with self.subTest(parts=parts):
                message = self.expect(BAD_INPUT, "check", self.write("bad.toml", text)).stderr
                self.assertRegex(message, r"^error: \S*bad\.toml:\d+:\d+: .*\n$")
                self.assertIn(line, text.splitlines()[int(re.search(r"bad\.toml:(\d+)", message).group(1)) - 1])
                for part in parts:
                    self.assertIn(part, message)

    def test_the_standard_moment_of_inertia_is_that_of_solid_spheres(self):
        def with_factor(value):
            return MIXED.replace("[output]", f"inertia_factor = {value}\n[output]")

        solid = self.hash_of(MIXED, "solid")
        self.assertEqual(solid, self.hash_of(with_factor(0.4), "given"))
        self.assertNotEqual(solid, self.hash_of(with_factor(0.6667), "hollow"))
        for value in (0.0, 1.1):
            message = self.expect(BAD_INPUT, "check", self.write("bad.toml", with_factor(value))).stderr
            self.assertRegex(message, r"bad\.toml:\d+:\d+: particles\.1\.inertia_factor = .*above 0 and at most 1")

    def test_a_restart_keeps_moments_of_inertia_and_made_pairs(self):
        hollow = MIXED.replace('material = "glass"\n[[', 'material = "glass"\ninertia_factor = 0.6\n[[')
        self.assertNotEqual(hollow, MIXED)
        whole = self.hash_of(hollow, "whole")
        self.hash_of(hollow, "parts", "--set", "time.end=0.125")
        restart = ("--restart", self.folder / "parts/checkpoint.h5")
        self.assertEqual(whole, self.hash_of(hollow, "parts", *restart))


if __name__ == "__main__":
    unittest.main(verbosity=2)
