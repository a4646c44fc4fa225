"""The tables of documents agree with the data and the sources; the script that makes them finds errors."""

import contextlib
import io
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support"), str(ROOT / "tests/verification")]
import measured  # noqa: E402
import page_tables  # noqa: E402
import table  # noqa: E402


def row(key, value="", unit="", **others):
    return dict.fromkeys(measured.COLUMNS, "") | {
        "key": key, "value": value, "unit": unit, "least": value, "most": value, "commit": "0123456789ab",
        "machine": "one", "backend": "cpu", "command": "test"} | others


def filled(template, *rows, digits=None, what="measured"):
    """The text of a template, and the findings."""
    tables = page_tables.Tables({}, rows, digits)
    return tables.fill(template, [], what), tables.problems


class Folder(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)


class Pages(unittest.TestCase):
    def test_are_current(self):
        for script in ("verification/table.py", "performance/tables.py"):
            done = subprocess.run([sys.executable, ROOT / "tests" / script, "--check"], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stdout + done.stderr), (0, ""), script)

    def test_rows_keep_what_is_demanded(self):
        for name in ("verification", "performance"):
            self.assertEqual([one["key"] for one in measured.read(ROOT / "tests" / name / "measured.csv")
                              if not measured.keeps(one)], [])


class Numbers(unittest.TestCase):
    def test_digits(self):
        for value, digits, text in (("8.4213e-06", 2, "8.4e-6"), ("2928", 4, "2,928"), ("0.0123", 2, "0.012"),
                                    ("1.998", 3, "2"), ("0", 2, "0"), ("1e-10", 4, "1e-10"), ("1234567", 3, "1.23e6")):
            self.assertEqual(page_tables.round_to(value, digits), text)
        for value, text in (("9.0e9", "9.0e9"), ("1.93e+07", "1.93e7"), ("1167", "1,167"), ("0.50", "0.50"),
                            ("3e-06", "3e-6")):
            self.assertEqual(page_tables.as_it_is(value), text)

    def test_forms(self):
        error = row("a/error", "3.14159e-05", "m", at_most="1e-04")
        order = row("a/order", least="1.9512", most="2.0401", at_least="1.95", at_most="2.05")
        self.assertEqual(filled("{a/error}, order {a/order}", error, order, digits=2),
                         ("3.1e-5 m, order 1.95 to 2.04", []))
        self.assertEqual(filled("{a/error}, order {a/order}", error, order, digits=2, what="demanded"),
                         ("1e-4 m, order 1.95 to 2.05", []))
        self.assertEqual(filled("{a/error|%}; {a/error|number}", error, digits=2), ("0.0031 %; 3.1e-5", []))
        bits, free = row("a/bits", "0", "bits", at_most="0"), row("a/free", "3.5")
        self.assertEqual(filled("{a/bits}, {a/free}", bits, free), ("the same bits, 3.5", []))
        self.assertEqual(filled("{a/bits}, {a/free}", bits, free, what="demanded"), ("bit for bit, -", []))

    def test_comparisons(self):
        rows = row("a", "7.5", "ms"), row("b", "500", "us"), row("c", "119.7", "us"), row("d", "112.1", "us")
        self.assertEqual(filled("{a|over b}, {c|above d}", *rows), ("15, +6.8 %", []))
        self.assertEqual(filled("{a|optional}, {none|optional}, {a|optional over b}, {a|optional over none}", *rows),
                         ("7.5 ms, -, 15, -", []))
        text, problems = filled("{a|over none}", *rows)
        self.assertEqual((text, problems), ("?", ["none: no such row"]))


class Tables(Folder):
    LAYOUT = ('kept = ["old/"]\n[one]\npage = "page.md"\ncolumns = ["what", "then", "now"]\n'
              'cells = ["{old/$}", "{new/$}"]\n[[one.rows]]\ntitle = "x"\nparts = ["p", "q"]\n')
    PAGE = "# A\n<!-- table one -->\n<!-- end of table one -->\nB\n"
    SOURCE = 'CHECK(measured("new/p", "m", at_most(x, 1)));\nnote("new/" + name, "", x);\n'

    def make(self, *words, **files):
        """Runs on a tree; exit code and findings."""
        for name, text in {"layout.toml": self.LAYOUT, "page.md": self.PAGE, "a.cpp": self.SOURCE}.items():
            path = self.folder / name
            if name in files or not path.exists():
                path.write_text(files.get(name, text))
        rows = files.get("rows", [row("old/p", "1"), row("old/q", "2"), row("new/p", "3", commit="abcdef0123"),
                                  row("new/q", "4", machine="two")])
        measured.write(self.folder / "data.csv", rows)
        out = io.StringIO()
        with mock.patch.object(sys, "argv", ["tables.py", *words]), contextlib.redirect_stdout(out):
            code = page_tables.run("", self.folder, "layout.toml", "data.csv", ["."])
        return code, out.getvalue().splitlines()

    def test_a_page_is_made_once_and_checked(self):
        self.assertEqual(self.make("--check"), (1, ["page.md: a table is not what data.csv gives"]))
        self.assertEqual(self.make(), (0, []))
        self.assertEqual((self.folder / "page.md").read_text(), (
            "# A\n<!-- table one -->\n| what | then | now | commit, machine |\n|---|---|---|---|\n"
            "| x | 1; 2 | 3; 4 | 0123456, one and two; abcdef0, one |\n<!-- end of table one -->\nB\n"))
        self.assertEqual(self.make("--check"), (0, []))
        self.assertEqual(self.make("--check", rows=[row("old/p", "1"), row("old/q", "2"), row("new/p", "3"),
                                                    row("new/q", "5")])[0], 1)

    def test_what_is_missing_is_named(self):
        self.assertEqual(self.make(rows=[row("old/p", "1"), row("new/p", "3"), row("new/q", "4")]),
                         (1, ["old/q: no such row"]))
        self.assertNotIn("| x |", (self.folder / "page.md").read_text())
        more = [row("old/p", "1"), row("old/q", "2"), row("new/p", "3"), row("new/q", "4"), row("new/r", "5")]
        self.assertEqual(self.make(rows=more), (1, ["new/r: no table shows it"]))
        self.assertIn("page.md: must have once <!-- table one --> and <!-- end of table one -->",
                      self.make(**{"page.md": "# A\n"})[1])

    def test_rows_of_which_nothing_was_measured_yet_are_left_out(self):
        layout = self.LAYOUT.replace("{new/$}", "{new/$|optional}").replace("{old/$}", "{old/$|optional}")
        layout += '[[one.rows]]\ntitle = "y"\nparts = ["r"]\n[[one.rows]]\ntitle = "z"\ncells = ["-", ""]\n'
        self.assertEqual(self.make(**{"layout.toml": layout}, rows=[row("old/p", "1"), row("new/q", "4")],
                                   **{"a.cpp": 'note("new/" + name, "", x);\n'}), (0, []))
        self.assertEqual((self.folder / "page.md").read_text().splitlines()[4:6],
                         ["| x | 1; - | -; 4 | 0123456, one |", "| z | - |  |  |"])

    def test_sources_and_data_agree(self):
        self.make()
        self.assertEqual(self.make(**{"a.cpp": 'CHECK(measured("new/p", "m", x));\n'}),
                         (1, ["new/q: nothing in the sources writes it"]))
        wide = self.SOURCE + 'measured.note(f"other/{size} step", 1)\nnote("new/s", "", 1);\n'
        self.assertEqual(self.make(**{"a.cpp": wide}), (1, [
            "new/s: the sources write it, and the data have no row",
            "other/: the sources write such keys, and the data have no row"]))


