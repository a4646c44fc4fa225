#!/usr/bin/env bash
# Sets up, configures and builds.
#
#     jobs/build.sh [PRESET] [TARGET ...]      default: release, all
#
# PRESET: release; debug (sanitizers); cuda (for the GPU of this machine); cuda-portable (for GPUs of other machines);
# package (for other machines, without GPUs; its target package makes packages: jobs/packaging/README.md).
# The program is then build/PRESET/scree. For the target scree alone nothing is installed or configured that only tests need,
# unless they have been. nvcc is the one that the environment variable CUDACXX names, or the one on
# the PATH, or the one that jobs/setup.sh --cuda has installed into .venv.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

preset=${1:-release}
targets=("${@:2}")
((${#targets[@]} > 0)) || targets=(all)
setup=() options=()
if [[ "${targets[*]}" == scree ]] && ! grep -qs '^SCREE_TESTS:BOOL=ON' "build/$preset/CMakeCache.txt"; then
  setup=(--program) options=(-D SCREE_TESTS=OFF)
fi
case "$preset" in
  release | debug) ;;
  package) setup=(--package) ;;
  cuda | cuda-portable)
    installed=(.venv/lib/python3*/site-packages/nvidia/cu*/bin/nvcc) # a pattern that fits nothing stays as it is
    if [[ -z "${CUDACXX:-}" && -x "${installed[-1]}" ]] && ! command -v nvcc >/dev/null; then
      export CUDACXX=$PWD/${installed[-1]}
    fi
    ;;
  *)
    echo "jobs/build.sh: unknown preset $preset; allowed: release, debug, cuda, cuda-portable, package" >&2
    exit 2
    ;;
esac
jobs/setup.sh "${setup[@]}"
cmake --preset "$preset" "${options[@]}" >/dev/null
cmake --build "build/$preset" --target "${targets[@]}"
