"""How ghosts travel between GPUs: which transports a run can have, that it says which, and that all give the same bits.
Usage: SCREE=path/to/scree MPIEXEC=path/to/mpirun python3 test_transports.py
on GPUs: SCREE_TEST_BACKEND=cuda BUILT_WITH_NCCL=1 (or 0) and the same"""

import os
import subprocess
import unittest

from mpi_case import (BACKEND, BAD_INPUT, DAM, DONE, ENVIRONMENT, EXPLICIT, HERE, IMPLICIT, INPUT, LIMIT, RanksTest,
                      gpus)

BUILT_WITH_NCCL = os.environ.get("BUILT_WITH_NCCL", "1") == "1"
NAMES = {"peer": "peer memory and ", "cuda-aware": "CUDA-aware MPI", "nccl": "NCCL", "staged": "copies in host memory"}
# So many that --backend auto would give each of two ranks a GPU.
GAS = [INPUT / "examples/gas_periodic.toml", "particles.gas.count=5000", "output.snapshot_interval=1.0"]
CASES = {
    "dam break, implicit": [*DAM, *IMPLICIT, "time.end=0.06"],
    "dam break, explicit": [*DAM, *EXPLICIT, "integrator.substeps=3", "time.end=0.06"],
    "gas, implicit": [*GAS, *IMPLICIT, "time.end=0.002"],
    "gas, explicit": [*GAS, *EXPLICIT, "time.end=0.01"],
}
# 10,000 steps with lists at irregular times, for which particles and ghosts change their places and numbers: as
# rarely as each 100 steps, so that most of them are in graphs, and as often as each fourth.
LONG = {f"gas, skin {skin}": [*GAS, *EXPLICIT, "time.end=0.2", "output.history_interval=0.05", f"contact.skin={skin}"]
        for skin in (2e-2, 5e-4)}
LONG["friction"] = [HERE / "friction.toml", *EXPLICIT, "time.step=2e-5", "time.end=0.2", "output.history_interval=0.05"]
NO_GPU, ONE_GPU = ["env", "CUDA_VISIBLE_DEVICES="], ["env", "CUDA_VISIBLE_DEVICES=0"]


def forced(transport):
    return f"parallel.transport={transport}"


class ForcedTransportTest(RanksTest):
    def assert_refused(self, transport, why, **how):
        """With one message, which holds one list of what is allowed; returns that list."""
        deck, *settings = GAS
        result = self.run_deck(BAD_INPUT, 2, deck, "refused", [*settings, forced(transport)], **how)
        self.assert_one_message(result, f': parallel.transport = "{transport}"', why)
        self.assertEqual(result.stderr.count("allowed here: "), 1, result.stderr)
        self.assertFalse((self.folder / "refused").exists())
        return result.stderr.split("allowed here: ")[1].splitlines()[0]


class NoGpuTest(ForcedTransportTest):
    deck, *SETTINGS = [*GAS, "time.end=1e-4"]

    def test_the_cpu_does_not_stand_in_for_a_forced_transport(self):
        for transport in NAMES:
            with self.subTest(transport=transport):
                allowed = self.assert_refused(transport, "is for GPUs: ", backend="auto", before=NO_GPU)
                self.assertEqual(allowed, '"auto", or --backend cpu')

    def test_the_cpu_is_taken_where_none_is_forced_or_needed(self):
        few = [*self.SETTINGS, "particles.gas.count=500"]
        for name, ranks, backend, settings in (("none forced", 2, "auto", self.SETTINGS),
                                               ("one rank", 1, "auto", [*self.SETTINGS, forced("nccl")]),
                                               ("few particles", 2, "auto", [*few, forced("nccl")]),
                                               ("CPU chosen", 2, "cpu", [*self.SETTINGS, forced("nccl")])):
            with self.subTest(name):
                log = self.run_deck(DONE, ranks, self.deck, name, settings, backend=backend, before=NO_GPU).stdout
                self.assertIn("backend cpu: ", log)
                self.assertEqual('parallel.transport = "nccl" is for GPUs' in log, forced("nccl") in settings)
                self.assertIn("cpu", self.record(name)["run"]["backend"])