class Rows(Folder):
    def test_files_that_are_none_of_ours_are_named(self):
        path = self.folder / "data.csv"
        for text, message in (("key,value\na,1\n", "its columns must be"),
                              (",".join(measured.COLUMNS) + "\na,1\n", ":2: must have 12 cells"),
                              (",".join(measured.COLUMNS) + "\na,x" + "," * 10 + "\n", ":2: value is x"),
                              (",".join(measured.COLUMNS) + "\na,1" + "," * 10 + "\n", ":2: has no commit")):
            path.write_text(text)
            with self.assertRaisesRegex(SystemExit, message):
                measured.read(path)

    def test_new_rows_replace_those_of_their_key_and_backend(self):
        data, new = self.folder / "data.csv", self.folder / "new"
        new.mkdir()
        measured.write(data, [row("a", "1"), row("a", "2", backend="cuda")])
        measured.write(new / "x.csv", [row("b", "3"), row("a", "4", commit="new")])
        for also_new, counts, more in ((False, (1, 1), []), (True, (2, 0), [("b", "cpu", "3", "0123456789ab")])):
            self.assertEqual(measured.merge(data, new, also_new), counts)
            self.assertEqual([(one["key"], one["backend"], one["value"], one["commit"]) for one in measured.read(data)],
                             [("a", "cpu", "4", "new"), ("a", "cuda", "2", "0123456789ab"), *more])
        for bad, message in (({"at_most": "2"}, "b is not what was demanded"),
                             ({"commit": "ab-modified"}, "b is of commit ab-modified")):
            measured.write(new / "x.csv", [row("b", "3", **bad)])
            with self.assertRaisesRegex(SystemExit, message):
                measured.merge(data, new, True)

    def test_scripts_leave_rows_where_they_are_asked_to(self):
        words = [sys.executable, ROOT / "tests/support/measured.py", "a/b", "3.5", "s", "--least", "3", "--command",
                 "run.sh --fast"]
        environment = {name: value for name, value in os.environ.items() if name != "SCREE_MEASURED"}
        subprocess.run(words, check=True, env=environment, cwd=self.folder)
        self.assertEqual(list(self.folder.iterdir()), [])
        for _ in range(2):
            subprocess.run(words, check=True, env=environment | {"SCREE_MEASURED": str(self.folder / "out")})
        (one,) = measured.read(self.folder / "out" / "run_sh_--fast.csv")
        self.assertEqual([one[name] for name in ("key", "value", "unit", "least", "most", "backend", "command")],
                         ["a/b", "3.5", "s", "3", "3.5", "cpu", "run.sh --fast"])
        self.assertEqual(one["machine"], measured.processor())

    def test_other_demands_are_found(self):
        name = "test_verification_a"
        data = [row("a", "1", at_most="2", command=name), row("b", "1", command=name), row("c", "1")]
        self.assertEqual(table.other_demands(data, self.folder), [f"{name} has left no rows"])
        measured.write(self.folder / f"{name}.csv", [row("a", "1.5", at_most="2", command=name),
                                                     row("b", "7", command=name)])
        self.assertEqual(table.other_demands(data, self.folder), [])
        measured.write(self.folder / f"{name}.csv", [row("a", "1.5", at_most="3", command=name),
                                                     row("d", "1", command=name)])
        self.assertEqual(table.other_demands(data, self.folder), [
            f"a: at_most is 3 in {name}, 2 in tests/verification/measured.csv",
            f"d: {name} writes it, and tests/verification/measured.csv has no such row",
            f"b: {name} no longer writes it"])


if __name__ == "__main__":
    unittest.main()
