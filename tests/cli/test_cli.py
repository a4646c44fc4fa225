"""The command line: exit codes, messages, restart, signals. Usage: SCREE=path/to/scree python3 test_cli.py"""

import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import tempfile
import unittest

SCREE = os.environ["SCREE"]
LIMIT = 300  # [s] for any one run: past it, the run hangs
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")

DONE, BAD_INPUT, FAILED, IO_FAILED, STOPPED = 0, 2, 3, 4, 5

# Six discs fall on a disc that hangs on a spring, in a box that is periodic in x and open at its bottom.
DECK = """title = "test"
gravity = [0.0, -9.8]

[space]
dimension = 2
min = [-0.35, -1.0]
max = [0.35, 1.0]
x_min = "periodic"
x_max = "periodic"
leaving = "ballistic"

[time]
end = 0.4
step = 1e-4
control = "fixed"

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
origin = [-0.1, 0.1]
spacing = [0.13, 0.13]
size = [2, 3]
radius = 0.05
mass = 1.0
velocity = [0.5, -1.0]

[output]
history_csv = true
history_bodies = ["pad"]
history_particles = [0, 5]
"""
# Discs that collide with each other and with the sides of a box.
GAS = """
[space]
dimension = 2
min = [0.0, 0.0]
max = [1.0, 1.0]
x_min = "wall"
x_max = "wall"
y_min = "wall"
y_max = "wall"

[time]
end = 0.5
step = 1e-4
control = "fixed"
[integrator]
particles = "hht"
[[contact.pairs]]
stiffness = 1e6

[[particles]]
name = "gas"
kind = "random"
count = 100
min = [0.0, 0.0]
max = [1.0, 1.0]
radius = 0.02
mass = 1.0
random_velocity = 1.0
seed = 3
"""
SANITIZED = "-fsanitize" in subprocess.run([SCREE, "--version"], env=ENVIRONMENT, capture_output=True, text=True).stdout
EXPLICIT = ["--set", "integrator.particles=velocity-verlet", "--set", "integrator.substeps=10"]


class CommandLineTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="scree_cli_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.deck = self.write("deck.toml", DECK)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def scree(self, *words, launcher=()):
        return subprocess.run(
            [*launcher, SCREE, *map(str, words)],
            cwd=self.folder, env=ENVIRONMENT, capture_output=True, text=True, timeout=LIMIT)

    def expect(self, code, *words, launcher=()):
        result = self.scree(*words, launcher=launcher)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def run_deck(self, code, output, *words):
        """Earlier results are overwritten."""
        return self.expect(code, "run", self.deck, "--output", self.folder / output, "--overwrite", *words)

    def history(self, output):
        return (self.folder / output / "history.csv").read_text().splitlines()

    def assert_same_history(self, output, reference):
        rows, expected = self.history(output), self.history(reference)
        self.assertEqual(len(rows), len(expected))
        for row, other in zip(rows, expected):
            self.assertEqual(row, other)

    def assert_same_results(self, output, reference):
        self.assert_same_history(output, reference)
        if shutil.which("h5diff"):
            for name in ("history.h5", "checkpoint.h5"):
                files = [str(self.folder / folder / name) for folder in (output, reference)]
                compared = subprocess.run(["h5diff", "--exclude-path=/texts/starts", *files],  # what the runs took
                                          capture_output=True, text=True)
                self.assertEqual(compared.returncode, 0, compared.stdout)

    def start(self, output, *words, launcher=()):
        """A run in the background, handed back once it has reported progress. Earlier results are overwritten."""
        run = subprocess.Popen(
            [*launcher, SCREE, "run", str(self.deck), "--output", str(self.folder / output), "--overwrite",
             *map(str, words)],
            cwd=self.folder, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.addCleanup(run.stdout.close)
        self.addCleanup(run.kill)
        for line in run.stdout:
            if line.startswith("t = "):
                return run
        self.fail("the run ended without reporting progress")


class UsageTest(CommandLineTest):
    def test_help_lists_commands_and_exit_codes(self):
        text = self.expect(DONE, "--help").stdout
        for word in ("run", "check", "new", "keys", "status", "--version", "Exit codes", "0 done", "2 bad usage",
                     "3 simulation failed", "4 file could", "5 stopped by a signal", "-mbs_ksp_view"):
            self.assertIn(word, text)
        text = self.expect(DONE, "run", "--help").stdout
        for word in ("--set", "--output", "--backend", "--restart", "auto", "cpu", "cuda", "Exit codes",
                     "`scree status`"):
            self.assertIn(word, text)
        self.assertIn("--picture FILE", self.expect(DONE, "check", "--help").stdout)

    def test_version_names_commit_compiler_and_libraries(self):
        text = self.expect(DONE, "--version").stdout
        for word in ("scree ", "commit", "compiler", "flags", "HDF5", "MPI", "PETSc", "fmt", "toml++"):
            self.assertIn(word, text)

    def test_keys_are_the_manual(self):
        text = self.expect(DONE, "keys").stdout
        for key in ("time", "step", "hht_alpha", "stiffness", "limit_damping", "leaving", "history_csv",
                    "max_start_overlap", "spring_dampers", "drivers", "min_step", "precision"):
            self.assertIn(key, text)
        for word in ("[s]", "[N/m^n]", "default", "required"):
            self.assertIn(word, text)

    def test_wrong_words_are_bad_usage(self):
        for words in ((), ("walk",), ("run",), ("check",), ("run", self.deck, "--speed", "9"),
                      ("run", self.deck, "--backend", "abacus"), ("run", self.deck, "--set"),
                      ("run", self.deck, self.deck)):
            with self.subTest(words=words):
                self.assertNotEqual(self.expect(BAD_INPUT, *words).stderr, "")

    def test_check_reports_and_runs_nothing(self):
        text = self.expect(DONE, "check", self.deck).stdout
        for word in ("gravity        9.8 m/s^2 along -y\n", "x_min periodic, x_max periodic, y_min open, y_max open; "
                     'a particle that leaves: "ballistic"', "\nsnapshots      2 of about ",
                     "particles      6", "\nhistory        4001 rows of 48 columns, about ", "\ndisk           about ",
                     "\ncheckpoints    one at the end, about ", "degrees of freedom", "contact", "memory", "petsc",
                     "bodies         1 with 1 shape, 0 joints, 0 drivers, 1 force element\n",
                     "in steps of 0.0001 s: 0.9792, error 0.00097 %", "fixed step 0.0001 s (4000 steps)"):
            self.assertIn(word, text)
        self.assertRegex(text, r"device memory  about [0-9.]+ MB on the GPU \(estimate\); .+")
        self.assertEqual([path.name for path in self.folder.iterdir()], ["deck.toml"])

    def test_check_says_what_a_deck_does_not(self):
        wall = '[[walls]]\nname = "w"\npoint = [0.0, -0.9]\nnormal = [0.0, 1.0]\n'
        bare = DECK.replace("shapes = [{ radius = 0.1 }]\n", "") + wall
        deck = self.write("bare.toml", bare.replace("mass = 1.0\nvelocity", "density = 100.0\nvelocity"))
        text = self.expect(DONE, "check", deck).stdout
        self.assertIn("1 body has no shapes: it passes through walls and has no contacts\n", text)
        self.assertIn("thickness      1 m, of discs whose mass follows from a density; assumed: 1 m", text)
        nothing = self.write("nothing.toml", DECK[:DECK.index("[[contact")])
        result = self.expect(DONE, "check", nothing)
        self.assertIn("warning: the deck has no particles and no bodies", result.stderr)
        self.assertIn("solver         none\n", result.stdout)


class DeckErrorTest(CommandLineTest):
    def test_errors_name_file_line_key_and_value(self):
        # Replacement in the deck; what the message holds behind file and line.
        cases = (("step = 1e-4", "stp = 1e-4", "time.stp", "did you mean"),
                 ("step = 1e-4", "step = -1e-4", "time.step = -1e-4", "above 0"),
                 ("step = 1e-4", 'step = "fast"', 'time.step = "fast"', "number"),
                 ("dimension = 2", "dimension = 5", "space.dimension = 5", "from 2 to 3"),
                 ('leaving = "ballistic"', 'leaving = "fly"', 'space.leaving = "fly"', "remove"),
                 ("damping = 3.0", "damping = [3.0]", "contact.pairs.0.damping", "number"),
                 ("damping = 3.0", "restitution = 0.5\ndamping = 3.0", "contact.pairs.0.restitution = 0.5",
                  "stands beside a damping"),
                 ('bodies = ["ground", "pad"]', 'bodies = ["ground", "pod"]', "pod", "pad"),
                 ("mass = 1.0\ninertia", "mass = 0.0\ninertia", "mass = 0", "above 0"),
                 ("[[particles]]", "[[particles]", "not TOML", ""))
        for old, new, *parts in cases:
            with self.subTest(new=new):
                self.assertIn(old, DECK)
                deck = self.write("bad.toml", DECK.replace(old, new, 1))
                message = self.expect(BAD_INPUT, "check", deck).stderr
                self.assertRegex(message, r"^error: \S*bad\.toml:\d+:\d+: ")
                for part in parts:
                    self.assertIn(part, message)
                line = int(re.search(r"bad\.toml:(\d+)", message).group(1))
                self.assertIn(new.splitlines()[0].split("=")[0].strip(), deck.read_text().splitlines()[line - 1])

    def test_a_deck_that_cannot_be_read(self):
        for path in ("absent.toml", self.folder):
            self.assertIn(str(path), self.expect(IO_FAILED, "run", path).stderr)

    def test_set_replaces_and_is_checked(self):
        result = self.run_deck(DONE, "short", "--set", "time.end=0.001", "--set", "time.step=1e-3")
        self.assertIn("after 1 steps", result.stdout)
        self.assertIn("time.stp", self.run_deck(BAD_INPUT, "none", "--set", "time.stp=1").stderr)
        self.assertIn("time.step", self.run_deck(BAD_INPUT, "none", "--set", "time.step=-1").stderr)
        self.run_deck(BAD_INPUT, "none", "--set", "time.step")
        self.assertFalse((self.folder / "none").exists())

    def test_an_unstable_explicit_step_is_refused(self):
        message = self.run_deck(BAD_INPUT, "none", *EXPLICIT, "--set", "time.step=0.1").stderr
        self.assertIn("must be at most", message)


class RunTest(CommandLineTest):
    SHORT = ("--set", "time.end=0.02")

    def test_a_run_says_at_its_end_what_its_steps_did_to_the_energy(self):
        deck = self.write("gas.toml", GAS)
        explicit = ["time.step=5e-4", "contact.pairs.0.damping=100.0", "integrator.particles=velocity-verlet"]
        for name, settings, advice in (("fine", [], None),
                                       ("coarse", ["time.step=4e-3"], "time.control = \"adaptive\""),
                                       ("explicit", explicit, ": shorten time.step: in these steps the energy of")):
            with self.subTest(name):
                words = [word for setting in settings for word in ("--set", setting)]
                result = self.expect(DONE, "run", deck, "--output", self.folder / name, *words)
                record = json.loads((self.folder / name / "run_record.json").read_text())
                measures = record["measures"]
                changed = max(abs(measures["balance_error"]), abs(measures["energy_taken_by_integrator"]))
                if advice is None:
                    self.assertLess(changed, 0.01 * measures["energy_exchanged"])
                    self.assertNotIn("the time integration has changed", result.stderr)
                    self.assertEqual(record["warnings"], [])
                else:
                    self.assertGreater(changed, 0.01 * measures["energy_exchanged"])
                    last = result.stderr.splitlines()[-1].removeprefix("warning: ")
                    self.assertRegex(last, r"the time integration has changed the energy by [0-9.]+ J, [0-9.]+ % of ")
                    self.assertIn(advice, last)
                    self.assertEqual(record["warnings"][-1], last)

    def test_a_run_writes_its_files_and_one_that_may_replaces_them(self):
        for _ in range(2):
            result = self.run_deck(DONE, "out", *self.SHORT)
            self.assertIn("results in", result.stdout)
            self.assertEqual(result.stderr, "")
        names = {path.name for path in (self.folder / "out").iterdir()}
        for name in ("history.h5", "history.csv", "particles.vtkhdf", "bodies.vtkhdf"):
            self.assertIn(name, names)
        self.assertFalse([name for name in names if name.endswith(".tmp")])
        rows = self.history("out")
        self.assertEqual(len(rows), 1 + 201)  # header, start, every step
        self.assertEqual(float(rows[-1].split(",")[0]), 0.02)

    def test_a_rerun_gives_the_same_bits(self):
        for words in ((), EXPLICIT, ("--set", "time.control=adaptive")):
            with self.subTest(words=words):
                self.run_deck(DONE, "first", "--set", "time.end=0.1", *words)
                self.run_deck(DONE, "second", "--set", "time.end=0.1", *words)
                self.assert_same_history("first", "second")

    def test_words_behind_the_dashes_go_to_petsc(self):
        result = self.run_deck(DONE, "out", "--set", "time.end=0.001", "--", "-mbs_ksp_view", "-mbs_misspelt", "1")
        self.assertIn("KSP Object: (mbs_)", result.stdout)
        self.assertIn("mbs_misspelt", result.stderr)

    def gpu_trouble(self):
        """Why there is no GPU to use, as `check` says it; empty where there is one."""
        text = re.search(r"device memory .*\(estimate\); (.+)", self.expect(DONE, "check", self.deck).stdout).group(1)
        return "" if " are free on " in text else text

    def test_the_gpu_is_used_or_refused_with_the_reason(self):
        trouble = self.gpu_trouble()
        if not trouble:
            self.assertRegex(self.run_deck(DONE, "out", *self.SHORT, "--backend", "cuda").stdout,
                             r"(?m)^backend cuda: chosen by --backend; \w")
            return
        message = self.run_deck(BAD_INPUT, "out", "--backend", "cuda").stderr
        self.assertEqual(message, f"error: --backend cuda: {trouble}; allowed here: auto, cpu\n")
        self.assertFalse((self.folder / "out").exists())

    def test_the_log_says_which_backend_and_why(self):
        for words in ((), ("--backend", "auto")):
            self.assertRegex(self.run_deck(DONE, "out", *self.SHORT, *words).stdout,
                             r"(?m)^backend cpu: 6 particles are fewer than \d+, from which a GPU is faster$")
        self.assertRegex(self.run_deck(DONE, "out", *self.SHORT, "--backend", "cpu").stdout,
                         r"(?m)^backend cpu: chosen by --backend$")
        many = ("--set", "particles.0.size=[300, 100]", "--set", "particles.0.spacing=[1e-3, 1e-3]",
                "--set", "particles.0.radius=4e-4", "--set", "time.end=1e-4")
        trouble = self.gpu_trouble()
        enough = "cuda: 30000 particles are at least 2000, from which a GPU is faster; "
        why = f"cpu: {trouble}\n" if trouble else enough
        self.assertIn("\nbackend " + why, "\n" + self.run_deck(DONE, "out", *many).stdout)

    def test_mixed_precision_on_the_cpu_is_double(self):
        both, mixed = (*self.SHORT, *EXPLICIT, "--backend", "cpu"), ("--set", "integrator.precision=mixed")
        self.assertNotIn("precision", self.run_deck(DONE, "double", *both).stdout)
        self.assertIn("the CPU computes in double", self.run_deck(DONE, "mixed", *both, *mixed).stdout)
        self.assert_same_history("mixed", "double")
        message = self.run_deck(BAD_INPUT, "none", "--set", "integrator.particles=hht", *mixed).stderr
        self.assertIn('must be "double", unless integrator.particles = "velocity-verlet"', message)

    def test_a_transport_between_gpus_is_not_used_on_the_cpu(self):
        both = (*self.SHORT, "--backend", "cpu")
        self.assertNotIn("transport", self.run_deck(DONE, "auto", *both).stdout)
        for transport in ("peer", "cuda-aware", "nccl", "staged"):
            text = self.run_deck(DONE, "other", *both, "--set", f"parallel.transport={transport}").stdout
            self.assertIn(f'parallel.transport = "{transport}" is for GPUs', text)
            self.assert_same_history("other", "auto")

    @unittest.skipIf(SANITIZED, "the sanitizer needs more address space than the limit")
    def test_more_particles_than_memory(self):
        many = DECK.replace("size = [2, 3]", "size = [30000, 30000]").replace("[0.13, 0.13]", "[1e-5, 1e-5]")
        deck = self.write("many.toml", many.replace("radius = 0.05\nmass", "radius = 4e-6\nmass"))
        limited = ("bash", "-c", 'ulimit -v 4000000; exec "$@"', "bash")  # [KiB]
        for words in ("check", deck), ("run", deck, "--output", self.folder / "out"):
            message = self.expect(BAD_INPUT, *words, launcher=limited).stderr
            self.assertRegex(message, r"error: not enough memory: building the particles takes about 135 GB, "
                                      r"[0-9.]+ GB are free \(.+\); a run of 900000000 particles and 1 body takes "
                                      r"at least 864 GB on one rank; start more ranks on more machines")
        self.assertFalse((self.folder / "out").exists())

    def test_decks_that_cannot_be_built_are_refused_at_once(self):
        row = '[[bodies]]\nname = "row"\ncount = {}\nspacing = [{}, 0.0]\nposition = [-0.3, 0.9]\nmass = 1.0\n' \
              "inertia = 0.01\nshapes = [{{ radius = 1e-9 }}]\n"
        group = '[[particles]]\nname = "many"\nkind = "random"\ncount = {}\nmin = [-0.3, -1.0]\nmax = [0.3, 0.9]\n' \
                "radius = {}\nmass = 1.0\n"
        cases = ((row.format(10000000, 1e-9), r"not enough memory: building the bodies takes about 23 GB, [0-9.]+ GB "
                  r"are free \(ulimit -v, the address space\); a run of 10000001 bodies takes at least 42 GB on one "
                  r"rank; take fewer bodies"),
                 (row.format(6000000, 2e-7), r'body "row\.[0-9]+" starts at \(0\.35.+, outside the space'),
                 (group.format(1000000000, 1e-6), "not enough memory: building the particles takes about 280 GB"),
                 (group.format(1000000, 0.01), r"particles\.many\.count = 1000000: the particles are 276 of the area "
                  r"of their box \(min, max\), and random insertion fills at most about 0\.5[0-9]* of it in 10000 "
                  r"tries each"))
        for text, message in cases:
            with self.subTest(message=message):
                deck = self.write("many.toml", DECK.replace("x_min = \"periodic\"\nx_max = \"periodic\"\n", "") + text)
                limit = () if SANITIZED else ("bash", "-c", 'ulimit -v 4000000; exec "$@"', "bash")  # [KiB]
                if SANITIZED and "memory" in message:
                    continue
                self.assertRegex(self.expect(BAD_INPUT, "check", deck, launcher=limit).stderr, message)
                spent = resource.getrusage(resource.RUSAGE_CHILDREN)
                self.assertLess(spent.ru_maxrss, 1e6)  # [kB], of the largest child so far: none of them was built

    def test_output_that_cannot_be_written(self):
        self.write("file", "not a folder")
        self.assertIn("file", self.run_deck(IO_FAILED, "file", *self.SHORT).stderr)
        self.assertEqual((self.folder / "file").read_text(), "not a folder")


if __name__ == "__main__":
    unittest.main()
