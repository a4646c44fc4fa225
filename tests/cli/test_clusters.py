"""What clusters are like: file systems without locks, machines without MPI, processors of another kind.
Usage: SCREE=path/to/scree OTHER_PROCESSOR=path/to/other_processor MPIEXEC=path/to/mpirun python3 test_clusters.py"""

import os
import pathlib
import re
import signal
import subprocess
import tempfile
import unittest

import test_cli
from test_cli import BAD_INPUT, DONE, FAILED, IO_FAILED, LIMIT, SANITIZED, SCREE, CommandLineTest

HERE = pathlib.Path(__file__).resolve().parent
MPIEXEC = os.environ["MPIEXEC"]
NO_LOCKS = (37, 95, 524)  # NFS without lockd, Lustre mounted without flock, DVS
SHORT = ("--set", "time.end=0.02", "--set", "output.contacts=true", "--set", "output.snapshot_interval=0.01",
         "--set", "output.history_interval=0.005")


def setUpModule():
    global libraries
    folder = tempfile.TemporaryDirectory(prefix="scree_preload_")
    unittest.addModuleCleanup(folder.cleanup)
    libraries = {}
    for name in ("no_locks", "no_mpi"):
        libraries[name] = pathlib.Path(folder.name) / f"{name}.so"
        subprocess.run(["cc", "-shared", "-fPIC", "-o", libraries[name], HERE / f"{name}.c", "-ldl"], check=True)


@unittest.skipIf(SANITIZED, "the sanitizer wants to be the first library")
class WithoutLocks(CommandLineTest):
    def under(self, error, *words, **more):
        environment = dict(test_cli.ENVIRONMENT, LD_PRELOAD=str(libraries["no_locks"]), NO_LOCKS=str(error), **more)
        return subprocess.run(list(map(str, words)), cwd=self.folder, env=environment, capture_output=True, text=True,
                              timeout=LIMIT)

    def assert_runs(self, error, *words, **more):
        result = self.under(error, *words, **more)
        self.assertEqual((result.returncode, result.stderr), (DONE, ""), f"error {error}: {words}")

    def test_runs_restarts_and_ranks(self):
        for error in NO_LOCKS:
            with self.subTest(error=error):
                self.assert_runs(error, SCREE, "run", self.deck, "--output", f"out{error}", *SHORT)
                self.assert_runs(error, SCREE, "run", self.deck, "--output", f"out{error}", *SHORT, "--set",
                                 "time.end=0.03", "--restart", f"out{error}/checkpoint_end.h5")
                self.assert_runs(error, SCREE, "status", f"out{error}")
                self.assert_runs(error, MPIEXEC, "-n", "2", SCREE, "run", self.deck, "--output", f"two{error}", *SHORT,
                                 OMPI_MCA_rmaps_base_oversubscribe="1")
        self.expect(DONE, "run", self.deck, "--output", "with", *SHORT)
        for error in NO_LOCKS:
            self.assertEqual((self.folder / f"two{error}/history.csv").read_bytes(),
                             (self.folder / "with/history.csv").read_bytes())

    def test_the_folder_keeps_others_out_all_the_same(self):
        environment = dict(test_cli.ENVIRONMENT, LD_PRELOAD=str(libraries["no_locks"]), NO_LOCKS="37")
        words = [SCREE, "run", str(self.deck), "--output", "out", "--set", "time.end=100"]
        first = subprocess.Popen(words, cwd=self.folder, env=environment, stdout=subprocess.PIPE, text=True)
        try:
            for line in first.stdout:
                if "particles" in line:
                    break
            result = self.under(37, *words, "--overwrite")
            self.assertEqual(result.returncode, BAD_INPUT)
            self.assertIn(f"another run writes into it: process {first.pid} on host", result.stderr)
        finally:
            first.send_signal(signal.SIGKILL)
            first.communicate(timeout=LIMIT)
        self.assert_runs(37, SCREE, "run", self.deck, "--output", "out", "--overwrite", *SHORT)

    def test_who_asks_for_locks_of_hdf5_gets_them(self):
        result = self.under(37, SCREE, "run", self.deck, "--output", "out", *SHORT, HDF5_USE_FILE_LOCKING="TRUE")
        self.assertEqual(result.returncode, IO_FAILED)
        self.assertRegex(result.stderr, "^error: .*: cannot create: No locks available; HDF5_USE_FILE_LOCKING")
        self.assert_runs(37, SCREE, "run", self.deck, "--output", "other", *SHORT, HDF5_USE_FILE_LOCKING="FALSE")


