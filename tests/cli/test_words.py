"""What the program says: messages that hold what others wrote, usage, names, the manual. Usage: as test_cli.py"""

import pathlib
import re
import unittest

from test_cli import BAD_INPUT, DECK, DONE, CommandLineTest

LIMITS = pathlib.Path(__file__).resolve().parents[2] / "input/limits.md"


class MessageTest(CommandLineTest):
    def message(self, deck, *words):
        """The one line that a bad deck or word gets."""
        text = self.expect(BAD_INPUT, "check", self.write("bad.toml", deck), *words).stderr
        self.assertRegex(text, r"^error: .*\n$")
        self.assertTrue(text[:-1].isprintable(), text)
        return text

    def test_every_message_is_one_printable_line(self):
        for name, shown in (("a\\nb", r"a\nb"), ("\\u001b[31m", r"\x1b[31m"), ("\\u0000", r"\x00"), ("a/b", "a/b")):
            self.assertIn(f'name = "{shown}": must be ', self.message(DECK.replace('"discs"', f'"{name}"')))
        self.assertIn(r"x\ny", self.message(DECK, "--set", "time.x\ny=1"))
        self.assertLess(len(self.message(DECK.replace('"discs"', '"' + "x" * 100000 + '"'))), 1300)
        self.assertLess(len(self.message(DECK, "--set", "time.step=" + "x" * 100000)), 1300)

    def test_a_command_line_that_mpi_cannot_start_with(self):
        self.assertIn("the command line has 125", self.message(DECK, "--set", "time.step=" + "x" * 125000))

    def test_a_title_is_printed_on_one_line(self):
        deck = self.write("good.toml", DECK.replace('title = "test"', 'title = "a\\nb\\u001b[31m"'))
        self.assertIn("title          a\\nb\\x1b[31m\n", self.expect(DONE, "check", deck).stdout)

    def test_keys_nested_too_deep(self):
        key = ".".join(["a"] * 30000)
        self.assertIn("bad.toml:1: a key of more than 16 parts", self.message(f"{key} = 1\n" + DECK))
        self.assertIn("a key of more than 16 parts", self.message(DECK, "--set", f"{key}=1"))

    def test_blanks_in_overrides(self):
        self.assertIn("0 to 0.2 s", self.expect(DONE, "check", self.deck, "--set", "time.end = 0.2").stdout)

    def test_particle_files(self):
        deck = re.sub(r'kind = "lattice"\n.*\n.*\n.*\nradius = 0.05', 'kind = "file"\nfile = "p.csv"', DECK)
        deck = deck.replace("[0, 5]", "[0]")
        self.write("p.csv", "\ufeffx,y,radius\n0.1,0.5,0.05\n-0.1,0.5,0.05\n")
        self.assertIn("particles      2", self.expect(DONE, "check", self.write("good.toml", deck)).stdout)
        self.write("p.csv", "x,y,radius\n0.1,0.5,0.05\n\n-0.1,0.5,-0.05\n")
        self.assertIn("p.csv:4: column radius = -0.05: must be a positive, finite number", self.message(deck))
        self.write("p.csv", "x,y,\x1b[31mradius\n")
        self.assertIn(r'p.csv:1: unknown column "\x1b[31mradius"', self.message(deck))
        (self.folder / "p.csv").unlink()
        (self.folder / "p.csv").mkdir()
        self.assertIn("p.csv is a folder", self.message(deck))


class UsageTest(CommandLineTest):
    def test_a_deck_in_the_place_of_a_command(self):
        for deck in ("deck.toml", "absent.toml", self.deck):
            self.assertEqual(self.expect(BAD_INPUT, deck).stderr,
                             f'error: {deck}: not a command; did you mean "scree run {deck}"?\n')

    def test_bad_usage_is_one_line_that_names_the_help(self):
        for words in ((), ("walk",), ("run",), ("run", self.deck, "--speed", "9"), ("run", self.deck, "--set")):
            with self.subTest(words=words):
                self.assertRegex(self.expect(BAD_INPUT, *words).stderr, r"^error: .+ scree --help .+\n$")

    def test_an_unknown_command_is_told_which_there_are(self):
        self.assertIn('error: statsu: not a command; did you mean "status"?; ', self.expect(BAD_INPUT, "statsu").stderr)
        self.assertIn("error: walk: not a command; known: run, check, keys, new, status; ",
                      self.expect(BAD_INPUT, "walk").stderr)

    def test_the_manual_and_its_page_state_the_same_limits_of_the_model(self):
        def paragraphs(text):
            found = re.search(r"The model has these limits today\..*?heat transfer\.\n\n", text, re.DOTALL)
            return [" ".join(paragraph.split()) for paragraph in found.group().split("\n\n")]

        manual = self.expect(DONE, "keys").stdout
        self.assertLess(manual.index("limits today"), 1000)
        self.assertEqual(paragraphs(manual), paragraphs(LIMITS.read_text()))


if __name__ == "__main__":
    unittest.main()
