#!/usr/bin/env bash
# How steps scale over the GPUs of a host, and over its cores, and a model of how that goes on.
#   tests/performance/gpu_ranks.sh BUILD_DIR OUT_DIR [PART ...]
# PART (default: all, in this order):
#   weak    settled bed of spheres, 8 million per rank, on 1, 2, 4, ... ranks
#   strong  16 million in all
#   bodies  8 million, the same with a hole for 20 bodies, and with the bodies: a row that is drawn through the bed by its
#           ends, 0.2 mm in each step, and solved every step
#   implicit  the settled bed in implicit steps, 1 million per rank
#   moving  a column of 2 million spheres that collapses
#   cpu     1 million discs on 1, 2, 4, ... 16 cores
#   chain   rank 0's solve against the number of bodies
#   tables  OUT_DIR/tables.md, from the rows of what was measured in OUT_DIR so far
#   model   OUT_DIR/scaling_model.md, .csv and .png, from the same (needs numpy, and matplotlib for the figure)
# The rows go into OUT_DIR/ranks.csv, implicit_ranks.csv, cpu_ranks.csv and chain.csv; of a run that was made twice the last counts. A run
# that fails is named at the end, and the others are still made. Settings, with their defaults:
#   BACKEND=cuda RANKS="1 2 4 8" (as many as GPUs; with BACKEND=cpu as cores)
#   WEAK=8000000 STRONG=16000000 BODIES=8000000 IMPLICIT=1000000 MOVING=2000000
#   BODY_STEPS=15000 (of bodies, in a sample at least: the row then moves by three diameters of a particle)
#   CPU_RANKS="1 2 4 8 16" (as many as cores) CPU_DISCS=1000000 PYTHON=python3
#   SAMPLES: options of bed for other samples than its own choice (five of 0.5 s): SAMPLES="--repeats 3 --seconds 0.2"
#   MODEL: options of scaling_model.py     MPIRUN: options of mpirun
set -uo pipefail
all=(weak strong bodies implicit moving cpu chain tables model)
if (($# < 2)); then
  echo "usage: tests/performance/gpu_ranks.sh BUILD_DIR OUT_DIR [${all[*]}]" >&2
  exit 2
fi
build=$1 out=$2
shift 2
parts=("$@")
((${#parts[@]})) || parts=("${all[@]}")
for part in "${parts[@]}"; do
  [[ " ${all[*]} " == *" $part "* ]] || { echo "error: part $part; allowed: ${all[*]}" >&2; exit 2; }
done
here=$(dirname "${BASH_SOURCE[0]}")
backend=${BACKEND:-cuda}
[[ $backend == cuda || $backend == cpu ]] || { echo "error: BACKEND=$backend; allowed: cuda, cpu" >&2; exit 2; }
python=${PYTHON:-python3}
read -ra samples <<<"${SAMPLES:-}"
read -ra mpirun_options <<<"${MPIRUN:-}"
read -ra model_options <<<"${MODEL:-}"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
mkdir -p "$out" || exit 4

# 1, 2, 4, ... up to a number.
powers() {
  local n
  for ((n = 1; n <= $1; n *= 2)); do echo "$n"; done
}
gpus() { nvidia-smi -L 2>/dev/null | grep -c ^GPU || true; }
cores=$(nproc)
if [[ $backend == cuda ]]; then devices=$(gpus); else devices=$cores; fi
read -ra counts <<<"${RANKS:-$(powers "$devices" | tr '\n' ' ')}"
read -ra cpu_counts <<<"${CPU_RANKS:-$(powers "$((cores < 16 ? cores : 16))" | tr '\n' ' ')}"

failed=()
# bed LOG CSV RANKS OPTION ...
bed() {
  local log=$1 csv=$2 ranks=$3
  shift 3
  echo "$ranks rank(s): bed $*" >>"$log"
  mpirun --oversubscribe "${mpirun_options[@]}" -n "$ranks" \
    "$build/tests/performance/bed" --wall --csv "$csv" "$@" "${samples[@]}" >>"$log" 2>&1 ||
    failed+=("$ranks rank(s): $*")
}
# Whether there is something to run on.
have_ranks() { ((${#counts[@]})) || { failed+=("no GPU here; RANKS says how many ranks all the same"); return 1; }; }
# spheres LOG CSV OPTION ...
spheres() {
  local log=$1 csv=$2 n
  shift 2
  have_ranks || return
  for n in "${counts[@]}"; do bed "$log" "$csv" "$n" --backend "$backend" "$@"; done
}

heading() {
  echo "commit: $("$build/scree" --version | sed -n '1s/.*commit \([^)]*\)).*/\1/p')"
  nvidia-smi --query-gpu=index,name,driver_version,clocks.sm,clocks.mem --format=csv,noheader 2>/dev/null |
    sed 's/^/GPU: /'
  echo "host: $(grep -m1 'model name' /proc/cpuinfo | cut -d: -f2- | sed 's/^ *//'), $cores processors," \
    "load $(cut -d' ' -f1 /proc/loadavg)"
}
weak() { spheres "$1" "$out/ranks.csv" --rebuild 0 --particles "${WEAK:-8000000}" --per-rank; }
strong() { spheres "$1" "$out/ranks.csv" --rebuild 0 --particles "${STRONG:-16000000}"; }
bodies() { spheres "$1" "$out/ranks.csv" --particles "${BODIES:-8000000}" --plough --steps "${BODY_STEPS:-15000}"; }
implicit() {
  spheres "$1" "$out/implicit_ranks.csv" --integrator hht --particles "${IMPLICIT:-1000000}" --per-rank
}
moving() {
  have_ranks || return
  "$python" "$here/moving.py" "$build/scree" --particles "${MOVING:-2000000}" --ranks "${counts[@]}" \
    --backend "$backend" --mpirun="${MPIRUN:-}" >>"$1" 2>&1 || failed+=("moving: $(tail -n 1 "$1")")
}
cpu() {
  local n
  for n in "${cpu_counts[@]}"; do
    bed "$1" "$out/cpu_ranks.csv" "$n" --dimension 2 --rebuild 0 --particles "${CPU_DISCS:-1000000}"
  done
}
chain() { "$build/tests/performance/chain_scaling" "$out/chain.csv" >>"$1" 2>&1 || failed+=(chain); }
tables() {
  local csv
  for csv in "$out/ranks.csv" "$out/implicit_ranks.csv" "$out/cpu_ranks.csv"; do
    [[ -e $csv ]] || continue
    "$python" "$here/rank_tables.py" "$csv" || failed+=("tables of $csv")
  done >"$out/tables.md"
}
model() {
  "$python" "$here/scaling_model.py" "$out/ranks.csv" --chain "$out/chain.csv" --out "$out" --backend "$backend" \
    "${model_options[@]}" >>"$1" 2>&1 || failed+=("model: $(tail -n 1 "$1")")
}

for part in "${parts[@]}"; do
  heading >"$out/$part.txt"
  "$part" "$out/$part.txt"
  echo "$part: $out/$part.txt"
done
if ((${#failed[@]})); then
  printf 'error: failed: %s\n' "${failed[@]}" >&2
  exit 1
fi
