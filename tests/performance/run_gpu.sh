#!/usr/bin/env bash
# Everything that is measured on a GPU, in one go; each part writes its own file into OUT_DIR.
#   tests/performance/run_gpu.sh BUILD_DIR OUT_DIR [PART ...]
# PART: copy explicit implicit net output table4 profile (default: all). A part that fails is named at the end, and the
# others still run. SCREE_COMMIT names the commit where the build does not know it. BUDGET: seconds per run of table4.
# SAMPLES: options of bed for other samples than its own choice (five of 0.5 s): SAMPLES="--repeats 3 --seconds 0.15".
set -uo pipefail
if (($# < 2)); then
  echo "usage: tests/performance/run_gpu.sh BUILD_DIR OUT_DIR [copy explicit implicit net output table4 profile]" >&2
  exit 2
fi
build=$1 out=$2
shift 2
parts=("$@")
((${#parts[@]} == 0)) && parts=(copy explicit implicit net output table4 profile)
here=$(dirname "${BASH_SOURCE[0]}")
read -ra samples <<<"${SAMPLES:-}"
bed=("$build/tests/performance/bed" "${samples[@]}")
mkdir -p "$out" || exit 4

heading() {
  echo "commit: ${SCREE_COMMIT:-$("$build/scree" --version | sed -n '1s/.*commit \([^)]*\)).*/\1/p')}"
  echo "GPU: $(nvidia-smi --query-gpu=name,driver_version,clocks.sm,clocks.mem,power.limit --format=csv,noheader)"
  echo "host: $(grep -m1 'model name' /proc/cpuinfo | cut -d: -f2- | sed 's/^ *//'), $(nproc) processors"
  echo
}

copy() {
  local text
  text=$("$build/tests/performance/copy_bandwidth") || return 1
  echo "$text"
  python3 "$here/../support/measured.py" "copy/bandwidth" "$(sed -n 's/.*written: \([0-9.]*\) GB\/s.*/\1/p' <<<"$text")" GB/s \
    --machine "${text%%:*}" --backend cuda --command copy_bandwidth
}

explicit() {
  local sizes=(10000 100000 1000000 4000000 16000000) precision rebuild status=0
  for precision in double mixed; do
    for rebuild in 25 0; do
      "${bed[@]}" --backend cuda --precision "$precision" --rebuild "$rebuild" --particles "${sizes[@]}" ||
        status=1
    done
    "${bed[@]}" --backend cuda --precision "$precision" --rebuild 0 --dimension 2 --particles "${sizes[@]}" || status=1
  done
  "${bed[@]}" --particles 10000 100000 1000000 || status=1
  return $status
}

implicit() {
  local status=0
  "${bed[@]}" --backend cuda --integrator hht --particles 10000 100000 1000000 4000000 || status=1
  "${bed[@]}" --integrator hht --particles 10000 100000 || status=1
  return $status
}

net() { "${bed[@]}" --backend cuda --net --particles 10000 100000 1000000 4000000; }

output() { python3 "$here/output_cost.py" "$build/scree"; }

table4() {
  python3 "$here/table4.py" "$build/scree" --backends cpu cuda --budget "${BUDGET:-30}" --out "$out/table4"
  local status=$?
  cat "$out/table4/table4.md"
  return $status
}

profile() {
  local status=0
  "$here/profile.sh" "$build" "$out/profile" >"$out/profile.log" 2>&1 || { tail -n 5 "$out/profile.log"; status=1; }
  cat "$out/profile/profile.md" || status=1
  return $status
}

failed=()
for part in "${parts[@]}"; do
  case $part in
    copy | explicit | implicit | net | output | table4 | profile) ;;
    *)
      echo "error: part $part; allowed: copy explicit implicit net output table4 profile" >&2
      exit 2
      ;;
  esac
done
for part in "${parts[@]}"; do
  { heading && "$part"; } >"$out/$part.txt" 2>&1 || failed+=("$part")
  echo "$part: $out/$part.txt"
done
if ((${#failed[@]})); then
  echo "error: failed: ${failed[*]}" >&2
  exit 1
fi
