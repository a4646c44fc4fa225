"""Recipes of packages, what cites Scree and what names its version agree with the project. Usage: test_recipes.py"""

import json
import pathlib
import py_compile
import re
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGING = ROOT / "jobs/packaging"
PROJECT = (ROOT / "CMakeLists.txt").read_text()
SETUP = (ROOT / "jobs/setup.sh").read_text()
VERSION = re.search(r"project\(scree VERSION (\S+)", PROJECT)[1]
DEFINITION = (PACKAGING / "scree.def").read_text()
SPACK = (PACKAGING / "spack/package.py").read_text()
CONDA = (PACKAGING / "conda/recipe.yaml").read_text()
CONDA_BUILD = (PACKAGING / "conda/build.sh").read_text()
PRESETS = json.loads((ROOT / "CMakePresets.json").read_text())["configurePresets"]
# What the libraries of Debian's packages are called elsewhere: by Spack, by conda.
NAMES = {"libopenmpi-dev": ("mpi", "${{ mpi }}"), "libhdf5-openmpi-dev": ("hdf5", "hdf5"),
         "libpetsc-real-dev": ("petsc", "petsc"), "libeigen3-dev": ("eigen", "eigen"),
         "libtomlplusplus-dev": ("tomlplusplus", "tomlplusplus"), "libcli11-dev": ("cli11", "cli11"),
         "libfmt-dev": ("fmt", "fmt")}


def packages(name):
    """The Debian packages of one list in jobs/setup.sh."""
    words = re.sub(r"#.*", "", re.search(rf"^{name}=\((.*?)\)$", re.sub(r"#.*", "", SETUP), re.S | re.M)[1])
    return words.split()


class RecipesTest(unittest.TestCase):
    def test_all_have_the_projects_version(self):
        for file, pattern in ((DEFINITION, r"image\.version (\S+)"), (SPACK, r'version\("([^"]+)"\)'),
                              (CONDA, r"^  version: (\d\S*)$"),
                              ((ROOT / "CITATION.cff").read_text(), r"^version: (\S+)$"),
                              ((PACKAGING / "README.md").read_text(), r"scree@(\d[\d.]*\d)"),
                              ((PACKAGING / "README.md").read_text(), r"scree[_-](\d+\.\d+\.\d+)[-_]")):
            found = re.findall(pattern, file, re.M)
            self.assertTrue(found, pattern)
            self.assertEqual(set(found), {VERSION}, pattern)
        self.assertIn(VERSION, (ROOT / "CHANGELOG.md").read_text())

    def test_options_that_they_set_are_the_projects(self):
        known = set(re.findall(r"^(?:option|set)\((SCREE_\w+) (?:\"|.*CACHE)", PROJECT, re.M))
        self.assertEqual(len(known), 6, known)
        for name, options in (("Spack", re.findall(r'define\w*\("(SCREE_\w+)"', SPACK)),
                              ("conda", re.findall(r"-D (SCREE_\w+)", CONDA_BUILD)),
                              ("presets", [option for preset in PRESETS for option in preset["cacheVariables"]
                                           if option.startswith("SCREE_")])):
            self.assertIn("SCREE_NATIVE", options, name)
            self.assertLessEqual(set(options), known, name)

    def test_every_library_of_the_set_up_is_in_every_recipe(self):
        libraries = [name for name in packages("program_packages") if name.endswith("-dev")]
        self.assertGreater(len(libraries), 5)
        host = re.search(r"^  host:\n((?:    .*\n)+)", CONDA, re.M)[1]
        for library in libraries:
            self.assertIn(library, NAMES, "jobs/packaging/spack and conda need it, too, under its names there")
            spack, conda = NAMES[library]
            self.assertRegex(SPACK, rf'depends_on\("{spack}\b')
            self.assertRegex(host, rf"(?m)^    - {re.escape(conda)}( |$)")

    def test_debian_packages_stand_in_the_set_up_alone(self):
        self.assertIn("jobs/build.sh package package", DEFINITION)
        self.assertIn("package", [preset["name"] for preset in PRESETS])
        installed = re.findall(r"apt-get .*?install ((?:-\S+ )*)(.*)", DEFINITION)
        self.assertEqual([words for _, words in installed], ["/packages/*.deb openmpi-bin"])

    def test_decks_that_they_check_are_there(self):
        for recipe in DEFINITION, CONDA:
            decks = re.findall(r"share/scree/(\S+\.toml)", recipe)
            self.assertTrue(decks)
            for deck in decks:
                self.assertTrue((ROOT / deck).exists(), deck)
        deck = re.search(r'"scree", ((?:"\w+", )*"\w+\.toml")', SPACK)[1]
        self.assertTrue((ROOT / "/".join(re.findall(r'"([^"]+)"', deck))).exists(), deck)

    def test_the_recipe_of_spack_is_python(self):
        with tempfile.TemporaryDirectory() as folder:
            py_compile.compile(str(PACKAGING / "spack/package.py"), cfile=f"{folder}/package.pyc", doraise=True)


if __name__ == "__main__":
    unittest.main()
