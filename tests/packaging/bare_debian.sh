#!/usr/bin/env bash
# Scree on a Debian 12 that has nothing but git: the last commit of this tree, in a folder that debootstrap fills. By hand,
# as root; needs debootstrap and a mirror, and takes the time of a build.
#
#     tests/packaging/bare_debian.sh quickstart FOLDER     # jobs/quickstart.sh
#     tests/packaging/bare_debian.sh packages FOLDER       # the steps of jobs/packaging/scree.def, in two systems; a run on
#                                                          # two ranks, the archive moved, the Python package, lintian
#     tests/packaging/bare_debian.sh conda FOLDER          # build.sh of the recipe, with Debian's libraries
#
# FOLDER must not exist, and is left for a look: several GB. DEBOOTSTRAP in the environment may hold the program with further
# options; with CCACHE_DIR there, that cache is used.
# shellcheck disable=SC2016 # what is quoted expands inside
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

fail() {
  echo "bare_debian.sh: $*" >&2
  exit 2
}

# Runs a command in a system, with processes and mounts that end with it.
inside() {
  local environment=(HOME=/root LC_ALL=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin)
  if [[ -n "${CCACHE_DIR:-}" ]]; then environment+=(CCACHE_DIR=/ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
  unshare --mount --pid --fork --kill-child bash -euc '
    mount -t proc proc "$0/proc"
    mount -t sysfs sysfs "$0/sys"
    mount --rbind /dev "$0/dev"
    if [[ -n "${CCACHE_DIR:-}" ]]; then mount --bind "$CCACHE_DIR" "$0/ccache"; fi
    exec chroot "$0" env -i "$@"' "$1" "${environment[@]}" "${@:2}"
}

# A bare system, with what this machine needs to reach others.
make_system() {
  local packages=git,ca-certificates
  if [[ -n "${CCACHE_DIR:-}" ]]; then packages+=,ccache; fi
  mkdir -p "$1/ccache"
  "${debootstrap[@]}" --variant=minbase --include="$packages" bookworm "$1" >/dev/null
  cp /etc/resolv.conf "$1/etc/"
  if [[ -e /etc/pip.conf ]]; then cp /etc/pip.conf "$1/etc/"; fi
  if compgen -G "/usr/local/share/ca-certificates/*" >/dev/null; then
    cp /usr/local/share/ca-certificates/* "$1/usr/local/share/ca-certificates/"
    inside "$1" update-ca-certificates >/dev/null
  fi
}

copy_tree() { git clone --quiet --no-local . "$1"; }

# The commands of the section NAME that is the Nth of its name in scree.def.
section() {
  awk -v name="%$1" -v nth="$2" '/^%/ { found = $1 == name && ++count == nth } /^ / && found' jobs/packaging/scree.def
}

try_quickstart() {
  make_system "$folder"
  copy_tree "$folder/srv/scree"
  SECONDS=0
  inside "$folder" /srv/scree/jobs/quickstart.sh
  echo "bare_debian.sh: quickstart.sh took $SECONDS s"
  ls -l "$folder/srv/scree/results/net_400"
}

try_packages() {
  local build=$folder/build final=$folder/final
  mkdir "$folder"
  make_system "$build"
  cp -a "$build" "$final"
  copy_tree "$build/scree"
  inside "$build" bash -c "$(section post 1)"
  cp -r "$build/scree/build/package/packages" "$final/packages"
  cp -r "$final/packages" "$final/kept" # the next section takes them away
  inside "$final" bash -c "$(section post 2)"
  inside "$final" bash -euc "$(section test 1)"
  inside "$final" bash -euxc '
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
    mpirun --oversubscribe -n 2 scree run /usr/share/scree/input/paper/net_9.toml --set time.end=0.1 --output /srv/net_9
    mkdir -p "/opt/some place" && tar xzf /kept/*.tar.gz -C "/opt/some place" --strip-components=1
    SCREE_LAUNCHER=env "/opt/some place/share/scree/jobs/one_node.sbatch" \
      /usr/share/scree/input/examples/pendulum.toml /srv/pendulum
    apt-get -q update && apt-get -q install -y --no-install-recommends lintian man-db python3-venv >/dev/null
    man scree | head -n 8
    python3 -m venv /srv/env && /srv/env/bin/pip install --quiet /usr/share/scree/postprocess
    /srv/env/bin/scree-post compare /srv/net_9 /srv/net_9
    lintian --allow-root /kept/*.deb || true
    apt-get -q remove -y scree >/dev/null && [[ ! -e /usr/share/scree && ! -e /usr/bin/scree ]]'
  echo "bare_debian.sh: packages are made, installed, run and removed"
}

try_conda() {
  make_system "$folder"
  copy_tree "$folder/scree"
  inside "$folder" bash -euxc '
    cd /scree && jobs/setup.sh --package >/dev/null
    PREFIX=/opt/first CPU_COUNT=$(nproc) jobs/packaging/conda/build.sh
    mv /opt/first /opt/moved && /opt/moved/bin/scree check /opt/moved/share/scree/input/examples/pendulum.toml'
  echo "bare_debian.sh: build.sh of the recipe built, and what it installed runs"
}

(($# == 2)) || fail "usage: tests/packaging/bare_debian.sh quickstart|packages|conda FOLDER"
action=$1 folder=$2
[[ "$action" =~ ^(quickstart|packages|conda)$ ]] || fail "unknown: $action; allowed: quickstart, packages, conda"
((EUID == 0)) || fail "only root may change into another system"
[[ ! -e "$folder" ]] || fail "$folder exists"
read -r -a debootstrap <<<"${DEBOOTSTRAP:-debootstrap}"
command -v "${debootstrap[0]}" >/dev/null || fail "no program ${debootstrap[0]}; on Debian: apt-get install debootstrap"
"try_$action"
