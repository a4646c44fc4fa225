#!/usr/bin/env bash
# Says where a rank of a job sits: node, cores, and the GPU that Scree takes for it. Started as Scree would be:
#
#     srun SAME OPTIONS AS SBATCH jobs/mapping.sh         or, in an allocation (salloc), mpirun jobs/mapping.sh
set -euo pipefail

rank=${OMPI_COMM_WORLD_RANK:-${SLURM_PROCID:-0}} # mpirun's own first: its ranks also have SLURM's, of the batch script
ranks=${OMPI_COMM_WORLD_SIZE:-${SLURM_NTASKS:-1}}
local_rank=${OMPI_COMM_WORLD_LOCAL_RANK:-${SLURM_LOCALID:-0}}
cores=$(sed -n 's/^Cpus_allowed_list:[[:blank:]]*//p' /proc/self/status)

if [[ -n "${CUDA_VISIBLE_DEVICES+set}" ]]; then
  IFS=, read -r -a gpus <<<"$CUDA_VISIBLE_DEVICES"
elif command -v nvidia-smi >/dev/null; then
  mapfile -t gpus < <(nvidia-smi --query-gpu=index --format=csv,noheader 2>/dev/null)
else
  gpus=()
fi
taken="no GPU"
if ((${#gpus[@]} > 0)); then taken="GPU ${gpus[local_rank % ${#gpus[@]}]} of ${gpus[*]}"; fi

echo "rank $rank of $ranks: node ${SLURMD_NODENAME:-$(hostname)}, local rank $local_rank, cores $cores, $taken"
