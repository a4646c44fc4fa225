"""Parameter studies: lists of runs, these on one machine, and their tables.

    SCREE=build/release/scree python3 tests/postprocess/test_studies.py

Needs postprocess/requirements.txt."""

import contextlib
import io
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "postprocess"))

import pandas
import scree

PROGRAM = os.environ["SCREE"]
DECK = ROOT / "input/paper/net_9.toml"
QUICK = {"time.end": 0.01, "time.step": 1e-3}
LIMIT = 60  # [s]


class FolderTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="scree_studies_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


class ListTest(FolderTest):
    def test_a_list_of_runs_and_their_table(self):
        path, study = self.folder / "list", self.folder / "study"
        deck = DECK.with_name("net_9.toml")
        count = scree.sweep.write_list(path, deck, {"time.step": [1e-3, np.float64(5e-4)],
                                                    "space.leaving": ["ballistic", "remove"]})
        lines = path.read_text().splitlines()
        self.assertEqual((count, len(lines)), (4, 4))
        self.assertEqual(lines[1], f"{deck} --set time.step=0.001 --set space.leaving=remove")
        path.write_text("# first\n" + path.read_text())  # as jobs/array.sbatch takes it
        for element in (2, 4):
            subprocess.run([PROGRAM, "run", *lines[element - 2].split(), "--set", "time.end=0.01", "--output",
                            study / str(element)], check=True, timeout=LIMIT, stdout=subprocess.DEVNULL)
        steps = {"steps": lambda run: run.history["step/steps"][-1]}
        table = scree.sweep.table(path, study, steps)
        self.assertEqual(list(table.index), [2, 3, 4, 5])
        self.assertEqual(list(table["status"]), ["done", "not begun", "done", "not begun"])
        self.assertEqual((table["steps"][2], table["steps"][4], table["time.step"][4]), (10, 20, 5e-4))
        self.assertTrue(np.isnan(table["steps"][5]))
        for nothing in (lambda run: run.history["nothing"][-1], lambda run: run.history["step/steps"][100]):
            with self.assertRaisesRegex(scree.ScreeError, 'study/2: measure "nothing": '):
                scree.sweep.table(path, study, steps | {"nothing": nothing})

    def test_lists_are_the_same_in_every_locale(self):
        """Python's encoding of texts in these is ASCII, as it is Latin-1 in a Latin-1 locale."""
        script = self.folder / "study.py"
        script.write_text("""if True:
            import os, pathlib, sys, warnings
            sys.path.insert(0, sys.argv[1])
            import pandas, scree
            warnings.simplefilter("error", EncodingWarning)
            deck = scree.Deck.read(os.fsdecode(os.fsencode(sys.argv[2])))
            deck.update({"time.end": 0.002, "time.step": 1e-3, "title": "Strömung λ"})
            path = pathlib.Path(sys.argv[3])
            count = scree.sweep.write_list(path, deck, {"title": ["größer", "λ"], "bodies.net.mass": [1.0, -1]})
            failed = scree.sweep.run_local(path, path.with_name("runs"), quiet=True)
            assert sorted(failed) == [2, 4] and "above 0" in failed[2], failed
            assert scree.sweep.run_local(path, path.with_name("runs"), quiet=True).keys() == {2, 4}
            table = scree.sweep.table(path, path.with_name("runs"), {"rows": lambda run: run.history.rows})
            assert list(table["title"])[2] == "λ" and table["status"][1] == "done", table
            assert scree.open(path.with_name("runs") / "1").title == "größer"
        """, encoding="utf-8")
        folder = os.fsencode(self.folder) + "/größe_λ".encode()
        os.mkdir(folder)
        words = [os.fsencode(ROOT / "postprocess"), os.fsencode(DECK), folder + "/liste_ö.txt".encode()]
        for options, locale in ((["-X", "utf8=0"], "C"), (["-X", "utf8=1"], "C.utf8")):
            found = subprocess.run([sys.executable, "-X", "warn_default_encoding", *options, script, *words],
                                   env=os.environ | {"LC_ALL": locale, "PYTHONCOERCECLOCALE": "0", "SCREE": PROGRAM},
                                   capture_output=True, text=True, errors="replace")
            self.assertEqual(found.returncode, 0, found.stderr)

    def test_words_of_a_list_have_no_blanks(self):
        self.assertEqual([scree.sweep.word(value) for value in (True, 2, [0.5, 0], "hht")],
                         ["true", "2", "[0.5,0]", "hht"])
        for value in ("two words", ""):
            with self.assertRaisesRegex(scree.ScreeError, "without blanks"):
                scree.sweep.word(value)


