#!/usr/bin/env bash
# Many particles on several ranks: generates them, runs some steps, writes snapshots and checkpoints, and restarts from the
# one on the way, which must end in the same state; with the largest memory of a rank after each.
#   tests/performance/large.sh [BUILD_DIR] [PARTICLES] [RANKS...]      (default build/release 1000000 1 2)
# BACKEND=cuda in the environment: on GPUs, with more ranks than GPUs on shared ones; default cpu.
# PARTICLES: about so many, a cubic lattice. The results (some 700 bytes per particle) go to a temporary folder
# (TMPDIR), which is removed. What a rank takes for a thousand particles is measured first, and taken off per particle.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${1:-build/release} particles=${2:-1000000}
shift $(($# < 2 ? $# : 2))
counts=("$@")
(($# > 0)) || counts=(1 2)
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
backend=${BACKEND:-cpu}
# Programs that were built elsewhere are taken as they are.
if [[ -e $build/CMakeCache.txt ]]; then cmake --build "$build" --target scree >/dev/null; fi
side=$(awk -v n="$particles" 'BEGIN { printf "%d", n ^ (1 / 3) + 0.5 }')
particles=$((side * side * side))
echo "machine: $(grep -m1 'model name' /proc/cpuinfo | cut -d: -f2-), $(nproc) cores, backend $backend, commit \
$("$build/scree" --version | sed -n '1s/.*commit \([^)]*\)).*/\1/p'), $particles particles"

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

write_deck() { # SIDE
  cat >"$folder/large.toml" <<DECK
[space]
dimension = 3
min = [0.0, 0.0, 0.0]
max = [$1.0, $1.0, $1.0]
x_min = "wall"
x_max = "wall"
y_min = "wall"
y_max = "wall"
z_min = "wall"
z_max = "wall"
[integrator]
particles = "velocity-verlet"
[time]
end = 2e-3
step = 1e-4
control = "fixed"
[[contact.pairs]]
stiffness = 1e5
[[particles]]
kind = "lattice"
origin = [0.5, 0.5, 0.5]
spacing = [1.0, 1.0, 1.0]
size = [$1, $1, $1]
radius = 0.49
mass = 1.0
random_velocity = 0.1
[output]
snapshot_interval = 2e-3
history_interval = 1e-3
checkpoint_interval = 1.2e-3
DECK
}

# Runs scree on so many ranks; leaves the largest memory of a rank [kB] and the seconds in `memory` and `seconds`.
run() { # RANKS ARGUMENTS...
  local ranks=$1 start=$SECONDS
  shift
  rm -f "$folder"/memory.*
  mpirun --oversubscribe -n "$ranks" python3 tests/performance/peak_memory.py "$folder/memory" \
    "$build/scree" run "$folder/large.toml" --backend "$backend" "$@" >"$folder/log" 2>&1 || {
    cat "$folder/log"
    exit 1
  }
  memory=$(cat "$folder"/memory.* | sort -g | tail -1)
  seconds=$((SECONDS - start))
}

report() { # RANKS WHAT
  awk -v ranks="$1" -v what="$2" -v seconds="$seconds" -v kb="$memory" -v base="$base" -v n="$particles" 'BEGIN {
    printf "%3d rank(s), %-7s %4d s, %7.1f MB on the largest rank, %4.0f B per particle of its share\n",
      ranks, what, seconds, kb / 1e3, (kb - base) * 1e3 / (n / ranks) }'
  note "$1 ranks $2, memory" "$(awk -v kb="$memory" 'BEGIN { printf "%.0f", kb / 1e3 }')" MB
  note "$1 ranks $2, seconds" "$seconds" s
  note "$1 ranks $2, per particle" "$(awk -v ranks="$1" -v kb="$memory" -v base="$base" -v n="$particles" \
    'BEGIN { printf "%.0f", (kb - base) * 1e3 / (n / ranks) }')" B
}

note() { # COLUMN VALUE UNIT
  python3 tests/support/measured.py "large/$backend, $particles particles/$1" "$2" "$3" \
    --record "$folder/out/run_record.json" --command "large.sh $particles ${counts[*]}"
}

hash_of() { # FOLDER
  python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["run"]["state_hash"])' "$folder/$1/run_record.json"
}

for n in "${counts[@]}"; do
  write_deck 10
  run "$n" --output "$folder/small"
  base=$memory
  write_deck "$side"
  run "$n" --output "$folder/out"
  report "$n" start
  rm "$folder/out/particles.vtkhdf" "$folder/out/checkpoint_end.h5" # room for the next run's
  run "$n" --output "$folder/again" --restart "$folder/out/checkpoint.h5"
  report "$n" restart
  [[ "$(hash_of out)" == "$(hash_of again)" ]] || {
    echo "the restart ends in another state" >&2
    exit 1
  }
  rm -rf "$folder/out" "$folder/again" "$folder/small"
done
