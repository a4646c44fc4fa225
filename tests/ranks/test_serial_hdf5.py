"""The program as it is where HDF5 is not a parallel library against the one whose ranks write at once.
Usage: SCREE=path/to/scree SCREE_SERIAL_HDF5=path/to/scree_serial_hdf5 MPIEXEC=path/to/mpirun
    python3 test_serial_hdf5.py
"""

import os
import unittest

from mpi_case import DAM, DONE, EXPLICIT, SCREE, RanksTest

SERIAL = os.environ["SCREE_SERIAL_HDF5"]


class SerialHdf5Test(RanksTest):
    def run_with(self, program, output, compression):
        self.program = program
        self.run_deck(DONE, 2, DAM[0], output, [*EXPLICIT, "integrator.substeps=3", "time.end=0.02",
                                                "output.snapshot_interval=0.01", f"output.compression={compression}"])
        return self.record(output)["build"]["libraries"]["HDF5"]

    def test_both_programs_write_the_same_files(self):
        for compression in (0, 3):
            with self.subTest(compression=compression):
                outputs = [f"at once {compression}", f"through rank 0 {compression}"]
                self.assertIn("all ranks write", self.run_with(SCREE, outputs[0], compression))
                self.assertIn("rank 0 writes for all", self.run_with(SERIAL, outputs[1], compression))
                self.assertEqual(*map(self.hash, outputs))
                for name in ("particles.vtkhdf", "bodies.vtkhdf", "history.h5", "checkpoint_end.h5"):
                    files = [self.datasets(output, name) for output in outputs]
                    self.assertGreater(len(files[0]), 0)
                    self.assertEqual(*files, name)


if __name__ == "__main__":
    unittest.main(verbosity=2)
