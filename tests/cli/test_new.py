"""Decks to begin from: scree new. Usage: as test_cli.py"""

import pathlib
import re
import unittest

from test_cli import BAD_INPUT, DONE, IO_FAILED, CommandLineTest

INPUT = pathlib.Path(__file__).resolve().parents[2] / "input"
NEEDS_A_FILE = re.compile(r"[\n{,] *file *=")


class NewTest(CommandLineTest):
    def test_the_list_has_every_deck_that_needs_no_other_file(self):
        text = self.expect(DONE, "new").stdout
        decks = [path for path in INPUT.glob("*/*.toml") if not NEEDS_A_FILE.search(path.read_text())]
        self.assertEqual(sorted(re.findall(r"(?m)^  (\S+)  +\S", text)), sorted(path.stem for path in decks))
        self.assertIn("  A disc on a revolute joint, 0.5 m from its centre, released at 90 degrees.\n", text)
        self.assertLessEqual(max(map(len, text.splitlines())), 110)

    def test_a_deck_is_written_and_passes_its_check_where_it_lies(self):
        said = self.expect(DONE, "new", "drum_lifters").stdout
        self.assertEqual(said, "wrote drum_lifters.toml; scree check drum_lifters.toml checks it, "
                               "scree run drum_lifters.toml runs it\n")
        deck = self.folder / "drum_lifters.toml"
        first, blank, *rest = deck.read_text().splitlines()
        self.assertRegex(first, r"^# From `scree new drum_lifters`, Scree \d")
        self.assertEqual(blank, "#")
        source = (INPUT / "examples/drum_lifters.toml").read_text()
        self.assertEqual(rest, source.replace("input/examples/drum_lifters.toml", "drum_lifters.toml").splitlines())
        self.expect(DONE, "check", deck)
        self.expect(DONE, "new", "paper/net_9", "mine.toml")
        self.expect(DONE, "check", self.folder / "mine.toml")

    def test_nothing_is_overwritten(self):
        self.assertIn("deck.toml: already exists", self.expect(BAD_INPUT, "new", "drum", "deck.toml").stderr)
        self.assertNotIn("drum", self.deck.read_text())

    def test_what_cannot_be_written_is_one_message(self):
        for code, words, message in ((BAD_INPUT, ["drun"], 'no such example; did you mean "drum"?'),
                                     (IO_FAILED, ["drum", "none/drum.toml"], "none/drum.toml: cannot be written: ")):
            text = self.expect(code, "new", *words).stderr
            self.assertRegex(text, r"^error: .*\n$")
            self.assertIn(message, text)


if __name__ == "__main__":
    unittest.main()
