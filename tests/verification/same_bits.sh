#!/usr/bin/env bash
# Both backends give the same bits, run by run: the paper's cases 5.1 to 5.3, spheres with friction on each other and on
# bodies, in the plane and in space, or are half-way through sheets, and runs that one backend begins and the other
# continues from its checkpoint.
# Compares the histories, whose digits stand for all bits, and the hashes of the last states.
# Needs a GPU.
#   tests/verification/same_bits.sh SCREE
set -euo pipefail
if (($# != 1)); then
  echo "usage: tests/verification/same_bits.sh SCREE" >&2
  exit 2
fi
scree=$1
decks=$(dirname "${BASH_SOURCE[0]}")/../../input
results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT

# run BACKEND FOLDER DECK OPTIONS...
run() {
  local backend=$1 folder=$2 deck=$3
  shift 3
  "$scree" run "$decks/$deck.toml" --backend "$backend" --output "$results/$folder" --overwrite --set output.history_csv=true "$@" \
    >"$results/log" 2>&1 ||
    { tail -n 5 "$results/log"; exit 1; }
}

state_hash() {
  grep -oE '"state_hash" *: *"[0-9a-f]{16}"' "$results/$1/run_record.json" || { echo "no state_hash in $1" >&2; exit 1; }
}

# compare FOLDER FOLDER WHAT: of two runs.
compare() {
  local a b
  cmp "$results/$1/history.csv" "$results/$2/history.csv"
  a=$(state_hash "$1") b=$(state_hash "$2")
  if [[ "$a" != "$b" ]]; then
    echo "$3: the same history, but $a in $1 and $b in $2"
    exit 1
  fi
  echo "same bits in $(($(wc -l <"$results/$1/history.csv") - 1)) rows and the last state: $3"
}

# same DECK OPTIONS...: one backend after the other, each from the start.
same() {
  local backend
  for backend in cpu cuda; do run "$backend" "$backend" "$@" --set output.history_interval=1e-3; done
  compare cpu cuda "$*"
}

# continued DECK HALF END OPTIONS...: what one backend computes up to HALF the other continues to END. Both are whole 256ths
# of a second, so that the run from start to end comes by at exactly HALF, too.
continued() {
  local deck=$1 half=$2 end=$3 first second
  shift 3
  local options=(--set output.history_interval=0.00390625 "$@")
  run cpu whole "$deck" --set "time.end=$end" "${options[@]}"
  for first in cpu cuda; do
    second=$([[ "$first" == cpu ]] && echo cuda || echo cpu)
    run "$first" parts "$deck" --set "time.end=$half" "${options[@]}"
    run "$second" parts "$deck" --set "time.end=$end" "${options[@]}" --restart "$results/parts/checkpoint_end.h5"
    compare whole parts "$first up to $half s, then $second: $deck $*"
  done
}

net=(--set "output.history_contacts=['net','net.9']")
explicit=(--set integrator.particles=velocity-verlet --set integrator.substeps=10)

same paper/net --set time.end=1
same paper/valley --set time.end=1 --set time.step=1e-3
same paper/valley --set time.end=0.8 --set time.step=1e-4
same paper/net_9 --set time.end=0.5 --set time.step=1e-4
same paper/net_400 --set time.end=0.7 --set time.step=5e-4 "${net[@]}"
same paper/net_400 --set time.end=0.7 --set time.step=1e-4 "${explicit[@]}" "${net[@]}"
for deck in friction friction_hertz frictional_bodies spatial_bodies spatial_elements open_surfaces; do same ../tests/ranks/$deck; done
for deck in friction friction_hertz; do
  same ../tests/ranks/$deck --set integrator.particles=hht --set time.control=fixed --set time.step=8e-5
done
for deck in spatial_bodies spatial_elements sheets; do
  same ../tests/ranks/$deck --set integrator.particles=hht --set time.control=fixed --set integrator.substeps=1
done
# Implicit and explicit, with bodies and without, and with contacts that remember; particles touch at half time.
continued paper/net_400 0.5 0.5625 --set time.step=1e-3
continued paper/net_400 0.5 0.5625 --set time.step=1e-4 "${explicit[@]}"
continued examples/heap_900 0.0625 0.125 --set "output.history_contacts=['x_min','y_min']"
continued examples/gas_periodic 0.03125 0.0625
for deck in friction friction_hertz frictional_bodies spatial_elements open_surfaces; do continued ../tests/ranks/$deck 0.04296875 0.08203125; done
