"""What cmake --install leaves, moved to another folder and used from there. Usage: python3 test_install.py BUILD"""

import filecmp
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv[1]).resolve()
OURS = ("SCREE", "SLURM_", "PYTHON")  # in the environment: what would lead away from what is installed
ENVIRONMENT = {name: value for name, value in os.environ.items() if not name.startswith(OURS)}
ENVIRONMENT.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", SCREE_LAUNCHER="env",
                   SLURM_JOB_ID="7")


class InstallTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="scree_install_")
        cls.addClassCleanup(folder.cleanup)
        cls.first, cls.prefix = pathlib.Path(folder.name) / "first", pathlib.Path(folder.name) / "moved here"
        subprocess.run(["cmake", "--install", BUILD, "--prefix", cls.first], check=True, stdout=subprocess.DEVNULL)
        cls.first.rename(cls.prefix)
        cls.share = cls.prefix / "share/scree"
        cls.deck = cls.share / "input/examples/pendulum.toml"

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="scree_installed_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_program(self, *words, code=0, **environment):
        ended = subprocess.run([str(word) for word in words], cwd=self.folder, env={**ENVIRONMENT, **environment},
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60)
        self.assertEqual(ended.returncode, code, ended.stdout)
        return ended.stdout

    def assert_done(self, results):
        self.assertEqual(json.loads((self.folder / results / "run_record.json").read_text())["run"]["status"], "done")

    def test_the_program_runs_a_deck(self):
        self.run_program(self.prefix / "bin/scree", "run", self.deck, "--set", "time.end=0.01", "--output", "out")
        self.assert_done("out")

    def test_nothing_names_the_trees_that_it_came_from(self):
        stripped = self.folder / "scree"
        # Without the lines of sources that a debugger wants.
        subprocess.run(["strip", "-o", stripped, self.prefix / "bin/scree"], check=True)
        files = [path for path in self.prefix.rglob("*") if path.is_file() and path.name != "scree"]
        self.assertGreater(len(files), 50)
        for path in [stripped, *files]:
            content = path.read_bytes()
            for tree in (ROOT, BUILD, self.first):
                self.assertNotIn(str(tree).encode(), content, path)

    def test_the_manual_page_has_all_commands_and_options(self):
        page = (self.prefix / "share/man/man1/scree.1").read_text().replace("\\-", "-")
        scree = self.prefix / "bin/scree"
        self.assertIn(self.run_program(scree, "--version").split(" (")[0], page)
        text = self.run_program(scree, "--help")
        commands = re.findall(r"^  ([a-z]+) ", text.partition("Subcommands:")[2], re.M)
        self.assertIn("run", commands)
        for command in commands:
            self.assertIn(f".SH SCREE {command.upper()}\n", page)
            text += self.run_program(scree, command, "--help")
        options = set(re.findall(r"^ {2}.*?(--[a-z-]+)", text, re.M))
        self.assertIn("--restart", options)
        for option in options:
            self.assertRegex(page, rf"(?m)^\.B .*{option}\b")

    def test_decks_and_the_python_package_are_those_of_the_source(self):
        for folder in ("input", "postprocess/scree"):
            names, installed = ({str(path.relative_to(tree)) for path in (tree / folder).rglob("*") if path.is_file()}
                                for tree in (ROOT, self.share))
            names = {name for name in names if "__pycache__" not in name}
            self.assertEqual(installed, names)
            self.assertEqual(filecmp.cmpfiles(ROOT, self.share, names, shallow=False)[1:], ([], []))
        self.assertTrue((self.share / "postprocess/pyproject.toml").exists())

    def test_jobs_find_each_other_and_the_program(self):
        jobs = self.share / "jobs"
        log = self.run_program("bash", jobs / "one_node.sbatch", self.deck, "out", "--set", "time.end=0.01")
        self.assertIn("begins", log)
        self.assert_done("out")
        for script in ("slurm_run.sh", "mapping.sh"):
            self.assertTrue(os.access(jobs / script, os.X_OK), script)

    def test_jobs_find_each_other_from_the_copy_that_slurm_runs(self):
        jobs = self.folder / "jobs"  # SLURM's record of a job ends the file's name at a blank
        shutil.copytree(self.share / "jobs", jobs)
        scontrol = self.folder / "bin/scontrol"
        scontrol.parent.mkdir()
        for name in ("one_node", "several_nodes", "long"):
            record = f"JobId=7 JobName=scree\n   Command={jobs}/{name}.sbatch deck.toml out\n   WorkDir=/\n"
            scontrol.write_text(f"#!/bin/sh\n[ \"$*\" = 'show job 7' ] && printf '{record}\n{record}'\n")
            scontrol.chmod(0o755)
            shutil.copy(jobs / f"{name}.sbatch", self.folder / "slurm_script")
            log = self.run_program("bash", "slurm_script", self.deck, "out", "--set", "time.end=0.01",
                                   SCREE="/bin/true", PATH=f"{scontrol.parent}:{os.environ['PATH']}")
            self.assertIn("job 7: ", log)

    def test_a_program_that_is_not_there_is_named(self):
        moved = self.folder / "lost/share/scree/jobs"
        shutil.copytree(self.share / "jobs", moved)
        log = self.run_program("bash", moved / "one_node.sbatch", self.deck, "out", code=2)
        self.assertIn(f"no program {self.folder}/lost/bin/scree", log)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
