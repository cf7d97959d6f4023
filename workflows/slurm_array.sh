#!/usr/bin/env bash
# The members of a recipe's family by a Slurm array, without Snakemake:
#
#   workflows/slurm_array.sh family.json 10000 set [further options of synth]
#   workflows/merge_manifests.py 10000 set/manifests -o set/manifest.jsonl
#
# submits an array that makes members 0 to 9999. A task has about MEMBERS_PER_TASK of them (500), more where the cluster's
# MaxArraySize asks for it. Options of sbatch are taken from the environment, such as SBATCH_PARTITION and SBATCH_ACCOUNT;
# sbatch --array=0-19 workflows/slurm_array.sh family.json 10000 set makes the same members in 20 tasks. A task that is
# started again goes on where it ended.
#SBATCH --job-name=astrolith
#SBATCH --cpus-per-task=1
set -euo pipefail

recipe=${1:?slurm_array.sh: give the recipe} members=${2:?slurm_array.sh: give how many members} folder=${3:?slurm_array.sh: give the folder}
[[ $members =~ ^[1-9][0-9]*$ ]] || { echo "slurm_array.sh: $members is no number of members; give recipe, members, folder" >&2; exit 2; }

if [[ -z ${SLURM_ARRAY_TASK_ID:-} ]]; then
  most=$(scontrol show config | sed -nE 's/^MaxArraySize *= *([0-9]+).*/\1/p')
  size=${MEMBERS_PER_TASK:-500}
  tasks=$(((members + size - 1) / size))
  ((tasks <= ${most:-1001})) || tasks=${most:-1001}
  exec sbatch --array="0-$((tasks - 1))" "$0" "$@"
fi

# The tasks share the members evenly, whatever numbers the array has.
tasks=$SLURM_ARRAY_TASK_COUNT step=${SLURM_ARRAY_TASK_STEP:-1}
((SLURM_ARRAY_TASK_MAX - SLURM_ARRAY_TASK_MIN == step * (tasks - 1))) ||
  { echo "slurm_array.sh: the numbers of the array have gaps; give --array=A-B, or A-B:STEP" >&2; exit 2; }
task=$(((SLURM_ARRAY_TASK_ID - SLURM_ARRAY_TASK_MIN) / step))
first=$((members * task / tasks)) last=$((members * (task + 1) / tasks))
((first < last)) || exit 0
exec synth "$recipe" --members "$first:$last" --threads "${SLURM_CPUS_PER_TASK:-1}" --quiet \
  -o "$folder/bodies/{member}.ply" --manifest "$folder/manifests/$first.jsonl" "${@:4}"
