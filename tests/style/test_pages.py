"""Checks of the pages; and that each check finds its errors."""

import unittest

import pages
from test_style import ROOT, tree


class Project(unittest.TestCase):
    """This source tree."""

    def assert_none(self, findings):
        self.assertFalse(findings, "\n" + "\n".join(findings))

    def test_lines_are_short(self):
        self.assert_none(pages.wide_lines(ROOT))

    def test_the_first_page_is_short(self):
        self.assert_none(pages.long_first_page(ROOT))

    def test_links_lead_somewhere(self):
        self.assert_none(pages.dead_links(ROOT))

    def test_numbers_of_the_first_page_stand_where_it_says(self):
        self.assertIn("| **", (ROOT / pages.FIRST).read_text())
        self.assert_none(pages.unfounded_numbers(ROOT))

    def test_instructions_to_add_things_are_true(self):
        self.assert_none(pages.untrue_instructions(ROOT))

    def test_every_page_is_linked(self):
        linked = {}
        for page in pages.pages(ROOT):
            linked[page] = pages.goals(ROOT, page)
        reached, new = set(), {next(page for page in linked if str(page) == pages.FIRST)}
        while new:
            reached |= new
            new = {goal for page in new for goal in linked.get(page, ())} - reached
        self.assertEqual(set(linked) - reached, set())


class Checks(unittest.TestCase):
    """Tests of the checks."""

    def test_widths(self):
        wide = "x" * 133
        with tree(README_DOT_md=f"{wide[:-1]}\n| {wide} |\n```\n{wide}\n```\n    {wide}\n") as root:
            self.assertEqual(pages.wide_lines(root), [])
        with tree(README_DOT_md=f"```\nx\n```\n- {wide}\n") as root:
            self.assertEqual(pages.wide_lines(root), ["README.md:4: 135 columns, at most 132"])

    def test_length_of_the_first_page(self):
        for lines, findings in ((120, 0), (121, 1)):
            with tree(README_DOT_md="x\n" * lines) as root:
                self.assertEqual(len(pages.long_first_page(root)), findings)

    def test_links(self):
        target = "# Ranks, cores and GPUs\n## What a `run` writes\n# Twice\n```\n# no heading\n```\n# Twice\n"
        right = ("[a](jobs/a.md), [b](jobs/a.md#ranks-cores-and-gpus), [c](#here), [d](jobs/a.md#what-a-run-writes), "
                 "[e](https://x.org#y), [f](jobs/a.md#twice-1), ![g](jobs)\n# Here\n```\n[h](none)\n```\n")
        with tree(README_DOT_md=right, jobs__a_DOT_md=target) as root:
            self.assertEqual(pages.dead_links(root), [])
        for wrong in ("jobs/b.md", "jobs/a.md#ranks", "#there", "jobs/a.md#no-heading", "jobs/a.md#twice-2"):
            with self.subTest(wrong=wrong), tree(README_DOT_md=f"[a]({wrong})\n", jobs__a_DOT_md=target) as root:
                self.assertEqual(len(pages.dead_links(root)), 1)

    def test_numbers(self):
        for number, findings in (("9.0e9", 0), ("9.1e9", 1)):
            row = f"| **{number}** | steps per second | [there](a.md#b) |\n"
            with tree(README_DOT_md=row, a_DOT_md="# B\n9.0e9 (111 us)\n") as root:
                self.assertEqual(len(pages.unfounded_numbers(root)), findings)

    def test_instructions(self):
        code = {"src__model__a_DOT_hpp": "struct Thing {};\n", "src__model__b_DOT_cpp": "f(Kind::one);\n"}
        right = "## A thing\n\n- `Thing` in `model/a.hpp`.\n\n## A kind\n\n- `Kind::*` in `model/b.cpp`.\n"
        with tree(src__adding_DOT_md=right, **code) as root:
            self.assertEqual(pages.untrue_instructions(root), [])
        for wrong in (right.replace("`Thing`", "`Thin`"), right.replace("model/a.hpp", "model/b.cpp"),
                      right.replace("`Thing`", "`Thing` of `Kind::*`")):
            with self.subTest(wrong=wrong), tree(src__adding_DOT_md=wrong, **code) as root:
                self.assertTrue(pages.untrue_instructions(root))


if __name__ == "__main__":
    unittest.main()
