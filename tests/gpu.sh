#!/usr/bin/env bash
# Runs the tests of the CUDA backend; needs a GPU. The verification tests among them take minutes each: with a few discs a
# GPU waits for launches. `ctest --test-dir build/cuda -R gpu/unit` runs the others in a minute.
#
#     tests/gpu.sh [--sanitize]
#
# Builds the preset cuda and runs its tests with the label gpu. With BIN=FOLDER in the environment it builds nothing and
# runs the test programs in that folder, each as on_gpu test_...: for programs that were built elsewhere.
# --sanitize adds compute-sanitizer's memcheck, racecheck and initcheck on unit/cuda, unit/dem, the first
# steps of four decks, and those of a fifth on two ranks. Test cases with the tag [long], of 1e6 steps or of
# 1e5 spheres, are left out, for they take very long there. FILTER in the environment is passed to the
# test programs as Catch2's choice of tests instead: FILTER='explicit*', or FILTER='*' for all.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

sanitize=false
case "$*" in
  "") ;;
  --sanitize) sanitize=true ;;
  *)
    echo "usage: [BIN=FOLDER] [FILTER=TESTS] tests/gpu.sh [--sanitize]" >&2
    exit 2
    ;;
esac
bin=${BIN:-build/cuda}
if [[ -z "${BIN:-}" ]]; then jobs/build.sh cuda; fi

fail() {
  echo "tests/gpu.sh: $*" >&2
  exit 2
}

# Path of a program, wherever it stands in the folder.
program() {
  local path
  path=$(find -L "$bin" -type f -perm -u+x -name "$1" -print -quit)
  [[ -n "$path" ]] || fail "no program $1 in $bin"
  echo "$path"
}

failed=()
# Runs a command; says how long it took, and shows its output where it failed.
run() {
  local name=$1 start=$SECONDS
  shift
  if "$@" >"$scratch/output" 2>&1; then
    echo "passed  $name, $((SECONDS - start)) s"
  else
    echo "FAILED  $name, $((SECONDS - start)) s, exit code $?; the end of its output:"
    tail -n 40 "$scratch/output"
    failed+=("$name")
  fi
}

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
on_gpu=$(program on_gpu)
"$on_gpu" /usr/bin/env true || fail "the tests need a GPU"

if [[ -z "${BIN:-}" ]]; then
  run "ctest -L gpu" ctest --test-dir "$bin" --label-regex gpu --output-on-failure --no-tests=error
else
  mapfile -t tests < <(find -L "$bin" -type f -perm -u+x -name 'test_*' | sort)
  ((${#tests[@]} > 0)) || fail "no program test_* in $bin"
  for test in "${tests[@]}"; do run "${test##*/}" "$on_gpu" "$test"; done
fi

if "$sanitize"; then
  command -v compute-sanitizer >/dev/null || fail "--sanitize needs compute-sanitizer of the CUDA toolkit on the PATH"
  scree=$(program scree)
  # Open MPI asks for these where the user is root, as in many containers.
  export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
  export SCREE_TEST_BACKEND=cuda # what on_gpu sets; the sanitizer follows the program that it starts, and no other
  for tool in memcheck racecheck initcheck; do
    sanitizer=(compute-sanitizer --tool "$tool" --error-exitcode 1)
    for name in unit_cuda unit_dem; do
      run "$tool test_$name" "${sanitizer[@]}" "$(program "test_$name")" "${FILTER:-~[long]}"
    done
    # Explicit in double and in mixed precision, implicit, explicit with bodies.
    decks=("examples/gas_periodic time.end=2e-3" "examples/gas_periodic time.end=2e-3 integrator.precision=mixed"
      "examples/heap_900 time.end=0.03"
      "paper/net_9 time.end=0.02 integrator.particles=velocity-verlet integrator.substeps=3")
    for deck in "${decks[@]}"; do
      read -ra words <<<"$deck"
      settings=()
      for setting in "${words[@]:1}"; do settings+=(--set "$setting"); done
      run "$tool scree $deck" "${sanitizer[@]}" "$scree" run "input/${words[0]}.toml" --backend cuda \
        "${settings[@]}" --output "$scratch/results" --overwrite
    done
    # Through host memory: what NCCL's own kernels do is not looked at.
    for method in hht velocity-verlet; do
      run "$tool scree dam_break, $method, 2 ranks" mpirun --oversubscribe -n 2 "${sanitizer[@]}" "$scree" run \
        tests/ranks/dam_break.toml --backend cuda --set parallel.transport=staged --set time.end=2e-3 \
        --set "integrator.particles=$method" --output "$scratch/results" --overwrite
    done
  done
fi

if ((${#failed[@]} > 0)); then
  echo "tests/gpu.sh: tests FAILED: $(printf '%s; ' "${failed[@]}")"
  exit 1
fi
echo "tests/gpu.sh: all tests passed on the GPU"
