"""Friction between particles: what decks with it are refused for, what check says, what snapshots and restarts hold.
Usage: SCREE=path/to/scree python3 test_friction.py"""

import re
import unittest

from test_cli import BAD_INPUT, DECK, DONE, EXPLICIT, CommandLineTest

# Spheres that fall onto a rough floor and onto each other.
FRICTIONAL = """gravity = [2.0, 0.0, -9.8]
[space]
dimension = 3
min = [0.0, 0.0, 0.0]
max = [1.0, 1.0, 1.0]
z_min = "wall"
leaving = "ballistic"
[time]
end = 0.2
step = 1e-4
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e5
damping = 10.0
friction = 0.5
[[particles]]
name = "grains"
kind = "lattice"
origin = [0.2, 0.2, 0.12]
spacing = [0.21, 0.21, 0.21]
size = [2, 2, 2]
radius = 0.1
mass = 1.0
angular_velocity = [0.0, 5.0, 1.0]
[output]
history_csv = true
"""
SMOOTH = re.sub(r"(?m)^(friction|angular_velocity) = .*\n", "", FRICTIONAL)
HERTZ = """stiffness = 1e5
damping = 10.0
""", """restitution = 0.8
"""
GLASS = """[[materials]]
name = "glass"
young_modulus = 1e7
poisson_ratio = 0.2
"""
BALL = """[[bodies]]
name = "ball"
position = [0.5, 0.5, 0.8]
mass = 1.0
inertia = 0.005
shapes = [{ radius = 0.05 }]
"""


