#!/usr/bin/env bash
# Installs what Scree needs and this machine does not have: Debian packages, and Python packages into .venv.
#
#     jobs/setup.sh [--quiet] [--paraview] [--slurm] [--cuda] [--ccache]
#     jobs/setup.sh [--quiet] --program | --pictures | --package
#
# --program installs what the program needs and no more: nothing for tests or pictures, and no .venv. --pictures installs what
# postprocess/draw needs and no more. --package installs what the program and packages of it need
# (jobs/packaging/README.md) and no more.
# --quiet leaves out what apt-get prints, unless it fails; how much is installed is said in one line.
# --paraview adds Debian's ParaView, for the tests that open results in it.
# --slurm adds SLURM, for the test that starts one on this machine and submits the sbatch files to it. Its services are
# not configured and do not run by themselves.
# --ccache adds ccache; with CMAKE_CXX_COMPILER_LAUNCHER=ccache in the environment builds keep what they have compiled.
# --cuda adds nvcc of CUDA 13.0 from PyPI, in .venv, for machines without a CUDA toolkit. The driver is not among it.
# With nothing to install it changes nothing; what it must not install it names.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

program_packages=(
  g++ cmake ninja-build pkg-config git ca-certificates
  libopenmpi-dev openmpi-bin libhdf5-openmpi-dev libpetsc-real-dev libeigen3-dev
  libtomlplusplus-dev libcli11-dev libfmt-dev
)
test_packages=(
  catch2
  clang-format                    # of the test of style: version 14, as Debian 12 has it
)
package_packages=(
  dpkg-dev file                   # of cpack: which packages hold the libraries
  python3                         # makes the manual page
)
picture_packages=( # animations and reader tests, too
  python3 python3-venv ffmpeg
  libegl1 libgl1 libxrender1      # what PyPI's vtk draws with, off screen
)
paraview_packages=(paraview python3-paraview xvfb xauth python3-h5py)
slurm_packages=(slurmctld slurmd slurm-client munge)
requirements=postprocess/requirements.txt
cuda_packages=("cuda-toolkit[nvcc,cudart,cccl]==13.0.2" "nvidia-nvvm==13.0.*" "nvidia-cuda-crt==13.0.*")

fail() {
  echo "set-up: $*" >&2
  exit 1
}

is_installed() { [[ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" == installed ]]; }

install_packages() {
  local package missing=() as_root=()
  for package in "$@"; do is_installed "$package" || missing+=("$package"); done
  ((${#missing[@]} > 0)) || return 0
  if ((EUID != 0)); then
    command -v sudo >/dev/null || fail "not root and no sudo here; as root: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  echo "set-up: installing Debian packages: ${missing[*]}"
  run_apt "${as_root[@]}" apt-get -q update || fail "apt-get update failed; needed: ${missing[*]}"
  say_how_much "${missing[@]}"
  run_apt "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q install -y --no-install-recommends \
    "${missing[@]}" || fail "apt-get could not install: ${missing[*]}"
}

# With what these packages need: their number, and what they take.
say_how_much() {
  local plan number download disk
  plan=$(LC_ALL=C apt-get -q --assume-no install --no-install-recommends "$@" 2>/dev/null) || true
  number=$(sed -nE 's/.* ([0-9]+) newly installed.*/\1/p' <<<"$plan")
  download=$(sed -nE 's/^Need to get (.*) of archives.*/\1/p' <<<"$plan")
  disk=$(sed -nE 's/^After this operation, (.*) of additional disk space.*/\1/p' <<<"$plan")
  [[ -n "$number" && -n "$disk" ]] || return 0
  echo "set-up: with what they need $number packages: ${download:-nothing} to download, $disk of disk"
}

# apt-get as it is told; quiet, what it printed is shown where it fails.
run_apt() {
  if ! "$quiet"; then
    "$@"
    return
  fi
  local log status=0
  log=$(mktemp)
  "$@" >"$log" 2>&1 || status=$?
  ((status == 0)) || cat "$log" >&2
  rm -f "$log"
  return "$status"
}

install_python_packages() {
  cmp -s "$requirements" .venv/installed.txt && return 0
  echo "set-up: installing Python packages into .venv: $(tr '\n' ' ' <"$requirements")"
  /usr/bin/python3 -m venv .venv || fail "/usr/bin/python3 -m venv .venv failed"
  .venv/bin/python -m pip install --quiet --disable-pip-version-check -r "$requirements" ||
    fail "pip could not install $requirements"
  cp "$requirements" .venv/installed.txt
}

install_nvcc() {
  local folder
  [[ "$(cat .venv/installed_cuda.txt 2>/dev/null)" == "${cuda_packages[*]}" ]] && return 0
  echo "set-up: installing nvcc into .venv: ${cuda_packages[*]}"
  .venv/bin/python -m pip install --quiet --disable-pip-version-check "${cuda_packages[@]}" ||
    fail "pip could not install ${cuda_packages[*]}"
  folder=$(echo .venv/lib/python3*/site-packages/nvidia/cu13)
  ln -sfn lib "$folder/lib64" # nvcc names this folder to the linker
  echo "${cuda_packages[*]}" >.venv/installed_cuda.txt
}

packages=("${program_packages[@]}" "${test_packages[@]}" "${picture_packages[@]}")
with_cuda=false with_python=true quiet=false
for argument in "$@"; do
  case "$argument" in
    --quiet) quiet=true ;;
    --paraview) packages+=("${paraview_packages[@]}") ;;
    --slurm) packages+=("${slurm_packages[@]}") ;;
    --cuda) with_cuda=true ;;
    --ccache) packages+=(ccache) ;;
    --program) packages=("${program_packages[@]}") with_python=false ;;
    --pictures) packages=("${picture_packages[@]}") ;;
    --package) packages=("${program_packages[@]}" "${package_packages[@]}") with_python=false ;;
    *) fail "unknown argument: $argument; allowed:" \
      --quiet, --paraview, --slurm, --cuda, --ccache, --program, --pictures, --package ;;
  esac
done
if command -v dpkg-query >/dev/null && command -v apt-get >/dev/null; then
  install_packages "${packages[@]}"
else
  echo "set-up: this is not Debian; Scree needs what these Debian packages hold: ${packages[*]}"
fi
if "$with_python"; then install_python_packages; fi
if "$with_cuda"; then install_nvcc; fi
