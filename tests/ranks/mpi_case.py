"""What the tests of the program under mpirun share."""

import csv
import ctypes
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
try:
    import results
except ImportError:  # without the libraries of postprocess/requirements.txt snapshots are not compared
    results = None

SCREE = os.environ["SCREE"]
MPIEXEC = os.environ.get("MPIEXEC", "mpirun")
BACKEND = os.environ.get("SCREE_TEST_BACKEND", "cpu")
HERE = pathlib.Path(__file__).resolve().parent
INPUT = HERE.parent.parent / "input"
LIMIT = 300  # [s] for any one run: past it, the run hangs
# Without OpenCL, which may take SIGUSR1 from mpirun (jobs/README.md). Ranks that wait leave their core to others: two
# ranks beside other tests are more than twice as fast so, and take less than half of the time of processors. mpirun
# would bind one or two ranks to the first cores, those of other tests to the same ones.
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1", OMPI_MCA_mpi_yield_when_idle="1",
                   OMPI_MCA_hwloc_base_binding_policy="none", HWLOC_COMPONENTS="-opencl")

DONE, BAD_INPUT, FAILED, IO_FAILED, STOPPED = 0, 2, 3, 4, 5

EXPLICIT = ["integrator.particles=velocity-verlet"]
IMPLICIT = ["integrator.particles=hht"]
DAM = [HERE / "dam_break.toml"]

# Alone in a periodic box, far from each other: they keep their velocity, digit for digit.
LONELY = """[space]
dimension = 2
min = [0.0, 0.0]
max = [1.0, 1.0]
x_min = "periodic"
x_max = "periodic"
y_min = "periodic"
y_max = "periodic"

[time]
end = 1.0
step = 1e-3
control = "fixed"

[[contact.pairs]]
stiffness = 1e5

[[particles]]
name = "two"
kind = "row"
count = 2
origin = [0.25, 0.5]
spacing = [0.5, 0.0]
radius = 0.05
mass = 1.0
velocity = [0.0, 0.123456789]
"""
VELOCITY = 0.123456789


def gpus():
    """How many a CUDA program finds."""
    try:
        driver = ctypes.CDLL("libcuda.so.1")
    except OSError:
        return 0
    count = ctypes.c_int(0)
    found = driver.cuInit(0) == 0 and driver.cuDeviceGetCount(ctypes.byref(count)) == 0
    return count.value if found else 0


class RanksTest(unittest.TestCase):
    program = SCREE

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="scree_ranks_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def command(self, ranks, deck, output, overrides, *words, backend=BACKEND, before=()):
        """before: words in front of the program, such as env and a variable. Earlier results are overwritten."""
        settings = [word for override in overrides for word in ("--set", override)]
        return [MPIEXEC, "-n", str(ranks), *before, self.program, "run", str(deck), "--backend", backend, "--output",
                str(self.folder / output), "--overwrite", *settings, *map(str, words)]

    def run_deck(self, code, ranks, deck, output, overrides=(), *words, **how):
        result = subprocess.run(self.command(ranks, deck, output, overrides, *words, **how), cwd=self.folder,
                                env=ENVIRONMENT, capture_output=True, text=True, timeout=LIMIT)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def wait_for(self, run, path):
        """Until the run has written the file."""
        deadline = time.monotonic() + LIMIT
        while not path.exists():
            self.assertIsNone(run.poll(), f"the run ended before it wrote {path.name}")
            self.assertLess(time.monotonic(), deadline, f"no {path.name} in {LIMIT} s")
            time.sleep(0.01)

    def assert_one_message(self, result, *words):
        self.assertEqual(result.stderr.count("error:"), 1, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def record(self, output):
        return json.loads((self.folder / output / "run_record.json").read_text())

    def hash(self, output):
        return self.record(output)["run"]["state_hash"]

    def bytes_of(self, output, name):
        return (self.folder / output / name).read_bytes()

    def columns(self, output):
        """Numbers of the history by column, e.g. "time [s]"."""
        names, *rows = csv.reader((self.folder / output / "history.csv").open())
        return {name: [float(row[k]) for row in rows] for k, name in enumerate(names)}

    def datasets(self, output, name, chunks=True):
        """Contents and layout of an HDF5 file, without the times of day in it and what a checkpoint says that the run
        took; None without libraries or file. chunks: with their sizes, which the first start of a run plans."""
        path = self.folder / output / name
        if results is None or not path.exists():
            return None

        def contents(item):
            value = item[()] if item.shape is not None else b""
            if item.dtype.kind == "O":  # texts of any length
                value = b"\n".join(value.tolist())
            return (item.dtype, item.shape, chunks and item.chunks, item.compression, item.compression_opts,
                    dict(item.attrs), value if isinstance(value, bytes) else value.tobytes())
        return results.files.read(path, lambda file: {at: contents(item)
                                                      for at, item in results.files.datasets(file).items()
                                                      if at != "texts/starts"})