class WithoutMpi(CommandLineTest):
    """Alone a program starts MPI for a run, and for nothing else."""

    WORDS = (("--version",), ("--help",), ("run", "--help"), ("keys",), ("keys", "--schema"), ("new",),
             ("new", "pendulum"))

    def without(self, *words, **more):
        environment = {"PATH": str(self.folder), "LD_PRELOAD": str(libraries["no_mpi"]), **more}
        return subprocess.run([SCREE, *map(str, words)], cwd=self.folder, env=environment, capture_output=True,
                              text=True, timeout=LIMIT)

    @unittest.skipIf(SANITIZED, "the sanitizer wants to be the first library")
    def test_what_needs_no_ranks_needs_no_mpi(self):
        self.expect(DONE, "run", self.deck, "--output", "out", *SHORT)
        words = self.WORDS + (("status", "out"), ("status", "out", "out"), ("check", self.deck),
                              ("check", "pendulum.toml"))
        for launcher in ({}, {"OMPI_COMM_WORLD_SIZE": "1", "PMIX_RANK": "0"},
                         {"SLURM_NTASKS": "8", "SLURM_PROCID": "0"}):
            (self.folder / "pendulum.toml").unlink(missing_ok=True)
            for few in words:
                with self.subTest(words=few, launcher=launcher):
                    result = self.without(*few, **launcher)
                    self.assertEqual((result.returncode, result.stderr), (DONE, ""))
                    self.assertTrue(result.stdout)
        for few in (("walk",), ("check", "none.toml"), ("status", "none")):
            self.assertRegex(self.without(*few).stderr, "^error: [^\n]*\n$")
        # The library above is what it is there for; several ranks need MPI for their one answer.
        self.assertIn("MPI was started", self.without("run", self.deck, "--output", "other").stderr)
        for launcher in ({"OMPI_COMM_WORLD_SIZE": "2"}, {"PMI_SIZE": "2"}, {"SLURM_STEP_NUM_TASKS": "2"},
                         {"PMIX_RANK": "1"}):
            self.assertIn("MPI was started", self.without("--version", **launcher).stderr)

    def test_the_solver_is_that_of_the_run(self):
        run = self.expect(DONE, "run", self.deck, "--output", "out", *SHORT).stdout
        checked = self.expect(DONE, "check", self.deck).stdout
        solver = checked[checked.index("solver         ") + len("solver         "):].splitlines()[0]
        self.assertIn(f"multibody solver {solver}\n", run)

    def test_ranks_answer_once(self):
        self.expect(DONE, "run", self.deck, "--output", "out", *SHORT)
        for words in self.WORDS + (("status", "out"), ("check", self.deck)):
            with self.subTest(words=words):
                result = self.expect(DONE, *words, launcher=(MPIEXEC, "--oversubscribe", "-n", "2"))
                (self.folder / "pendulum.toml").unlink(missing_ok=True)
                alone = self.expect(DONE, *words).stdout
                (self.folder / "pendulum.toml").unlink(missing_ok=True)
                if words[0] in ("check", "status"):  # these name the ranks, and the age of the run
                    first = re.sub(r", [^,]* ago$", "", alone.splitlines()[0])
                    self.assertEqual(result.stdout.count(first), 1)
                else:
                    self.assertEqual(result.stdout, alone)

    def test_a_run_alone_needs_neither_ssh_nor_a_daemon(self):
        environment = {"PATH": str(self.folder)}
        result = subprocess.run([SCREE, "run", self.deck, "--output", "out", *SHORT], cwd=self.folder, env=environment,
                                capture_output=True, text=True, timeout=LIMIT)
        self.assertEqual((result.returncode, result.stderr), (DONE, ""))

    def test_a_run_alone_needs_no_session_directory(self):
        environment = {"PATH": str(self.folder), "TMPDIR": "/proc"}
        result = subprocess.run([SCREE, "run", self.deck, "--output", "out", *SHORT], cwd=self.folder, env=environment,
                                capture_output=True, text=True, timeout=LIMIT)
        self.assertEqual((result.returncode, result.stderr), (DONE, ""))

    def test_where_mpi_cannot_start_a_line_says_what_helps(self):
        session = {"OMPI_MCA_orte_create_session_dirs": "1"}
        for more, words in (({"TMPDIR": "/proc", **session}, "cannot write into /proc, which TMPDIR names: "),
                            ({"OMPI_MCA_ess_singleton_isolated": "0"}, "set OMPI_MCA_plm_rsh_agent= (empty)")):
            with self.subTest(more=more):
                environment = {"PATH": str(self.folder), **more}
                result = subprocess.run([SCREE, "run", self.deck, "--output", "out"], cwd=self.folder, env=environment,
                                        capture_output=True, text=True, timeout=LIMIT)
                last = result.stderr.splitlines()[-1]
                self.assertEqual(result.returncode, FAILED, result.stderr)
                self.assertTrue(last.startswith("error: MPI cannot start, for the reason given above. Remedy: "), last)
                self.assertIn(words, last)
                self.assertEqual(result.stderr.count("error: MPI"), 1)
                self.assertFalse((self.folder / "out").exists())


class AnotherProcessor(CommandLineTest):
    def test_the_first_thing_is_one_line(self):
        result = subprocess.run([os.environ["OTHER_PROCESSOR"]], capture_output=True, text=True, timeout=LIMIT)
        self.assertEqual((result.returncode, result.stdout), (BAD_INPUT, ""))
        self.assertRegex(result.stderr, "^error: this program was built for a processor with THIS, THAT, VECTORS "
                                        "and 1 more, all of which this processor lacks: .* for every processor with "
                                        "-D SCREE_NATIVE=OFF\n$")

    def test_the_version_names_the_instructions(self):
        text = self.expect(DONE, "--version").stdout
        native = "-march=native" in text
        every = r"\nfor every processor of this architecture\n"
        self.assertRegex(text, r"\nfor processors with [A-Z]" if native else every)


if __name__ == "__main__":
    unittest.main()
