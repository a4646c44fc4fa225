#!/usr/bin/env bash
# Sets up, builds, and runs all tests that need no GPU.
#
#     tests/run.sh [--paraview] [--slurm] [CTEST OPTIONS]
#
# --paraview adds the tests that open results in Debian's ParaView, and installs that. --slurm installs SLURM; the
# test of the sbatch files is skipped without it. CTEST OPTIONS select tests, for instance -L unit or -R verification.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

selection=(--label-exclude paraview)
while [[ "${1:-}" == --paraview || "${1:-}" == --slurm ]]; do
  jobs/setup.sh "$1"
  if [[ "$1" == --paraview ]]; then selection=(); fi
  shift
done
jobs/build.sh release

status=0
# mpirun binds one or two ranks to the first processors, those of several tests at a time to the same ones.
export OMPI_MCA_hwloc_base_binding_policy=none
# Many tests wait: for SLURM, signals, processes that start, disks. Half as many again as there are processors keep these busy.
processors=$(nproc)
ctest --test-dir build/release --output-on-failure --no-tests=error --parallel $((processors + processors / 2)) \
  "${selection[@]}" "$@" || status=$?
if ((status == 0)); then
  echo "tests/run.sh: all tests passed in $SECONDS s, set-up and build included"
else
  echo "tests/run.sh: tests FAILED; their output is above and in build/release/Testing/Temporary/LastTest.log"
fi
exit "$status"
