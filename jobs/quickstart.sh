#!/usr/bin/env bash
# From a bare Debian 12 to the paper's net and particles as files and pictures: sets up, builds, runs
# input/paper/net_400.toml, draws. Run again, it does only what is out of date.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

deck=input/paper/net_400.toml
results=results/net_400
scree=build/release/scree

# Whether the file is there and none of the others is newer.
is_fresh() {
  local file=$1 source
  [[ -e "$file" ]] || return 1
  for source in "${@:2}"; do [[ "$source" -nt "$file" ]] && return 1; done
  return 0
}

# Whether the run with this program and this deck has been finished.
is_run_done() {
  is_fresh "$results/run_record.json" "$scree" "$deck" && grep -Eq '"status" *: *"done"' "$results/run_record.json"
}

# What a bare Debian 12 takes; jobs/setup.sh says what this one does.
if [[ ! -x "$scree" ]]; then
  cat <<END
A bare Debian 12 gets some 215 packages (1.4 GB) and Python packages in .venv (1 GB), those for pictures while the program is
built, for some six minutes on two cores. Another start does only what is out of date.
END
fi
jobs/setup.sh --quiet --program
# What draws is installed beside the compiler, which waits for no network.
pictures_log=$(mktemp)
trap 'wait; rm -f "$pictures_log"' EXIT
jobs/setup.sh --quiet --pictures >"$pictures_log" 2>&1 &
pictures=$!
jobs/build.sh release scree
pictures_status=0
wait "$pictures" || pictures_status=$?
cat "$pictures_log"
((pictures_status == 0)) || exit "$pictures_status"

if is_run_done; then
  echo "$results is up to date"
else
  "$scree" run "$deck" --output "$results" --overwrite
fi

animation() { find "$results" -maxdepth 1 -name 'animation.*' | head -n 1; }

# The animation is what is drawn last.
if ! is_fresh "$(animation)" "$results/run_record.json" postprocess/scree/*.py postprocess/scree/*/*.py; then
  echo "drawing the energies, the final state and an animation"
  postprocess/draw "$results"
fi

cat <<END

The net and 400 particles are in $results:
  picture     $results/final.png
  animation   $(animation)
  energies    $results/energies.png (history.h5 holds them, with counts and joint reactions)
  fields      $results/particles.vtkhdf and bodies.vtkhdf for ParaView 5.13 and newer,
              $results/particles.xdmf and bodies.xdmf for older ones
In ParaView open both files, press Apply, then choose the representation "Point Gaussian" or add the filter Glyph
(glyph type Sphere, radius 1, scale array radius, scale factor 1, glyph mode All Points).

Run a deck of your own:  $scree run DECK      every key of a deck:  $scree keys
END
