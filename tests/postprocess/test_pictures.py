"""The pictures and films of the repository: who makes them, what they say of themselves, and that pages can carry them.

    python3 tests/postprocess/test_pictures.py

Needs postprocess/requirements.txt. That the tutorial's runs give the tutorial's pictures is tested by
tests/cli/test_tutorial.py."""

import pathlib
import subprocess
import sys
import tempfile
import tomllib
import unittest

import PIL.Image

ROOT = pathlib.Path(__file__).resolve().parents[2]
PICTURES = ROOT / "postprocess/pictures"
sys.path.insert(0, str(PICTURES))

import make

# Of measurements, by the scripts that draw them.
PLOTS = {"table4.png": "tests/performance/table4.py", "scaling_model.png": "tests/performance/scaling_model.py",
         "bulk.png": "tests/verification/bulk/plots.py", "calibration_soil.png": "postprocess/pictures/make.py"}
LARGEST, NARROWEST = 1_000_000, 1000  # [B], [pixels]


class PictureTest(unittest.TestCase):
    def test_each_has_what_makes_it(self):
        files = {path.name for path in PICTURES.iterdir() if path.suffix in (".png", ".webp", ".gif", ".svg")}
        self.assertEqual(files, set(make.PICTURES) | set(PLOTS))
        for name, script in PLOTS.items():
            self.assertIn(name, (ROOT / script).read_text(), script)
        for name, picture in make.PICTURES.items():
            self.assertTrue((ROOT / f"input/{picture.deck}.toml").exists(), name)

    def test_they_are_large_enough_to_read_and_small_enough_to_carry(self):
        for path in PICTURES.glob("*.[pw][ne]*"):
            self.assertLess(path.stat().st_size, LARGEST, path.name)
            with PIL.Image.open(path) as image:
                self.assertGreaterEqual(image.width, NARROWEST, path.name)
                self.assertGreaterEqual(getattr(image, "n_frames", 1), 20 if path.suffix == ".webp" else 1, path.name)

    def test_they_say_of_what_they_are(self):
        for name, picture in make.PICTURES.items():
            if picture.command != "picture":
                continue
            deck = tomllib.loads((ROOT / f"input/{picture.deck}.toml").read_text())
            settings = dict(setting.split("=", 1) for setting in picture.settings)
            words = dict(zip(picture.options[::2], picture.options[1::2]))
            time = float(words.get("--time", settings.get("time.end", deck["time"]["end"])))
            with PIL.Image.open(PICTURES / name) as image:
                said = image.text
            self.assertEqual(said["Title"], deck["title"], name)
            self.assertTrue(said["Description"].startswith(f"t = {time:g} s, "), said)
            shown = {"radius": "particle radius [m]: 0 to ", "material": "particle material"}.get(
                words.get("--color"), "particle speed [m/s]: 0 to ")
            self.assertTrue(said["Color bar"].startswith(shown), said)
            if "--fastest" in words:
                self.assertEqual(said["Color bar"], f"particle speed [m/s]: 0 to {words['--fastest']}")

    def test_plots_are_drawn_from_the_repository(self):
        """The scripts run, and what they draw has a title in it."""
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "bulk.png"
            subprocess.run([sys.executable, ROOT / PLOTS["bulk.png"], path], check=True, capture_output=True)
            with PIL.Image.open(path) as drawn, PIL.Image.open(PICTURES / "bulk.png") as kept:
                self.assertEqual((drawn.size, drawn.text["Title"]), (kept.size, kept.text["Title"]))


if __name__ == "__main__":
    unittest.main()
