"""The tutorial as its page tells it: every command is run, in order, and answers with the words and about the numbers
that stand below it. Usage: SCREE=path/to/scree MPIEXEC=mpirun python3 test_tutorial.py; needs
postprocess/requirements.txt."""

import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import PIL.Image

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = (ROOT / "input/tutorial/README.md").read_text()
SCREE = pathlib.Path(os.environ["SCREE"]).resolve()
LIMIT = 300  # [s] for any one command
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1", OMPI_MCA_mpi_yield_when_idle="1")
DONE, STOPPED = 0, 5

NUMBER = r"-?\d+(?:\.\d+)?"
# How far numbers may be off, as a share and outright. Grains: what other places at t = 0 change, and so other rounding.
CLOSED_FORM, GRAINS = (0, 1.5e-5), (0.25, 0.1)
FEW_GRAINS = 2  # times as fast may be the fastest percent of the grains, which is two or three of them
# A run of the last deck for a second or two.
SHORT = ("--set", "particles.grains.count=200", "--set", "time.end=0.2", "--set", "output.checkpoint_interval=0.02")


def section(title):
    """The text below a heading that begins so, up to the next one."""
    return re.search(rf"^## {title}.*?\n(.*?)(?=^## |\Z)", PAGE, re.M | re.S)[1]


def sessions(text):
    """Pairs of a command and the lines that it answers."""
    lines = [line for block in re.findall(r"^```console\n(.*?)^```", text, re.M | re.S) for line in block.splitlines()]
    found = []
    for line in lines:
        if line.startswith("$ "):
            found.append((line[2:], []))
        else:
            found[-1][1].append(line)
    return found


class TutorialTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="scree_tutorial_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for name in ("input", "jobs", "postprocess"):
            (self.folder / name).symlink_to(ROOT / name)
        (self.folder / "build/release").mkdir(parents=True)
        (self.folder / "build/release/scree").symlink_to(SCREE)
        (self.folder / ".venv").symlink_to(sys.prefix)

    def start(self, command, **environment):
        return subprocess.Popen(["bash", "-c", command], cwd=self.folder, env={**ENVIRONMENT, **environment},
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def answer(self, command, **environment):
        run = self.start(command, **environment)
        said = run.communicate(timeout=LIMIT)[0]
        self.assertEqual(run.returncode, DONE, f"{command}\n{said}")
        return said

    def assert_answers(self, command, said, shown, tolerance):
        share, outright = tolerance
        lines = [line.split() for line in said.splitlines()]
        for line in shown:
            words = re.sub(NUMBER, "#", line).split()
            alike = [found for found in lines if re.sub(NUMBER, "#", " ".join(found)).split() == words]
            self.assertTrue(alike, f"{command}\ndoes not say\n{line}\nbut\n{said}")
            numbers = [[float(each) for each in re.findall(NUMBER, text)] for text in (line, " ".join(alike[0]))]
            lines.remove(alike[0])
            for expected, number in zip(*numbers):
                self.assertLessEqual(abs(number - expected), share * abs(expected) + outright,
                                     f"{command}\n{' '.join(alike[0])}\ninstead of\n{line}")

    def follow(self, title, tolerance, answers):
        """answers: how many commands there have one, so that none is passed over."""
        settings = [command for command, _ in sessions(PAGE[:PAGE.index("## 1.")])]
        found = sessions(section(title))
        self.assertEqual(sum(1 for _, shown in found if shown), answers)
        for command, shown in found:
            if command.startswith("export "):
                settings.append(command)
                continue
            said = self.answer("\n".join([*settings, command]))
            self.assertNotIn("warning", said)
            self.assert_answers(command, said, shown, tolerance)

    def assert_picture(self, name, results):
        """The page's picture is that of the run: made anew it says the same of itself, and its colours go about as
        far."""
        path = self.folder / "picture.png"
        self.answer(f".venv/bin/python -m scree picture {results} -o {path}", PYTHONPATH="postprocess")
        said = []
        for each in (ROOT / "postprocess/pictures" / name, path):
            with PIL.Image.open(each) as image:
                said.append(image.text)
        shown, made = said
        for key in ("Title", "Description"):
            self.assertEqual(shown[key], made[key])
        bars = [re.fullmatch(r"(.*): (\S+) to (\S+)", each["Color bar"]) for each in said]
        self.assertEqual(*(bar.group(1, 2) for bar in bars))
        ends = [float(bar[3]) for bar in bars]
        self.assertLessEqual(max(ends), FEW_GRAINS * min(ends), f"{name} has {shown['Color bar']}, the run "
                                                               f"{made['Color bar']}: postprocess/pictures/make.py")

    def test_the_pendulum(self):
        self.follow("1. A pendulum", CLOSED_FORM, 2)

    def test_the_heap(self):
        self.follow("2. A heap", GRAINS, 3)
        self.assert_picture("tutorial_heap.png", "results/tutorial/2_heap")

    def test_the_drum(self):
        self.follow("3. A drum", GRAINS, 2)

    def test_the_digging_linkage(self):
        self.follow("4. A digging linkage", GRAINS, 2)
        self.assert_picture("tutorial_digging.png", "results/tutorial/4_digging")

    def test_the_study(self):
        self.follow("5. A job on a cluster", GRAINS, 2)

    def job(self, *options):
        command = re.search(r"^    (jobs/slurm_run.sh \S+ \S+)$", PAGE, re.M)[1]
        return self.start(f"exec {command} {' '.join((*SHORT, *options))}", SLURM_JOB_ID="7", SCREE_REQUEUES="0",
                          SCREE_LAUNCHER=f"{os.environ['MPIEXEC']} -n 2")

    def test_the_job_is_interrupted_and_goes_on(self):
        first = self.job()
        checkpoint = self.folder / "results/tutorial/5_job/checkpoint.h5"
        end = time.monotonic() + LIMIT
        while not checkpoint.exists() and first.poll() is None and time.monotonic() < end:
            time.sleep(0.02)
        first.send_signal(signal.SIGUSR1)
        said = first.communicate(timeout=LIMIT)[0]
        self.assertEqual(first.returncode, STOPPED, said)
        self.assert_log("ends with", said)

        second = self.job()
        said = second.communicate(timeout=LIMIT)[0]
        self.assertEqual(second.returncode, DONE, said)
        self.assert_log("begins with", said)

        whole = re.search(r"^    (build/release/scree run \S+5_job\S+ --output \S+)$", PAGE, re.M)[1]
        self.answer(f"{whole} {' '.join(SHORT)}")
        compare, shown = re.search(r"^    (postprocess/scree-post compare .*)\n\n((?:    .*\n)+)", PAGE, re.M).groups()
        said = self.answer(compare.replace("postprocess/scree-post", ".venv/bin/python -m scree"),
                           PYTHONPATH="postprocess")
        self.assertEqual(re.sub(r"\(.*?\)", "()", said).split(), re.sub(r"\(.*?\)", "()", shown).split())

    def assert_log(self, introduction, said):
        shown = re.search(rf"{introduction}:?\n\n((?:    .*\n)+)", section("5. A job"))[1]
        for line in shown.splitlines():
            words = line.strip().replace("JOB", "7").replace("NODE", "this node")
            self.assertIn(words, said)


if __name__ == "__main__":
    unittest.main()