class StudyTest(FolderTest):
    def test_on_this_machine(self):
        deck, path, results = scree.Deck.read(DECK), self.folder / "list.txt", self.folder / "study"
        deck.update(QUICK)
        keys = {"time.step": [1e-3, 5e-4], "bodies.net.mass": [1.0, -1]}
        self.assertEqual(scree.sweep.write_list(path, deck, keys), 4)
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            failed = scree.sweep.run_local(path, results, at_once=2, scree=PROGRAM)
        for line in (" of 4: run 1 done, ", " of 4: run 2 failed, "):
            self.assertIn(line, said.getvalue())
        self.assertEqual(sorted(failed), [2, 4])
        self.assertIn("bodies.net.mass must be a number above 0", failed[2])
        table = scree.sweep.table(path, results, {"steps": lambda run: run.history["step/steps"][-1]})
        self.assertEqual(list(table), ["time.step", "bodies.net.mass", "status", "steps"])
        self.assertEqual(list(table["status"][[1, 3]]), ["done", "done"])
        self.assertRegex(table["status"][2], "^failed: .*bodies.net.mass must be a number above 0")
        self.assertEqual(list(table["steps"].dropna()), [10, 20])
        told = subprocess.run([PROGRAM, "status", *sorted(results.iterdir())], capture_output=True, text=True)
        self.assertEqual([name in told.stdout for name in ("study/1 ", "study/3 ", "log")], [True, True, False])
        stamps = [(results / f"{element}/run_record.json").stat().st_mtime_ns for element in (1, 3)]
        path.write_text(path.read_text().replace("=-1", "=2.0"))
        self.assertEqual(scree.sweep.run_local(path, results, scree=PROGRAM, quiet=True), {})
        self.assertEqual([(results / f"{element}/run_record.json").stat().st_mtime_ns for element in (1, 3)], stamps)
        deck["time.end"] = 0.02
        deck.write(path.with_suffix(".toml"))
        failed = scree.sweep.run_local(path, results, scree=PROGRAM, quiet=True)  # each from its checkpoint
        self.assertEqual(failed, {})
        table = scree.sweep.table(path, results, {"steps": lambda run: run.history["step/steps"][-1]})
        self.assertEqual(list(table["steps"]), [20, 20, 40, 40])

    def test_of_decks_made_in_python(self):
        decks = {}
        for count in (1, 2):
            decks[f"block_{count}"] = scree.Deck.read(DECK)
            decks[f"block_{count}"]["particles.block.size"] = [count, count]
        path = self.folder / "sizes.txt"
        self.assertEqual(scree.sweep.write_decks(path, decks), 2)
        self.assertEqual(path.read_text().splitlines()[1], str(self.folder / "sizes/block_2.toml"))
        table = scree.sweep.table(path, self.folder / "none", {})
        self.assertEqual([list(table[name]) for name in table], [["block_1", "block_2"], ["not begun"] * 2])

    def test_a_copy_of_the_example(self):
        """Anywhere in the repository; outside, without the package, it says what to do."""
        text = (ROOT / "jobs/study.py").read_text()
        inside = self.folder / "tree/deep/down"
        inside.mkdir(parents=True)
        (self.folder / "tree/postprocess").symlink_to(ROOT / "postprocess")
        for place, code, words in ((inside, 0, ""), (self.folder, 1, "pip install REPOSITORY/postprocess")):
            (place / "mine.py").write_text(text)
            found = subprocess.run([sys.executable, place / "mine.py", "--help"], capture_output=True, text=True)
            self.assertEqual(found.returncode, code, found.stderr)
            self.assertIn(words, found.stderr)

    def test_the_example_from_list_to_table(self):
        def study(*words):
            subprocess.run([sys.executable, ROOT / "jobs/study.py", *words], check=True, cwd=ROOT, timeout=LIMIT,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

        path, results, csv = (str(self.folder / name) for name in ("study.txt", "results", "study.csv"))
        study("write", path, "--set", "time.end=2e-4", "particles.grains.size=[2,2,1]")
        study("run", path, results, "--at-once", "2")
        study("table", path, results, csv)
        table = pandas.read_csv(csv)
        self.assertEqual(list(table["status"]), ["done"] * 6)
        self.assertEqual(sorted(set(table["contact.pairs.0.friction"])), [0.1, 0.3, 0.5])
        self.assertTrue({"escaped", "pull [N]", "work [J]"} <= set(table))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
