#!/usr/bin/env bash
# Runs the paper's cases 5.2 and 5.3 on both backends and compares the histories, digit for digit; needs a GPU.
#   tests/verification/same_bits.sh SCREE
set -euo pipefail
if (($# != 1)); then
  echo "usage: tests/verification/same_bits.sh SCREE" >&2
  exit 2
fi
scree=$1
decks=$(dirname "${BASH_SOURCE[0]}")/../../input/paper
results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT

# same DECK OPTIONS...: one backend after the other, each from the start.
same() {
  local deck=$1 backend
  shift
  for backend in cpu cuda; do
    "$scree" run "$decks/$deck.toml" --backend "$backend" --output "$results/$backend" \
      --set output.history_csv=true --set output.history_interval=1e-3 "$@" >"$results/log" 2>&1 ||
      { tail -n 5 "$results/log"; exit 1; }
  done
  if cmp "$results/cpu/history.csv" "$results/cuda/history.csv"; then
    echo "same digits in $(wc -l <"$results/cpu/history.csv") rows: $deck $*"
  else
    exit 1
  fi
}

same valley --set time.end=1 --set time.step=1e-3
same valley --set time.end=0.8 --set time.step=1e-4
same net_9 --set time.end=0.5 --set time.step=1e-4
same net_400 --set time.end=0.7 --set time.step=5e-4
same net_400 --set time.end=0.7 --set time.step=1e-4 --set integrator.particles=velocity-verlet \
  --set integrator.substeps=10
