"""The project's words, looked up; and that the check finds what it is there for."""

import unittest

import words
from test_style import ROOT, tree


class Project(unittest.TestCase):
    """This source tree."""

    def test_code_and_pages_use_the_terms_of_the_field(self):
        findings = words.private_words(ROOT)
        self.assertFalse(findings, "\n" + "\n".join(findings))


class Checks(unittest.TestCase):
    """The check itself."""

    def test_words(self):
        self.assertEqual(words.parts("kRubbingPair_of2JKRContacts"), ["k", "rubbing", "pair", "of", "jkr", "contacts"])
        for right in ("int rubric, scrub;", "// the frictional force", "skin kinetic necklace", "to give the way"):
            with self.subTest(right=right), tree(src__a_DOT_hpp=right + "\n") as root:
                self.assertEqual(words.private_words(root), [])
        for wrong in ("StepRub step;", "kRubbingPair", "body_rubs(1)", "// it Gives way here", "find_kin"):
            with self.subTest(wrong=wrong), tree(src__a_DOT_hpp=f"\n{wrong}\n", src__b_DOT_md="x\n") as root:
                findings = words.private_words(root)
                self.assertEqual(len(findings), 1)
                self.assertTrue(findings[0].startswith("src/a.hpp:2: "))
        with tree(CHANGELOG_DOT_md="rub\n") as root:
            self.assertEqual(words.private_words(root), [])


if __name__ == "__main__":
    unittest.main()
