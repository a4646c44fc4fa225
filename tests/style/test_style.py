"""Checks of the project's style; and that each check finds its errors."""

import contextlib
import pathlib
import tempfile
import unittest
from unittest import mock

import checks

ROOT = pathlib.Path(__file__).resolve().parents[2]
ORDER = "# Rooms\n\n    base <- model <- { dem, mbs } <- run <- main\n"


@contextlib.contextmanager
def tree(**contents):
    """A source tree of these files; a name's "__" stands for "/", its "_DOT_" for "."."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in {"src__README_DOT_md": ORDER, **contents}.items():
            path = root / name.replace("__", "/").replace("_DOT_", ".")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        yield root


class Project(unittest.TestCase):
    """This source tree."""

    def assert_none(self, findings):
        self.assertFalse(findings, "\n" + "\n".join(findings))

    def test_rooms_include_rooms_to_their_left(self):
        self.assertGreater(len(checks.files(ROOT, checks.CPP, "src")), 100)
        self.assert_none(checks.wrong_includes(ROOT))

    def test_sub_rooms_include_sub_rooms_to_their_left(self):
        self.assert_none(checks.wrong_includes_in_rooms(ROOT))

    def test_every_room_is_in_the_order(self):
        rooms = {path.name for path in (ROOT / "src").iterdir() if path.is_dir()} | {"main"}
        self.assertEqual(rooms, set(checks.room_order(ROOT)))

    def test_files_are_short(self):
        self.assert_none(checks.long_files(ROOT))

    def test_python_lines_are_short(self):
        self.assert_none(checks.long_python_lines(ROOT))

    def test_comparisons_state_their_tolerance(self):
        self.assert_none(checks.default_tolerances(ROOT))

    def test_types_have_one_layout(self):
        self.assert_none(checks.attributes_without_layout(ROOT))

    def test_texts_have_an_encoding(self):
        self.assert_none(checks.texts_without_encoding(ROOT))

    def test_cpp_and_cuda_are_formatted(self):
        self.assert_none(checks.unformatted(ROOT))

    def test_paths_in_pages_are_there(self):
        self.assert_none(checks.missing_paths(ROOT))

    def test_commands_in_pages_are_executable(self):
        self.assert_none(checks.wrong_commands(ROOT))


class Checks(unittest.TestCase):
    """Tests of the checks."""

    def test_an_order_is_read(self):
        with tree() as root:
            order = checks.room_order(root)
        self.assertEqual(order["mbs"], {"base", "model", "mbs"})
        self.assertEqual(order["run"], {"base", "model", "dem", "mbs", "run"})
        with tree(src__README_DOT_md="no order\n") as root, self.assertRaises(ValueError):
            checks.room_order(root)

    def test_includes(self):
        right = {"src__dem__a_DOT_cpp": '#include "base/x.hpp"\n#include "dem/y.hpp"\n#include <run/z.hpp>\n',
                 "src__main_DOT_cpp": '#include "run/x.hpp"\n', "cuda__own_DOT_cuh": "",
                 "cuda__a_DOT_cu": '#include "own.cuh"\n#include "dem/x.hpp"\n',
                 "tests__a_DOT_cpp": '#include "run/x.hpp"\n#include "own.cuh"\n'}
        with tree(**right) as root:
            self.assertEqual(checks.wrong_includes(root), [])
        for name, include in (("src__base__a_DOT_cpp", "model/x.hpp"), ("src__dem__a_DOT_hpp", "mbs/x.hpp"),
                              ("src__mbs__a_DOT_hpp", "dem/x.hpp"), ("src__dem__a_DOT_cpp", "own.cuh"),
                              ("src__run__a_DOT_cpp", "../cuda/own.cuh"), ("src__run__a_DOT_cpp", "cuda/own.cuh"),
                              ("cuda__b_DOT_cu", "run/x.hpp"), ("cuda__b_DOT_cu", "mbs/x.hpp"),
                              ("src__new__a_DOT_cpp", "base/x.hpp")):
            with self.subTest(name=name, include=include), tree(**right) as root:
                path = root / name.replace("__", "/").replace("_DOT_", ".")
                path.parent.mkdir(exist_ok=True)
                path.write_text(f'\n#  include "{include}"\n')
                self.assertTrue(checks.wrong_includes(root))

    def test_includes_in_rooms(self):
        right = {"src__dem__README_DOT_md": "    contact <- { explicit, implicit } <- cpu\n",
                 "src__dem__explicit__a_DOT_hpp": '#include "dem/contact/x.hpp"\n#include "base/x.hpp"\n',
                 "src__dem__cpu__a_DOT_cpp": '#include "dem/cpu/a.hpp"\n#include "dem/implicit/x.hpp"\n',
                 "src__base__a_DOT_hpp": ""}
        with tree(**right) as root:
            self.assertEqual(checks.wrong_includes_in_rooms(root), [])
        for name, include in (("src__dem__contact__a_DOT_hpp", "dem/cpu/x.hpp"),
                              ("src__dem__implicit__a_DOT_hpp", "dem/explicit/x.hpp"),
                              ("src__dem__cpu__a_DOT_hpp", "dem/x.hpp"), ("src__dem__a_DOT_hpp", "base/x.hpp"),
                              ("src__dem__new__a_DOT_hpp", "base/x.hpp")):
            with self.subTest(name=name, include=include), tree(**right) as root:
                path = root / name.replace("__", "/").replace("_DOT_", ".")
                path.parent.mkdir(exist_ok=True)
                path.write_text(f'#include "{include}"\n')
                self.assertTrue(checks.wrong_includes_in_rooms(root))
        with tree(src__dem__cpu__a_DOT_hpp="", src__dem__README_DOT_md="no order\n") as root:
            self.assertRaises(ValueError, checks.wrong_includes_in_rooms, root)

    def test_lengths(self):
        with tree(a_DOT_py="x\n" * 400 + "", b_DOT_md="x\n" * 500, c_DOT_py="x" * 120 + "\n") as root:
            self.assertEqual(checks.long_files(root) + checks.long_python_lines(root), [])
        for suffix in ("cpp", "hpp", "cu", "cuh", "py", "sh"):
            with tree(**{f"a_DOT_{suffix}": "x\n" * 401}) as root:
                self.assertEqual(checks.long_files(root), [f"a.{suffix}: 401 lines, at most 400"])
        with tree(a_DOT_py="\n" + "x" * 121 + "\n") as root:
            self.assertEqual(checks.long_python_lines(root), ["a.py:2: 121 columns, at most 120"])

    def test_tolerances(self):
        right = ("CHECK(f(1) == Approx(g(2) * (1 - h())).epsilon(1e-12));\n"
                 "CHECK(a == Catch::Approx(0)\n    .margin(kUlp));\n")
        with tree(tests__a_DOT_cpp=right, src__a_DOT_cpp="Approx(1)") as root:
            self.assertEqual(checks.default_tolerances(root), [])
        for wrong in ("CHECK(a == Approx(g(2)));", "CHECK(a == Catch::Approx(1).scale(2));", "Approx(1", "Approx{1}"):
            with self.subTest(wrong=wrong), tree(tests__a_DOT_hpp=right + wrong) as root:
                self.assertEqual(checks.default_tolerances(root), [
                    "tests/a.hpp:4: Approx with the default tolerance; state .epsilon() or .margin()"])

    def test_layouts(self):
        member = "  [[no_unique_address]] B b;\n"
        with tree(src__a_DOT_hpp="struct A {\n" + member + "};\n", tests__a_DOT_hpp=member) as root:
            self.assertEqual(checks.attributes_without_layout(root), ["src/a.hpp:2: [[no_unique_address]]"])

    def test_encodings(self):
        right = 'open("a", "rb"); open("a", encoding="utf-8"); p.read_text(encoding="utf-8"); run.open("folder")\n'
        for wrong in ('open("a")', 'open("a", "w")', "p.read_text()", 'p.write_text("a")', "run(words, text=True)"):
            with tree(postprocess__a_DOT_py=right + wrong, jobs__b_DOT_py=right, tests__c_DOT_py=wrong) as root:
                self.assertEqual(checks.texts_without_encoding(root), ["postprocess/a.py:2: a text without encoding="])

    def test_format(self):
        style = "BasedOnStyle: Google\n"
        with tree(_DOT_clang_DOT_format="", src__a_DOT_cpp="int a = 1;\n", tests__a_DOT_cu="int b;\n") as root:
            (root / ".clang-format").write_text(style)
            self.assertEqual(checks.unformatted(root), [])
            (root / "tests/a.cu").write_text("int  b;\n")
            self.assertEqual(len(checks.unformatted(root)), 1)
            self.assertIn("tests/a.cu:1", checks.unformatted(root)[0])
        with mock.patch("shutil.which", return_value=None):
            with self.assertRaisesRegex(FileNotFoundError, "apt-get install clang-format"):
                checks.clang_format()

    def test_paths(self):
        sources = {"src__dem__a_DOT_hpp": "", "jobs__run_DOT_sh": "", "jobs__README_DOT_md": ""}
        right = ("`dem/a.hpp`, `src/dem/`, `jobs/run.sh --fast`, `a.hpp`, `dem/*.hpp`, `dem/{a,a}.hpp`, `build/x.cpp`, "
                 "`out.h5`, `case/run.h5`, `a = b`, `/proc/x.sh`\n```\njobs/none.sh\n```\n")
        with tree(README_DOT_md=right, **sources) as root:
            self.assertEqual(checks.missing_paths(root), [])
        for wrong in ("`dem/b.hpp`", "`src/none/`", "`jobs/gone.sh --fast`", "`b.hpp`", "`dem/*.cpp`"):
            with self.subTest(wrong=wrong), tree(README_DOT_md=f"See {wrong}.\n", **sources) as root:
                self.assertEqual(len(checks.missing_paths(root)), 1)

    def test_commands(self):
        text = "Run `tests/a.py PROGRAM` or\n    tests/b.sh --fast\n    python3 tests/c.py IT\n`tests/c.py` is it.\n"
        with tree(README_DOT_md=text, tests__a_DOT_py="", tests__b_DOT_sh="", tests__c_DOT_py="") as root:
            self.assertEqual(len(checks.wrong_commands(root)), 2)
            for name in ("a.py", "b.sh"):
                (root / "tests" / name).chmod(0o755)
            self.assertEqual(checks.wrong_commands(root), [])


if __name__ == "__main__":
    unittest.main()
