#!/usr/bin/env bash
# What recipe.yaml runs in the source tree, with PREFIX, CPU_COUNT and CMAKE_ARGS from the environment of conda.
set -euo pipefail

read -r -a arguments <<<"${CMAKE_ARGS:-}"
cmake -S . -B build/conda -G Ninja "${arguments[@]}" -D CMAKE_BUILD_TYPE=Release -D CMAKE_INSTALL_PREFIX="$PREFIX" \
  -D CMAKE_INSTALL_LIBDIR=lib -D SCREE_NATIVE=OFF -D SCREE_TESTS=OFF -D SCREE_KLU=ON -D SCREE_PARALLEL_HDF5=ON
cmake --build build/conda --parallel "${CPU_COUNT:-1}"
cmake --install build/conda