@unittest.skipUnless(BACKEND == "cuda", "needs a GPU")
class TransportTest(ForcedTransportTest):
    def setUp(self):
        super().setUp()
        self.mpi_takes_device_memory = self.is_taken("cuda-aware")
        self.memory_is_shared = gpus() > 1 and self.is_taken("peer")

    def is_taken(self, transport):
        words = self.command(2, DAM[0], "trial", [*EXPLICIT, "time.end=1e-3", forced(transport)])
        result = subprocess.run(words, cwd=self.folder, env=ENVIRONMENT, capture_output=True, text=True, timeout=LIMIT)
        self.assertIn(result.returncode, (DONE, BAD_INPUT), result.stdout + result.stderr)
        return result.returncode == DONE

    def working(self, visible):
        """The transports that two ranks can have on so many GPUs, in the order in which auto looks for them."""
        works = {"peer": self.memory_is_shared and visible > 1, "cuda-aware": self.mpi_takes_device_memory,
                 "nccl": BUILT_WITH_NCCL and visible > 1, "staged": True}
        return [transport for transport in NAMES if works[transport]]

    def assert_runs(self, transport, name, overrides, output, **how):
        """On two ranks, with ghosts on the way of that name, in the log and in the record; returns the hash."""
        deck, *settings = overrides
        log = self.run_deck(DONE, 2, deck, output, [*settings, forced(transport)], **how).stdout
        used = NAMES[name] + (NAMES[self.working(gpus())[1]] if name == "peer" else "")
        for text in (log, self.record(output)["run"]["backend"]):
            self.assertIn(f"precision double, 2 ranks, halo by {used})", text)
        return self.hash(output)

    def test_every_transport_gives_the_bits_of_one_rank(self):
        for case, overrides in CASES.items():
            deck, *settings = overrides
            self.run_deck(DONE, 1, deck, "one", settings)
            working = self.working(gpus())
            for transport, name in [("auto", working[0]), *((one, one) for one in working)]:
                with self.subTest(case=case, transport=transport):
                    self.assertEqual(self.assert_runs(transport, name, overrides, "two"), self.hash("one"))

    def test_ranks_that_share_a_gpu_have_the_bits_of_one_rank(self):
        deck, *settings = CASES["gas, explicit"]
        self.run_deck(DONE, 1, deck, "one", settings)
        working = self.working(1)
        for backend in ("auto", "cuda"):
            for transport, name in [("auto", working[0]), *((one, one) for one in working)]:
                with self.subTest(backend=backend, transport=transport):
                    found = self.assert_runs(transport, name, CASES["gas, explicit"], "two", backend=backend,
                                             before=ONE_GPU)
                    self.assertEqual(found, self.hash("one"))

    @unittest.skipIf(gpus() < 2, "needs two GPUs")
    def test_many_steps_through_peer_memory_have_the_bits_of_one_rank(self):
        if not self.memory_is_shared:
            self.skipTest("these GPUs do not write each other's memory")
        for case, (deck, *settings) in LONG.items():
            self.run_deck(DONE, 1, deck, "one", settings)
            for ranks in [n for n in (2, 3, 4, 8) if n <= gpus()]:
                with self.subTest(case=case, ranks=ranks):
                    self.run_deck(DONE, ranks, deck, "many", [*settings, forced("peer")])
                    self.assertIn(f"{ranks} ranks, halo by peer memory and ", self.record("many")["run"]["backend"])
                    self.assertEqual(self.hash("many"), self.hash("one"))

    @unittest.skipIf(gpus() < 2, "needs two GPUs")
    def test_mixed_precision_has_the_bits_of_other_transports(self):
        deck, *settings = [*LONG["friction"], "integrator.precision=mixed", "time.end=0.04"]
        hashes = {}
        for transport in self.working(gpus()):
            self.run_deck(DONE, 2, deck, "mixed", [*settings, forced(transport)])
            hashes[transport] = self.hash("mixed")
        self.assertEqual(len(set(hashes.values())), 1, hashes)

    def test_a_transport_that_cannot_be_had_ends_the_run(self):
        no_nccl = "two ranks share a GPU" if BUILT_WITH_NCCL else "this program was built without NCCL"
        refused = [("nccl", no_nccl), ("peer", "two ranks share a GPU")]
        if not self.mpi_takes_device_memory:
            refused.append(("cuda-aware", "this MPI library does not take device memory"))
        expected = ", ".join(f'"{transport}"' for transport in ("auto", *self.working(1)))
        for transport, why in refused:
            for backend in ("auto", "cuda"):
                with self.subTest(transport=transport, backend=backend):
                    allowed = self.assert_refused(transport, why, backend=backend, before=ONE_GPU)
                    self.assertEqual(allowed, expected)


if __name__ == "__main__":
    unittest.main(verbosity=2)
