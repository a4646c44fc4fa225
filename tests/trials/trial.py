"""What the trials share: a short run with frequent output, its uninterrupted end, and the way on from what is left."""

import argparse
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import measured  # noqa: E402
import results  # noqa: E402

DONE, STOPPED = 0, 5
LIMIT = 300  # [s] for any one run: past it, the run hangs
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1", OMPI_MCA_mpi_yield_when_idle="1", HWLOC_COMPONENTS="-opencl")

# Discs fall on a disc that hangs on a spring, in a box that is periodic in x and open at its bottom.
DECK = """title = "trial"
gravity = [0.0, -9.8]
[space]
dimension = 2
min = [-0.35, -1.0]
max = [0.35, 1.0]
x_min = "periodic"
x_max = "periodic"
leaving = "ballistic"
[time]
end = 0.05
control = "fixed"
step = 5e-5
[[contact.pairs]]
stiffness = 1e5
damping = 3.0
[[bodies]]
name = "pad"
position = [0.0, -0.2]
mass = 1.0
inertia = 0.005
shapes = [{ radius = 0.1 }]
[[spring_dampers]]
name = "spring"
bodies = ["ground", "pad"]
points = [[0.0, -0.9], [0.0, 0.0]]
stiffness = 1e3
damping = 1.0
free_length = 0.7
[[particles]]
name = "discs"
kind = "lattice"
origin = [-0.2, 0.0]
spacing = [0.13, 0.13]
size = [4, 6]
radius = 0.05
mass = 1.0
velocity = [0.5, -1.0]
[output]
snapshot_interval = 0.01
history_interval = 1e-3
checkpoint_interval = 5e-3
checkpoint_wall_interval = 0.05
"""
WAYS = (("integrator.particles=hht",), ("integrator.particles=velocity-verlet", "integrator.substeps=3"))


class Trials:
    """Seeded; `complaints` is what went wrong, a line each."""

    def __init__(self, description):
        words = argparse.ArgumentParser(description=description)
        words.add_argument("program", help="scree")
        words.add_argument("--trials", type=int, default=100)
        words.add_argument("--seed", type=int, default=1)
        words.add_argument("--mpiexec", default="mpirun")
        self.words = words.parse_args()
        self.random = random.Random(self.words.seed)
        self.complaints = []
        self.counts = {}
        self.scratch = tempfile.TemporaryDirectory(prefix="scree_trials_")
        self.folder = pathlib.Path(self.scratch.name)
        (self.folder / "deck.toml").write_text(DECK)
        self.references = {}

    def command(self, way, ranks, output, *words):
        launcher = [self.words.mpiexec, "-n", str(ranks)] if ranks > 1 else []
        settings = [word for setting in way for word in ("--set", setting)]
        return [*launcher, self.words.program, "run", str(self.folder / "deck.toml"), "--backend", "cpu", "--output",
                str(self.folder / output), *settings, *map(str, words)]

    def start(self, *command):
        return subprocess.Popen(self.command(*command), env=ENVIRONMENT, stdout=subprocess.PIPE, text=True,
                                stderr=subprocess.STDOUT)

    def finish(self, run):
        try:
            text, _ = run.communicate(timeout=LIMIT)
        except subprocess.TimeoutExpired:
            run.kill()
            return None, f"no end after {LIMIT} s"
        return run.returncode, text

    def reference(self, way):
        """(state hash, history, seconds) of the uninterrupted run."""
        if way not in self.references:
            name, begun = f"whole {len(self.references)}", time.monotonic()
            code, text = self.finish(self.start(way, 1, name))
            assert code == DONE, text
            self.references[way] = (*self.end_of(name), time.monotonic() - begun)
        return self.references[way]

    def record(self, output):
        return json.loads((self.folder / output / "run_record.json").read_text())["run"]

    def end_of(self, output):
        history = {name: values.tobytes() for name, values in results.columns(self.folder / output).items()}
        return self.record(output)["state_hash"], history

    def complain(self, trial, words):
        self.complaints.append(f"trial {trial}: {words}")
        print(self.complaints[-1], flush=True)

    def count(self, what):
        self.counts[what] = self.counts.get(what, 0) + 1

    def check_files(self, trial, output):
        """Every file under its own name is complete."""
        for path in sorted((self.folder / output).glob("*")):
            try:
                if path.suffix in (".h5", ".vtkhdf"):
                    results.datasets(path)
                if path.suffix == ".xdmf":
                    xml.etree.ElementTree.parse(path)
                if path.suffix == ".json":
                    json.loads(path.read_text())
            except (OSError, ValueError, results.scree.ScreeError, xml.etree.ElementTree.ParseError) as error:
                self.complain(trial, f"{path.name} cannot be read: {error}")

    def go_on(self, trial, way, output):
        """From the last checkpoint to the end, on one rank or two: the bits of the uninterrupted run."""
        checkpoint = self.folder / output / "checkpoint.h5"
        code, text = self.finish(self.start(way, self.random.choice((1, 2)), output, "--restart", checkpoint))
        if code != DONE:
            return self.complain(trial, f"the restart ended with {code}: {text}")
        self.compare(trial, way, output)

    def compare(self, trial, way, output):
        state_hash, history, _ = self.reference(way)
        if self.end_of(output) != (state_hash, history):
            self.complain(trial, "the end is not that of the uninterrupted run")

    def report(self):
        print(f"{self.words.trials} trials, seed {self.words.seed}: "
              + ", ".join(f"{number} {what}" for what, number in sorted(self.counts.items()))
              + f"; {len(self.complaints)} complaints")
        name, commit = pathlib.Path(sys.argv[0]).stem, measured.commit_of(self.words.program)
        measured.note(f"trials/{name}, complaints", len(self.complaints), "complaints", at_most=0, commit=commit)
        measured.note(f"trials/{name}, trials", self.words.trials, "trials", commit=commit)
        return 1 if self.complaints else 0


def ranks_of(run):
    """Processes of the program under mpirun, or itself."""
    listed = subprocess.run(["ps", "-o", "pid=,comm=", "--ppid", str(run.pid)], capture_output=True, text=True)
    below = [line.split() for line in listed.stdout.splitlines()]
    return [int(pid) for pid, name in below if "scree" in name]
