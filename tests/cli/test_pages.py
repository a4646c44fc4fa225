"""What the pages show of the program is what it does. Usage: as test_cli.py"""

import pathlib
import re
import unittest

from test_cli import DONE, CommandLineTest

ROOT = pathlib.Path(__file__).resolve().parents[2]


class PagesTest(CommandLineTest):
    def test_the_deck_of_the_first_page_runs_without_a_warning(self):
        deck = re.search(r"^```toml\n(.*?)^```", (ROOT / "README.md").read_text(), re.DOTALL | re.MULTILINE)[1]
        path = self.write("page.toml", deck)
        for words in (("check", path), ("run", path, "--set", "time.end=0.2", "--output", self.folder / "page")):
            ended = self.expect(DONE, *words)
            self.assertNotIn("warning", ended.stdout + ended.stderr)

    def test_the_worked_example_is_what_the_check_says(self):
        deck = ROOT / "input/examples/glass_beads.toml"
        page = (ROOT / "input/choosing.md").read_text()
        said = self.expect(DONE, "check", deck).stdout
        shown = re.search(r"^```\n(contact .*?)^```", page, re.DOTALL | re.MULTILINE)[1]
        self.assertIn(shown, said)

        rows = re.findall(r"^ *\| ([\d.]+) ([GM])Pa \| [^|]+ \| (\S+) s \| (\S+) s \| (\S+) s \|", page, re.MULTILINE)
        self.assertEqual(len(rows), 4)
        for number, unit, contact, step, limit in rows:
            modulus = f"{number}e{9 if unit == 'G' else 6}"
            said = self.expect(DONE, "check", deck, "--set", f"materials.glass.young_modulus={modulus}").stdout
            self.assertIn(f"shortest contact {contact} s", said)
            self.assertIn(f"steps up to {step} s: error at most 2 %", said)
            self.assertIn(f"in dense contact: steps up to {limit} s", said)


if __name__ == "__main__":
    unittest.main()
