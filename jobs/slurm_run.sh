#!/usr/bin/env bash
# What the sbatch files of this folder share: one run as the work of a SLURM job, begun, continued, or found done.
#
#     jobs/slurm_run.sh DECK RESULTS [SCREE OPTIONS]
#
# The newest checkpoint in RESULTS is continued; without one the run begins. A run that is done is left as it is, unless
# the deck has been edited since, or the words DECK [SCREE OPTIONS] are not those that it was done with, which
# RESULTS/slurm_run.txt holds: Scree then goes on to a later time.end, or refuses another deck. The options --output and
# --restart are this script's own.
# A run that begins is refused by Scree where RESULTS holds results without a checkpoint, unless an earlier start of the
# same job left them, or --overwrite is among the options. RESULTS/scree.lock, which keeps a second run out, is taken away
# where SLURM knows that the job in it has ended: a node that failed may have left it on a file system of several.
# On SIGUSR1, which the sbatch files ask SLURM for before the time limit, the run writes RESULTS/checkpoint.h5 and ends
# with exit code 5; the job then goes back into the queue, at most SCREE_REQUEUES times. On SIGTERM (scancel, preemption)
# the run does the same, but the job stays out of the queue unless SLURM puts it back.
# Otherwise the job ends with the exit code of the run, which jobs/using.md lists.
#
# From the environment of sbatch:
#     SCREE            the program; default: build/release/scree of this source tree, or the one installed with this file
#     SCREE_LAUNCHER   what starts the ranks; default: srun --mpi=pmix --wait=60. With mpirun: SCREE_LAUNCHER=mpirun
#     SCREE_REQUEUES   how often a job that met its time limit may have been started again; default: 0
set -euo pipefail

readonly stopped_by_signal=5 bad_usage=2

say() { echo "job ${SLURM_JOB_ID:-}: $*"; }

refuse() {
  echo "job ${SLURM_JOB_ID:-}: $*" >&2
  exit "$bad_usage"
}

(($# >= 2)) || refuse "usage: jobs/slurm_run.sh DECK RESULTS [SCREE OPTIONS]"
deck=$1 results=$2
options=("${@:3}")
tree=$(readlink -f "${BASH_SOURCE[0]}")
tree=${tree%/jobs/*}
if [[ -e "$tree/CMakeLists.txt" ]]; then scree=$tree/build/release/scree; else scree=${tree%/*/*}/bin/scree; fi
scree=${SCREE:-$scree}
requeues=${SCREE_REQUEUES:-0}
restarts=${SLURM_RESTART_COUNT:-0}
# --wait: ranks that outlive another one by so many seconds are ended, where the MPI library has not ended them.
read -r -a launcher <<<"${SCREE_LAUNCHER:-srun --mpi=pmix --wait=60}"

for option in "${options[@]}"; do
  case "$option" in
    --) break ;; # the rest is PETSc's
    --output | --output=*) refuse "$option: the results go to RESULTS, the second word, here $results" ;;
    --restart | --restart=*)
      refuse "$option: the newest checkpoint in RESULTS is continued; to begin from another one," \
        "copy it to $results/checkpoint.h5"
      ;;
  esac
done
[[ -x "$scree" ]] || refuse "no program $scree, seen from $PWD; jobs/build.sh release builds it, or SCREE names another"
[[ -e "$deck" ]] || refuse "no deck $deck in $PWD"
[[ "$requeues" =~ ^[0-9]+$ ]] || refuse "SCREE_REQUEUES = \"$requeues\"; allowed: whole numbers from 0"
command -v "${launcher[0]}" >/dev/null || refuse "SCREE_LAUNCHER: no program ${launcher[0]} on this node"

record=$results/run_record.json done_with=$results/slurm_run.txt
words=$(printf '%q ' "$deck" "${options[@]}")
if [[ -e "$record" ]] && grep -Eq '"status" *: *"done"' "$record"; then
  if [[ ! -e "$done_with" || "$(<"$done_with")" != "$words" ]]; then
    say "the run in $results is done, but not known to be with these words: $words"
  elif [[ "$record" -nt "$deck" ]]; then
    say "the run in $results is done already; it goes on when time.end in $deck is raised"
    exit 0
  fi
