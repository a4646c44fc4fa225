#!/usr/bin/env bash
# Profiles the kernels of explicit steps (double, mixed) and implicit steps with Nsight Compute; needs a GPU.
#   tests/performance/profile.sh BUILD_DIR OUT_DIR [PARTICLES ...]      (default: 1000000 4000000)
# Writes OUT_DIR/CASE_PARTICLES.csv, which profile_table.py turns into tables. SKIP and COUNT choose the launches
# (default: 300 after the first 300: at one or more launches per step they hold list rebuilds, every 25 steps).
set -euo pipefail
if (($# < 2)); then
  echo "usage: tests/performance/profile.sh BUILD_DIR OUT_DIR [PARTICLES ...]" >&2
  exit 2
fi
build=$1 out=$2
shift 2
sizes=("$@")
((${#sizes[@]})) || sizes=(1000000 4000000)
command -v ncu >/dev/null || { echo "error: ncu of the CUDA toolkit must be on the PATH" >&2; exit 2; }
mkdir -p "$out"

metrics=gpu__time_duration.sum,dram__bytes_read.sum,dram__bytes_write.sum
metrics+=,lts__t_sectors.sum,lts__t_sectors.avg.pct_of_peak_sustained_elapsed,lts__t_sector_hit_rate.pct
metrics+=,l1tex__t_sector_hit_rate.pct,launch__registers_per_thread,sm__warps_active.avg.pct_of_peak_sustained_active

# --seconds 0: the shortest samples, so that the program ends soon after the launches that are profiled.
profile() {
  local name=$1 size=$2
  shift 2
  ncu --clock-control none --launch-skip "${SKIP:-300}" --launch-count "${COUNT:-300}" --metrics "$metrics" \
    --page raw --csv --print-units base --log-file "$out/${name}_$size.csv" --force-overwrite \
    "$build/tests/performance/bed" --backend cuda --particles "$size" --seconds 0 --repeats 40 "$@"
}

status=0
for size in "${sizes[@]}"; do
  profile explicit_double "$size" --precision double || status=1
  profile implicit_double "$size" --integrator hht || status=1
  profile explicit_mixed "$size" --precision mixed || status=1
done
exit "$status"
