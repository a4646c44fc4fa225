"""Decks with names of earlier versions: one line in the log for each, and equal results. Usage: as test_cli.py"""

import json
import tomllib
import unittest

from test_cli import BAD_INPUT, DECK, DONE, EXPLICIT, CommandLineTest

LAW = "[[contact.pairs]]\nstiffness = 1e5\ndamping = 3.0\n"
PRESENT = DECK.replace(LAW, LAW + "limit_damping = false\n")
FORMER = DECK.replace(LAW, LAW + "tension = true\n").replace('"ballistic"', '"drift"')
LINE = FORMER[:FORMER.index("tension")].count("\n") + 1
KEY = f"deck.toml:{LINE}:1: contact.pairs.0.tension = true"


class FormerNamesTest(CommandLineTest):
    def told(self, result):
        return [line for line in result.stdout.splitlines() if line.startswith("former name: ")]

    def test_a_deck_with_former_names_has_the_results_of_one_with_the_present_names(self):
        hashes, decks = [], []
        for name, text in (("present", PRESENT), ("former", FORMER)):
            self.deck = self.write("deck.toml", text)
            told = self.told(self.run_deck(DONE, name, *EXPLICIT))
            self.assertEqual(told, [] if name == "present" else [
                f'former name: {self.folder}/deck.toml:10:11: space.leaving = "drift" is now "ballistic"',
                f"former name: {self.folder}/{KEY} is now limit_damping = false"])
            self.assertEqual(self.told(self.expect(DONE, "check", self.deck)), told)
            record = json.loads((self.folder / name / "run_record.json").read_text())
            hashes.append(record["run"]["state_hash"])
            decks.append(tomllib.loads(record["run"]["resolved_deck"]))
        self.assertEqual(*hashes)
        self.assertEqual(*decks)

    def test_a_run_goes_on_with_the_other_names(self):
        whole = (*EXPLICIT, "--set", "output.checkpoint_interval=0.1", "--set", "output.checkpoint_wall_interval=0")
        self.deck = self.write("deck.toml", FORMER)
        self.run_deck(DONE, "out", *whole, "--set", "time.end=0.2")
        self.deck = self.write("deck.toml", PRESENT)
        self.expect(DONE, "run", self.deck, *whole, "--output", self.folder / "out", "--restart",
                    self.folder / "out/checkpoint_end.h5")
        self.run_deck(DONE, "at once", *whole)
        self.assert_same_history("out", "at once")

    def test_both_names_are_refused_and_unknown_ones_stay_unknown(self):
        both = self.write("deck.toml", FORMER.replace("tension", "limit_damping = true\ntension"))
        text = self.expect(BAD_INPUT, "check", both)
        place = KEY.replace(f":{LINE}:", f":{LINE + 1}:")
        self.assertIn(f"{place}: is the former name of limit_damping, which {self.folder}/deck.toml:{LINE}:17 gives, "
                      "too", text.stderr)
        unknown = self.expect(BAD_INPUT, "check", self.write("deck.toml", FORMER.replace("tension", "tensile")))
        self.assertIn("contact.pairs.0.tensile = true: unknown key", unknown.stderr)

    def test_keys_finds_the_present_name(self):
        self.assertIn("contact.pairs.limit_damping\n", self.expect(DONE, "keys", "tension").stdout)


if __name__ == "__main__":
    unittest.main()