fi

checkpoint=
for file in "$results"/checkpoint.h5 "$results"/checkpoint_end.h5; do
  if [[ "$file" -nt "$checkpoint" ]]; then checkpoint=$file; fi
done
if [[ -n "$checkpoint" ]]; then
  options=(--restart "$checkpoint" "${options[@]}")
  say "start $((restarts + 1)) on ${SLURM_JOB_NODELIST:-this node}: continues from $checkpoint"
else
  say "start $((restarts + 1)) on ${SLURM_JOB_NODELIST:-this node}: begins"
  # Its own results: it was killed before it wrote a checkpoint.
  if ((restarts > 0)); then options=(--overwrite "${options[@]}"); fi
fi

# Whether SLURM has this job no longer, or has it waiting to be started again.
has_ended() {
  local state
  state=$(squeue --noheader --jobs="$1" --format=%T 2>&1) || [[ "$state" == *"Invalid job id"* ]] || return 1
  [[ -z "$state" || "$state" == PENDING || "$state" == *"Invalid job id"* ]]
}

lock=$results/scree.lock
if [[ -e "$lock" ]] && command -v squeue >/dev/null; then
  owner=$(sed -n 's/^job //p' "$lock")
  if [[ -n "$owner" && "$owner" != "${SLURM_JOB_ID:-}" ]] && has_ended "$owner"; then
    say "the run of job $owner in $results has ended without removing its lock"
    rm -f "$lock"
  fi
fi

# SLURM 22.05 and newer do not pass this on from sbatch to srun by themselves.
export SRUN_CPUS_PER_TASK=${SLURM_CPUS_PER_TASK:-1}
# A rank computes on one core: libraries must not start threads on those of other ranks.
export OMP_NUM_THREADS=${OMP_NUM_THREADS:-1}
# mpirun may load OpenCL to look for devices, and some OpenCL libraries take SIGUSR1 for themselves.
export HWLOC_COMPONENTS=${HWLOC_COMPONENTS--opencl}

run='' warned=false ended=false
# shellcheck disable=SC2317 # the traps call it
ask_for_checkpoint() {
  say "$1: asking the run for a checkpoint"
  if [[ -n "$run" ]]; then kill -USR1 "$run" 2>/dev/null || true; fi # srun and mpirun pass it on to the ranks
}
trap 'warned=true; ask_for_checkpoint "the time limit is near"' USR1
trap 'ended=true; ask_for_checkpoint "the job is being ended"' TERM

"${launcher[@]}" "$scree" run "$deck" --output "$results" "${options[@]}" &
run=$!
wait "$run" || true
while kill -0 "$run" 2>/dev/null; do wait "$run" || true; done # a signal ends a wait, not the run
status=0
wait "$run" || status=$? # status of the run, which bash still has
if "$warned" && ((status == 128 + $(kill -l USR1))); then
  say "the signal came before the run could hear it; there is no new checkpoint"
  status=$stopped_by_signal
fi

if ((status == 0)); then printf '%s\n' "$words" >"$done_with" || true; fi # without it Scree looks again

# SLURM ends the job's processes as soon as it has it back: scontrol has to outlive that to tell of it.
put_back() { (trap '' TERM && exec scontrol requeue "$SLURM_JOB_ID"); }

if ((status != stopped_by_signal)) || "$ended"; then
  say "ends with exit code $status"
elif ! "$warned"; then
  say "stopped by a signal to the ranks; submitted again, the run continues"
elif ((restarts >= requeues)); then
  say "stopped by the time limit after $restarts of at most $requeues requeues; submitted again, the run continues"
elif put_back; then
  say "stopped by the time limit and back in the queue: requeue $((restarts + 1)) of at most $requeues"
else
  say "stopped by the time limit, and SLURM did not take the job back; submitted again, the run continues"
fi
exit "$status"
