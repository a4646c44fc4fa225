#!/usr/bin/env bash
# Measures what the first table of README.md beside this file says, on one core; prints CPU seconds.
#   tests/performance/run.sh [BUILD_DIR]      (default build/release; takes about two minutes)
# This script and those beside it leave their numbers in the folder SCREE_MEASURED, where the environment names one, for
# tests/performance/tables.py.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${1:-build/release}
cmake --build "$build" --target scree chain_scaling bed
results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT

echo "machine: $(grep -m1 'model name' /proc/cpuinfo | cut -d: -f2-), commit $(git rev-parse --short HEAD 2>/dev/null || echo unknown)"
echo
echo "Table 4, N = 900, one simulated second:"
net_900() {
  local name=$1 cpu=()
  shift
  for _ in 1 2 3; do
    "$build/scree" run input/paper/table4.toml --set particles.block.count=900 --output "$results/run" --overwrite "$@" \
      >"$results/log" 2>&1
    cpu+=("$(sed -n 's/.* s wall, \([0-9.]*\) s CPU.*/\1/p' "$results/log")")
  done
  printf '  %-62s %s s CPU (%s)\n' "$name" "$(printf '%s\n' "${cpu[@]}" | sort -n | sed -n 2p)" "${cpu[*]}"
  sed -n 's/^t = .* after/    /p' "$results/log"
  python3 tests/support/measured.py "table4_900/$name" "$(printf '%s\n' "${cpu[@]}" | sort -n | sed -n 2p)" s \
    --least "$(printf '%s\n' "${cpu[@]}" | sort -n | head -1)" --most "$(printf '%s\n' "${cpu[@]}" | sort -n | tail -1)" \
    --record "$results/run/run_record.json" --command run.sh
  local kind
  for kind in newton linear; do
    python3 tests/support/measured.py "table4_900/$name, $kind" "$(python3 -c 'import json, sys
counts = json.load(open(sys.argv[1]))["counts"]
print("%.3g" % (counts[sys.argv[2] + "_iterations"] / counts["steps"]))' "$results/run/run_record.json" "$kind")" "" \
      --record "$results/run/run_record.json" --command run.sh
  done
}
net_900 "implicit HHT, h = 1e-3" --set time.step=1e-3
explicit=(--set integrator.particles=velocity-verlet)
net_900 "explicit, h = 1e-5, bodies every 1e-4" --set time.step=1e-4 --set integrator.substeps=10 "${explicit[@]}"
net_900 "explicit, h = 1e-5, bodies every 1e-5" --set time.step=1e-5 "${explicit[@]}"
echo
echo "Explicit steps on a settled 2D bed of frictionless discs:"
"$build/tests/performance/bed" --dimension 2 --rebuild 0
echo
echo "Explicit and implicit steps on a settled 3D bed of frictionless spheres:"
"$build/tests/performance/bed" --particles 10000 100000 1000000
"$build/tests/performance/bed" --integrator hht --particles 10000 100000 --repeats 3
echo
echo "The same bed with a net of 20 bodies, solved every step:"
"$build/tests/performance/bed" --net --particles 10000 --repeats 3
echo
echo "Hanging chain of planar bodies on revolute joints:"
"$build/tests/performance/chain_scaling"
