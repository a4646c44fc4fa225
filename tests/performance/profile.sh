#!/usr/bin/env bash
# Profiles the kernels with Nsight Compute, caches and clocks as steps find them; needs a GPU.
#   tests/performance/profile.sh BUILD_DIR OUT_DIR [PARTICLES ...]      (default: 1000000)
# Of explicit steps (double, mixed) and implicit steps of a settled bed, SKIP and COUNT choose the launches (default: 60
# after the first 150: at one or more launches per step they hold list rebuilds, every 25 steps). Of profile.toml, a net on
# a million spheres, explicit and implicit, every launch counts, up to WHOLE (default 300): a few steps with ghosts, shapes
# and output.
# Writes OUT_DIR/CASE.csv and, with the bandwidth of copies that is measured first, OUT_DIR/profile.md.
set -euo pipefail
if (($# < 2)); then
  echo "usage: tests/performance/profile.sh BUILD_DIR OUT_DIR [PARTICLES ...]" >&2
  exit 2
fi
build=$1 out=$2
shift 2
sizes=("$@")
((${#sizes[@]})) || sizes=(1000000)
here=$(dirname "${BASH_SOURCE[0]}")
command -v ncu >/dev/null || { echo "error: ncu of the CUDA toolkit must be on the PATH" >&2; exit 2; }
mkdir -p "$out"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

metrics=$(python3 "$here/profile_table.py" --metrics)
files=()
# profile CASE SKIP COUNT PROGRAM ...
profile() {
  local file=$out/$1.csv skip=$2 count=$3
  shift 3
  ncu --clock-control none --cache-control none --launch-skip "$skip" --launch-count "$count" --metrics "$metrics" \
    --page raw --csv --print-units base --log-file "$file" --force-overwrite "$@" || { tail -n 3 "$file" >&2; return 1; }
  files+=("$file")
}
# --seconds 0: the shortest samples, so that the program ends soon after the launches that are profiled.
bed() {
  local name=$1 size=$2
  shift 2
  profile "${name}_$size" "${SKIP:-150}" "${COUNT:-60}" \
    "$build/tests/performance/bed" --backend cuda --particles "$size" --seconds 0 --repeats 40 "$@"
}
whole() {
  local name=$1
  shift
  profile "$name" 0 "${WHOLE:-300}" \
    "$build/scree" run "$here/profile.toml" --backend cuda --output "$scratch/$name" --overwrite "$@"
}

bandwidth=$("$build/tests/performance/copy_bandwidth" | sed -n 's/.*written: \([0-9.]*\) GB\/s.*/\1/p')
status=0
for size in "${sizes[@]}"; do
  bed explicit_double "$size" --precision double || status=1
  bed implicit_double "$size" --integrator hht || status=1
  bed explicit_mixed "$size" --precision mixed || status=1
done
whole explicit_net || status=1
h=2.5e-3
whole implicit_net --set integrator.particles=hht --set time.step=$h --set time.end=5e-3 \
  --set output.history_interval=$h --set output.snapshot_interval=$h --set output.checkpoint_interval=$h || status=1
# A case that failed leaves no table; the others have theirs.
for file in "${files[@]}"; do
  python3 "$here/profile_table.py" --copy-bandwidth "$bandwidth" "$file" || status=1
done >"$out/profile.md"
exit "$status"