class FrictionTest(CommandLineTest):
    def setUp(self):
        super().setUp()
        self.deck = self.write("deck.toml", FRICTIONAL)

    def refused(self, text):
        """The message, which names the file, and the line of the deck that it names."""
        message = self.expect(BAD_INPUT, "check", self.write("bad.toml", text)).stderr
        self.assertRegex(message, r"^error: \S*bad\.toml:\d+:\d+: .*\n$")
        return message, text.splitlines()[int(re.search(r"bad\.toml:(\d+)", message).group(1)) - 1]

    def test_refusals_name_file_key_and_remedy(self):
        friction = "friction = 0.5\n"
        hertz = FRICTIONAL.replace(*HERTZ) + GLASS
        pairs = "[[contact.pairs]]"
        # The deck; the line that is named; what the message says.
        cases = (
            (FRICTIONAL.replace(friction, "friction = -0.5\n"), friction, "contact.pairs.0.friction = -0.5",
             "at least 0"),
            (FRICTIONAL.replace(friction, "tangential_stiffness = 2e4\n"), "tangential_stiffness",
             "contact.pairs.0.tangential_stiffness", "needs friction"),
            (FRICTIONAL.replace(friction, "tangential_damping_ratio = 0.1\n"), "tangential_damping_ratio",
             "contact.pairs.0.tangential_damping_ratio", "needs friction"),
            (FRICTIONAL.replace(friction, friction + "tangential_stiffness = 0.0\n"), "tangential_stiffness",
             "contact.pairs.0.tangential_stiffness = 0", "above 0"),
            (FRICTIONAL.replace(friction, friction + "tangential_damping_ratio = -0.1\n"), "tangential_damping_ratio",
             "contact.pairs.0.tangential_damping_ratio", "at least 0"),
            (FRICTIONAL.replace(friction, friction + "exponent = 1.5\n"), pairs,
             "contact.pairs.0.tangential_stiffness: missing", "only where exponent = 1"),
            (hertz.replace(friction, friction + "tangential_stiffness = 2e4\n"), "tangential_stiffness",
             "contact.pairs.0.tangential_stiffness", "left out for Hertz's law: Mindlin's follows from the moduli"),
            (FRICTIONAL.replace('"velocity-verlet"', '"hht"')
             .replace(friction, friction + "attraction = 0.1\nattraction_range = 1e-4\n"),
             "attraction_range", "contact.pairs.0.attraction_range", "do not resolve an attraction beyond touch"),
            (FRICTIONAL + BALL.replace("0.005", "1e-7"), "step", "time.step = 1e-4",
             "a body on a contact oscillates with"),
            (FRICTIONAL.replace(friction, ""), "angular_velocity", "particles.grains.angular_velocity",
             "no particle rotates: no pair in contact.pairs has friction"),
            (FRICTIONAL.replace("[0.0, 5.0, 1.0]", "[5.0]"), "angular_velocity", "particles.grains.angular_velocity",
             "must have 3 entries"))
        for text, line, *parts in cases:
            with self.subTest(parts=parts):
                self.assertNotEqual(text, FRICTIONAL)
                message, named = self.refused(text)
                self.assertIn(line.split("=")[0].strip(), named)
                for part in parts:
                    self.assertIn(part, message)

    def test_discs_turn_about_z_alone(self):
        flat = re.sub(r"\[\[bodies\]\].*(?=\[\[particles\]\])", "", DECK, flags=re.DOTALL)
        flat = flat.replace('history_bodies = ["pad"]\n', "").replace("damping = 3.0", "damping = 3.0\nfriction = 0.5")
        for spin, code in (("[2.0]", DONE), ("[]", DONE), ("[0.0, 0.0, 2.0]", BAD_INPUT)):
            text = flat.replace("velocity = [0.5, -1.0]", f"velocity = [0.5, -1.0]\nangular_velocity = {spin}")
            message = self.expect(code, "check", self.write("flat.toml", text), *EXPLICIT[:2]).stderr
            self.assertEqual("must have 1 entry, about z" in message, code == BAD_INPUT)

    def test_decks_with_friction_go_with_hertz_and_bodies(self):
        self.expect(DONE, "check", self.write("hertz.toml", FRICTIONAL.replace(*HERTZ) + GLASS))
        self.expect(DONE, "check", self.write("body.toml", FRICTIONAL + BALL.replace("shapes", "# shapes")))
        self.expect(DONE, "run", self.write("ball.toml", FRICTIONAL + BALL), "--output", self.folder / "ball")
        self.expect(DONE, "check", self.deck, "--set", "contact.pairs.0.friction=0.0")

    def test_check_counts_rotation_and_what_contacts_remember(self):
        rolling = FRICTIONAL.replace("friction = 0.5\n", "friction = 0.5\nrolling_friction = 0.2\n")
        for text, memory in ((SMOOTH, 960), (FRICTIONAL, 2032), (rolling, 2936)):
            with self.subTest(memory=memory):
                report = self.expect(DONE, "check", self.write("counted.toml", text)).stdout
                history = r"; \S+ kB if particles are densely packed" if text != SMOOTH else ""
                self.assertRegex(report, rf"\ncheckpoints    one at the end, about \S+ kB each{history}\n")
                self.assertIn(f"(estimate: {memory} B per particle", report)

    def test_the_history_has_columns_of_rotation_where_particles_rotate(self):
        self.run_deck(DONE, "frictional")
        self.deck = self.write("deck.toml", SMOOTH)
        self.run_deck(DONE, "smooth")
        frictional, smooth = (self.history(name)[0].split(",") for name in ("frictional", "smooth"))
        self.assertEqual([name for name in frictional if name not in smooth],
                         ["rotation/kinetic [J]", "rotation/elastic_friction [J]", "rotation/elastic_rolling [J]",
                          "rotation/loss_friction [J]"])
        self.assertEqual([name for name in smooth if name not in frictional], [])

    def test_check_reports_friction_and_its_effect_on_the_step(self):
        def limit(*words):
            text = self.expect(DONE, "check", self.deck, *words).stdout
            self.assertIn("friction 0.5, k_t = ", text)
            return float(re.search(r"in dense contact: steps up to (\S+) s", text).group(1))

        # 2/7 of the stiffness across the normal: spheres that all spin alike are the fastest.
        damping = ("--set", "contact.pairs.0.damping=0.0")
        self.assertAlmostEqual(limit(*damping), 2 / (40 * 2 / 7 * 1e5) ** 0.5, delta=1e-6)
        stiff = (*damping, "--set", "contact.pairs.0.tangential_stiffness=1e5")
        self.assertAlmostEqual(limit(*stiff), 2 / (40 * 1e5) ** 0.5, delta=1e-6)
        message = self.expect(BAD_INPUT, "check", self.deck, *stiff, "--set", "time.step=1.1e-3").stderr
        self.assertIn("it must be at most 0.001 s", message)

    def test_snapshots_hold_spins_and_orientations(self):
        fields = ("--set", 'output.fields=["angular_velocity", "orientation"]')
        self.run_deck(DONE, "out", *fields)
        text = (self.folder / "out/particles.xdmf").read_text()
        for name in ("angular_velocity", "orientation"):
            self.assertIn(f'Attribute Name="{name}"', text)

    def test_a_restart_keeps_what_contacts_remember(self):
        self.run_deck(DONE, "whole", "--set", "output.checkpoint_interval=0.1")
        self.run_deck(DONE, "parts", "--set", "output.checkpoint_interval=0.1", "--set", "time.end=0.1")
        self.run_deck(DONE, "parts", "--set", "output.checkpoint_interval=0.1", "--restart",
                      self.folder / "parts/checkpoint.h5")
        self.assert_same_results("parts", "whole")

    def test_friction_may_come_and_go_at_a_restart_that_allows_changes(self):
        half = ("--set", "time.end=0.1")
        less = FRICTIONAL.replace("0.5", "0.1")
        for first, second in ((FRICTIONAL, SMOOTH), (SMOOTH, FRICTIONAL), (FRICTIONAL, less)):
            with self.subTest(second=second):
                self.deck = self.write("deck.toml", first)
                self.run_deck(DONE, "first", *half)
                self.deck = self.write("deck.toml", second)
                restart = ("--restart", self.folder / "first/checkpoint_end.h5")
                self.assertIn("contact.pairs.0.friction", self.run_deck(BAD_INPUT, "second", *restart).stderr)
                text = self.run_deck(DONE, "second", *restart, "--allow-changes").stdout
                error, exchanged = map(float, re.search(r"error (\S+) J of (\S+) J", text).groups())
                self.assertLess(abs(error), 0.05 * exchanged)


if __name__ == "__main__":
    unittest.main(verbosity=2)
