"""What jobs/setup.sh prints, with an apt-get that installs nothing. Usage: test_setup.py"""

import os
import pathlib
import subprocess
import tempfile
import unittest

SETUP = pathlib.Path(__file__).resolve().parents[2] / "jobs/setup.sh"
APT = """#!/bin/bash
echo "$*" >> "$CALLS"
case "$*" in
  *--assume-no*)
    echo "0 upgraded, 215 newly installed, 0 to remove and 3 not upgraded."
    echo "Need to get 301 MB of archives."
    echo "After this operation, 1,402 MB of additional disk space will be used."
    exit 1 ;;
  *update*) echo "Hit:1 a mirror" ;;
  *install*) echo "Setting up g++"; echo "E: no room" >&2; exit "$INSTALLS" ;;
esac
"""


class SetupTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="scree_setup_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for name, text in (("apt-get", APT), ("dpkg-query", "#!/bin/bash\nexit 1\n"),
                           ("sudo", '#!/bin/bash\nexec "$@"\n')):
            (self.folder / name).write_text(text)
            (self.folder / name).chmod(0o755)

    def setup(self, *words, installs=0):
        environment = dict(os.environ, PATH=f"{self.folder}:{os.environ['PATH']}", INSTALLS=str(installs),
                           CALLS=str(self.folder / "calls"))
        return subprocess.run([SETUP, *words], env=environment, capture_output=True, text=True, timeout=60)

    def test_quiet_says_how_much_and_nothing_of_apt(self):
        result = self.setup("--quiet", "--package")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        first, second = result.stdout.splitlines()
        self.assertRegex(first, "^set-up: installing Debian packages: g[+][+] cmake ")
        self.assertEqual(second, "set-up: with what they need 215 packages: 301 MB to download, 1,402 MB of disk")
        calls = (self.folder / "calls").read_text().splitlines()
        self.assertEqual([("--assume-no" in call, "install -y" in call) for call in calls],
                         [(False, False), (True, False), (False, True)])

    def test_quiet_shows_what_failed(self):
        result = self.setup("--quiet", "--package", installs=100)
        self.assertEqual(result.returncode, 1)
        self.assertIn("Setting up g++\nE: no room\nset-up: apt-get could not install: g++", result.stderr)

    def test_without_it_apt_is_heard(self):
        result = self.setup("--package")
        self.assertEqual(result.returncode, 0)
        self.assertIn("Hit:1 a mirror\n", result.stdout)
        self.assertIn("215 packages: 301 MB", result.stdout)
        self.assertIn("Setting up g++\n", result.stdout)


if __name__ == "__main__":
    unittest.main()
