#!/usr/bin/env bash
# One range of members for each task of a Slurm array, without Snakemake:
#
#   sbatch --array=0-19 workflows/slurm_array.sh family.json 500 set [further options of synth]
#   workflows/merge_manifests.py 10000 set/manifests -o set/manifest.jsonl
#
# makes 20 ranges of 500 members. A task that is started again goes on where it ended.
#SBATCH --job-name=astrolith
#SBATCH --cpus-per-task=1
set -euo pipefail

recipe=${1:?slurm_array.sh: give the recipe} size=${2:?slurm_array.sh: give the members of a task} folder=${3:?slurm_array.sh: give the folder}
first=$((SLURM_ARRAY_TASK_ID * size))
exec synth "$recipe" --members "$first:$((first + size))" --threads "${SLURM_CPUS_PER_TASK:-1}" --quiet \
  -o "$folder/bodies/{member}.ply" --manifest "$folder/manifests/$first.jsonl" "${@:4}"
