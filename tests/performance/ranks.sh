#!/usr/bin/env bash
# How much faster several ranks are than one on this machine: explicit steps of a settled bed of frictionless discs,
# wall seconds; the runs alternate, so that other work on the machine meets all of them.
#   tests/performance/ranks.sh [BUILD_DIR] [PARTICLES] [RANKS...]      (default build/release 1000000 2)
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${1:-build/release} particles=${2:-1000000}
shift $(($# < 2 ? $# : 2))
counts=(1 "${@:-2}")
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
cmake --build "$build" --target bed >/dev/null
echo "machine: $(grep -m1 'model name' /proc/cpuinfo | cut -d: -f2-), $(nproc) cores, load $(cut -d' ' -f1 /proc/loadavg), \
commit $(git rev-parse --short HEAD 2>/dev/null || echo unknown)"

note() { # COLUMN VALUE UNIT
  python3 tests/support/measured.py "cpu_ranks/$particles discs/$1" "$2" "$3" --command "ranks.sh $particles ${counts[*]:1}"
}

results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT
for _ in 1 2 3; do
  for n in "${counts[@]}"; do
    # Also one rank is timed by the wall here.
    mpirun --oversubscribe -n "$n" "$build/tests/performance/bed" --dimension 2 --rebuild 0 --wall \
      --particles "$particles" --repeats 3 >"$results/log"
    sed -n 's/.* particle-steps\/s, \([0-9.e+]*\) us per step.*/\1/p' "$results/log" >>"$results/$n"
  done
done
for n in "${counts[@]}"; do
  median=$(sort -g "$results/$n" | sed -n 2p) one=$(sort -g "$results/1" | sed -n 2p)
  note "$n ranks step" "$(awk -v us="$median" 'BEGIN { printf "%.4g", us / 1e3 }')" ms
  note "$n ranks speed-up" "$(awk -v us="$median" -v one="$one" 'BEGIN { printf "%.3g", one / us }')" ""
  awk -v n="$n" -v one="$one" -v samples="$(tr '\n' ' ' <"$results/$n")" \
    -v median="$median" \
    'BEGIN { printf "%3d rank(s): %.4g ms per step (samples [us]: %s), %.2f times as fast, efficiency %.0f %%\n", n, median / 1e3, samples, one / median, 100 * one / median / n }'
done
