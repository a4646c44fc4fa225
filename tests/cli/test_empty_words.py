"""An empty word in the place of a name or a path, as of a script's variable that is not set, is refused.
Usage: as test_cli.py"""

import unittest

from test_cli import BAD_INPUT, DONE, CommandLineTest

SHORT = ("--set", "time.end=0.01")


class EmptyWordsTest(CommandLineTest):
    def test_every_option_that_takes_a_name(self):
        run, check = ("run", self.deck, *SHORT), ("check", self.deck)
        for words, named in (((*run, "--restart", ""), "--restart"), ((*run, "--restart="), "--restart"),
                             ((*run, "--restart", "", "--overwrite"), "--restart"),
                             ((*run, "--restart", "", "--allow-changes"), "--restart"),
                             ((*run, "--output", ""), "--output"), ((*run, "--output="), "--output"),
                             ((*run, "--output=", "--overwrite"), "--output"), ((*run, "--output", " "), "--output"),
                             ((*run, "--restart=", "--overwrite"), "--restart"), (("keys", " "), "word"),
                             ((*run, "--backend", ""), "--backend"), ((*run, "--set", ""), "--set"),
                             (("run", ""), "deck"), (("check", ""), "deck"), ((*check, "--set", ""), "--set"),
                             ((*check, "--picture", ""), "--picture"), (("new", ""), "example"),
                             (("new", "pendulum", ""), "file"), (("status", ""), "folder"),
                             (("status", self.folder, ""), "folder"), ((*run, "--", ""), "PETSc option")):
            with self.subTest(words=words):
                before = sorted(self.folder.rglob("*"))
                result = self.expect(BAD_INPUT, *words)
                self.assertRegex(result.stderr, "^error: [^\n]*\n$")
                self.assertIn(named, result.stderr)
                if words[-2] != "--":  # those for PETSc are read when the model stands
                    self.assertEqual(result.stdout, "")
                self.assertEqual(sorted(self.folder.rglob("*")), before)

    def test_what_was_to_go_on_is_not_begun_anew(self):
        self.run_deck(DONE, "out", *SHORT)
        before = {path.name: path.read_bytes() for path in (self.folder / "out").iterdir()}
        result = self.run_deck(BAD_INPUT, "out", *SHORT, "--restart", "")  # with --overwrite
        self.assertIn("--restart: is empty", result.stderr)
        self.assertEqual({path.name: path.read_bytes() for path in (self.folder / "out").iterdir()}, before)


if __name__ == "__main__":
    unittest.main()
