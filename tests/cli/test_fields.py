"""The fields of particles in snapshots (output.fields). Usage: SCREE=path/to/scree python3 test_fields.py"""

import re
import unittest

from test_cli import BAD_INPUT, DONE, EXPLICIT, IO_FAILED, CommandLineTest


def fields_setting(*names):
    return "--set", "output.fields=[" + ", ".join(f'"{name}"' for name in names) + "]"


class FieldsTest(CommandLineTest):
    def known_fields(self):
        """As the manual lists them."""
        manual = self.expect(DONE, "keys").stdout
        return re.findall(r"(?m)^  (\w+) +\[[^]]+\] \w.*\.$", manual[manual.index("Output fields") :])

    def fields_in(self, output):
        """Of the .xdmf, which names what the .vtkhdf holds."""
        text = (self.folder / output / "particles.xdmf").read_text()
        return list(dict.fromkeys(re.findall(r'Attribute Name="(\w+)"', text)))

    def test_snapshots_hold_what_the_deck_wants(self):
        known = self.known_fields()
        for field in ("radius", "velocity", "mass", "force", "contacts"):
            self.assertIn(field, known)
        self.run_deck(DONE, "standard")
        self.assertEqual(self.fields_in("standard"),
                         ["global_id", "radius", "velocity", "force", "contacts", "material", "group"])
        self.run_deck(DONE, "none", *fields_setting())
        self.assertEqual(self.fields_in("none"), ["global_id"])
        for integrator in ((), EXPLICIT):
            with self.subTest(integrator=integrator):
                output = f"all {len(integrator)}"
                self.run_deck(DONE, output, *integrator, *fields_setting(*known))
                self.assertEqual(self.fields_in(output), ["global_id", *known])

    def test_fields_that_there_are_not(self):
        for words in (("run", self.deck, "--output", self.folder / "out"), ("check", self.deck)):
            message = self.expect(BAD_INPUT, *words, *fields_setting("radius", "velocty")).stderr
            self.assertIn("output.fields", message)
            self.assertIn('there is no output field "velocty"', message)
            self.assertIn("velocity", message)
            self.assertEqual(len(message.splitlines()), 1)
        self.assertFalse((self.folder / "out").exists())
        message = self.expect(BAD_INPUT, "check", self.deck, *fields_setting("mass", "mass")).stderr
        self.assertIn('"mass" is repeated', message)

    def test_fields_of_rotation_without_rotation_are_warned_of(self):
        fields = fields_setting("orientation", "mass", "angular_velocity")
        warning = self.expect(DONE, "check", self.deck, *fields).stderr
        self.assertIn("output.fields: angular_velocity, orientation will be the same in all snapshots: no particle "
                      "rotates because no pair in contact.pairs has friction", warning)
        friction = ("--set", "contact.pairs.0.friction=0.3")
        self.assertNotIn("output.fields", self.expect(DONE, "check", self.deck, *fields, *friction).stderr)

    def test_a_restart_with_other_fields_wants_another_folder(self):
        half = ("--set", "time.end=0.2")
        self.run_deck(DONE, "out", *half)
        before = (self.folder / "out/particles.vtkhdf").read_bytes()
        restart = ("--restart", self.folder / "out/checkpoint_end.h5", *fields_setting("mass"))
        message = self.run_deck(IO_FAILED, "out", *restart).stderr
        for word in ("particles.vtkhdf", "contacts", "mass", "output.fields", "another folder"):
            self.assertIn(word, message)
        self.assertEqual((self.folder / "out/particles.vtkhdf").read_bytes(), before)
        self.run_deck(DONE, "other", *restart)
        self.assertEqual(self.fields_in("other"), ["global_id", "mass"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
