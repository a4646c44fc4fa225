"""The picture of a deck's start: scree check --picture. Usage: as test_cli.py, by a Python with
postprocess/requirements.txt"""

import pathlib
import shutil
import signal
import subprocess
import sys
import time
import unittest

import matplotlib.image

from test_cli import BAD_INPUT, DECK, DONE, ENVIRONMENT, IO_FAILED, LIMIT, SCREE, STOPPED, CommandLineTest

POSTPROCESS = pathlib.Path(__file__).resolve().parents[2] / "postprocess"


class PictureTest(CommandLineTest):
    def drawer(self, *lines):
        """A program in the place of scree-post, of these lines of shell."""
        path = self.write("drawer", "\n".join(("#!/bin/sh", *lines, "")))
        path.chmod(0o755)
        return path

    def check(self, code, picture, drawer, deck=None, launcher=()):
        environment = dict(ENVIRONMENT, SCREE_POST=str(drawer))
        result = subprocess.run([*launcher, SCREE, "check", str(deck or self.deck), "--picture", picture],
                                cwd=self.folder, env=environment, capture_output=True, text=True, timeout=LIMIT)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        self.assert_nothing_is_left()
        return result

    def assert_nothing_is_left(self):
        left = {path.name for path in self.folder.iterdir()}
        self.assertLessEqual(left, {"deck.toml", "bare.toml", "drawer", "words", "start.png", "start.jpg"})

    def test_a_picture_of_particles_and_bodies(self):
        drawer = self.drawer(f"PYTHONPATH='{POSTPROCESS}' exec '{sys.executable}' -m scree \"$@\"")
        said = self.check(DONE, "start.png", drawer).stdout
        self.assertTrue(said.endswith("picture        start.png\n"), said)
        pixels = matplotlib.image.imread(self.folder / "start.png")[..., :3]
        self.assertGreater(min(pixels.shape[:2]), 300)
        orange = (pixels[..., 0] > 0.7) & (pixels[..., 1] > 0.2) & (pixels[..., 1] < 0.6) & (pixels[..., 2] < 0.2)
        self.assertGreater(orange.sum(), 300)  # the pad
        self.assertIn("start.xyz", self.check(BAD_INPUT, "start.xyz", drawer).stderr)

    def test_what_is_handed_over_and_removed(self):
        keep = 'cp "$2/run_record.json" "$2/particles.vtkhdf" "$2/bodies.vtkhdf" . && rm run_record.json *.vtkhdf'
        drawer = self.drawer('echo "$1 $3 $4" > words', keep)
        self.check(DONE, "start.jpg", drawer)
        self.assertEqual((self.folder / "words").read_text(), "picture --output start.jpg\n")
        mpirun = (shutil.which("mpirun") or "mpirun", "--oversubscribe", "-n", "2")
        self.check(DONE, "start.jpg", drawer, launcher=mpirun)

    def test_bodies_without_shapes_are_seen(self):
        bare = self.write("bare.toml", DECK.replace("shapes = [{ radius = 0.1 }]\n", ""))
        self.check(DONE, "start.png", self.drawer('grep -q pad "$2/bodies.vtkhdf"'), bare)

    def test_failures_are_one_message_and_leave_nothing(self):
        for code, lines, message in (
                (BAD_INPUT, ["echo 'error: no such colour' >&2", "exit 2"], "error: no such colour\n"),
                (IO_FAILED, ["echo first", "echo last", "exit 1"], "drawer ended with exit code 1: last\n"),
                (IO_FAILED, ["kill -9 $$"], "drawer was ended by a signal (Killed)\n")):
            self.assertIn(message, self.check(code, "start.png", self.drawer(*lines)).stderr)
        self.assertIn("cannot create a folder beside it", self.check(IO_FAILED, "none/a.png", self.drawer("")).stderr)
        self.assertIn("SCREE_POST = none: is not an executable program",
                      self.check(BAD_INPUT, "start.png", "none").stderr)

    def test_a_signal_leaves_nothing(self):
        drawer = self.drawer("touch words", f"exec sleep {2 * LIMIT}")
        run = subprocess.Popen([SCREE, "check", str(self.deck), "--picture", "start.png"], cwd=self.folder,
                               env=dict(ENVIRONMENT, SCREE_POST=str(drawer)), stdout=subprocess.PIPE, text=True)
        self.addCleanup(run.kill)
        while run.poll() is None and not (self.folder / "words").exists():
            time.sleep(0.05)
        run.send_signal(signal.SIGTERM)
        said = run.communicate(timeout=LIMIT)[0]
        self.assertEqual(run.returncode, STOPPED)
        self.assertIn(f"stopped by signal ({signal.strsignal(signal.SIGTERM)}) before the picture was drawn", said)
        self.assert_nothing_is_left()

    def test_without_scree_post_the_message_says_how_to_get_it(self):
        """Of a program that lies in no source tree."""
        program = shutil.copy(SCREE, self.folder / "scree")
        environment = {name: value for name, value in ENVIRONMENT.items() if name != "SCREE_POST"}
        system = str(pathlib.Path(shutil.which("mpirun")).parent)  # where MPI starts
        result = subprocess.run([program, "check", str(self.deck), "--picture", "start.png"], cwd=self.folder,
                                env=dict(environment, PATH=system), capture_output=True, text=True, timeout=LIMIT)
        self.assertEqual(result.returncode, BAD_INPUT)
        self.assertRegex(result.stderr, r"\Aerror: --picture needs the program scree-post.*pip install.*\n\Z")
        self.assertEqual(result.stdout, "")


if __name__ == "__main__":
    unittest.main()
