#!/usr/bin/env bash
# Sets up, configures and builds.
#
#     jobs/build.sh [PRESET] [TARGET]      default: release, all
#
# The program is then build/PRESET/scree.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

preset=${1:-release} target=${2:-all}
jobs/setup.sh
cmake --preset "$preset" >/dev/null
cmake --build "build/$preset" --target "$target"
