"""The package installs by pip into an environment of its own, and what is installed is all that it needs.

    .venv/bin/python tests/postprocess/test_install.py NET_400

takes the folder of that run's results. Nothing is downloaded: the libraries and pip's back end are those of this
interpreter."""

import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
import unittest
import venv

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCE = ROOT / "postprocess"
NET = pathlib.Path(sys.argv[1]).resolve()
PROJECT = tomllib.loads((SOURCE / "pyproject.toml").read_text())["project"]


def name_of(requirement):
    return re.match(r"[\w-]+", requirement)[0]


class InstallTest(unittest.TestCase):
    def test_the_installed_program_runs(self):
        with tempfile.TemporaryDirectory(prefix="scree_install_") as kept:
            folder = pathlib.Path(kept)
            venv.create(folder / "venv", with_pip=True)
            # This interpreter's libraries, behind the new environment's own.
            site = next((folder / "venv").glob("lib/python3*/site-packages"))
            (site / "libraries.pth").write_text(sysconfig.get_path("purelib") + "\n")
            python = folder / "venv/bin/python"
            environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
            self.run_program([python, "-m", "pip", "install", "--no-deps", "--no-build-isolation", "--no-index",
                              "--disable-pip-version-check", SOURCE], environment)
            where = self.run_program([python, "-c", "import scree; print(scree.__file__)"], environment)
            self.assertTrue(where.startswith(str(site)), where)
            picture = folder / "history.png"
            said = self.run_program([folder / "venv/bin/scree-post", "plot", NET, "-o", picture], environment)
            self.assertEqual(said.strip(), str(picture))
            self.assertTrue((site / "scree/py.typed").exists())
            check = self.run_program([python, "-c", "import scree; print(scree.Deck(space=1).problems())"], environment)
            self.assertIn("time: missing", check)
            packed = {path.relative_to(site) for path in (site / "scree").rglob("*.py")}
            self.assertEqual(packed, {path.relative_to(SOURCE) for path in (SOURCE / "scree").rglob("*.py")})

    def run_program(self, words, environment):
        result = subprocess.run(words, cwd="/", env=environment, capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result.stdout

    def test_the_libraries_of_the_tests_are_those_of_the_package(self):
        pinned = [line.split("==")[0] for line in (SOURCE / "requirements.txt").read_text().splitlines()]
        of_tests = ["flit_core", "mypy"]  # pip's back end, and what looks at types
        self.assertEqual(sorted([*map(name_of, PROJECT["dependencies"]), *of_tests]), pinned)

    def test_types(self):
        with tempfile.TemporaryDirectory(prefix="scree_types_") as cache:
            self.run_program([sys.executable, "-m", "mypy", "--cache-dir", cache, "--config-file",
                              SOURCE / "pyproject.toml", SOURCE / "scree"], os.environ)

    def test_package_and_program_have_one_version(self):
        program = re.search(r"project\(scree VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
        self.assertEqual(PROJECT["version"], program)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
