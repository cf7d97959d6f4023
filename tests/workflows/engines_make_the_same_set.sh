#!/usr/bin/env bash
# Makes the same 200 members in six ways and compares the digests of their manifests: one run with one thread and with
# two, two ranges in the other order, Snakemake, a Slurm array, and Snakemake on Slurm. Needs root, and Debian's
# snakemake, slurm-wlm and munge.
#   engines_make_the_same_set.sh FOLDER_OF_PROGRAMS
set -euo pipefail

export PATH=$(realpath "${1:?engines_make_the_same_set.sh: give the folder of the programs}"):$PATH
here=$(realpath "$(dirname "$0")") workflows=$(realpath "$(dirname "$0")/../../workflows")
export workflows work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

cat >family.json <<'EOF'
{"format_version": 1, "length_unit": "m",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 100], [80, 0, 0, 60]]},
  "layers": [{"type": "simplex", "amplitude": 1, "frequency": 0.01, "octaves": 2},
             {"type": "craters", "population": {"count": 40, "least_diameter": 4, "greatest_diameter": 50}}],
  "family": {"fields": [{"field": "layers[0].amplitude", "distribution": "log_uniform", "low": 1, "high": 10},
                        {"field": "body.spheres[1].x", "low": 0, "high": 120}]}}
EOF
members() {  # FOLDER RANGE [OPTION ...]
  synth family.json --members "$2" --resolution 64 --quiet -o "$1/bodies/{member}.ply" \
    --manifest "$1/manifests/${2%:*}.jsonl" "${@:3}"
}
by_snakemake() {  # FOLDER PROFILE
  snakemake -s "$workflows/Snakefile" --profile "$workflows/profiles/$2" \
    --config recipe=family.json members=200 folder="$1" options="--resolution 64" members_per_job=40 >"$1.log" 2>&1
}
by_slurm() {
  sbatch --wait --array=0-3 --output=/dev/null "$workflows/slurm_array.sh" family.json 50 array --resolution 64
  by_snakemake cluster slurm
}
export -f by_snakemake by_slurm

members one_thread 0:200 --threads 1
members two_threads 0:200 --threads 2
members other_order 120:200
members other_order 0:120
by_snakemake cores local
"$here/slurm_one_node.sh" bash -euo pipefail -c by_slurm

for way in one_thread two_threads other_order cores array cluster; do
  printf '%-12s %s\n' "$way" "$("$workflows/merge_manifests.py" 200 "$way/manifests")"
done | tee digests
[[ $(awk '{ print $NF }' digests | sort -u | wc -l) == 1 ]]
