#!/usr/bin/env bash
# The arrows between folders: a file may include only from its own folder and those its row names.
set -euo pipefail
cd "$(dirname "$0")/.."

allowed=(
  "numerics:"
  "recipe:numerics"
  "geometry:numerics"
  "descriptor:numerics|geometry"
  "synthesis:numerics|recipe|geometry"
  "cuda:numerics|recipe|geometry|descriptor|synthesis"
  "estimation:numerics|recipe|geometry|descriptor|synthesis|cuda"
)
folders='numerics|recipe|geometry|descriptor|synthesis|cuda|estimation|apps|tests'
status=0
for row in "${allowed[@]}"; do
  folder=${row%%:*}
  wrong=$(git grep -nE "#include \"($folders)/" -- "$folder/*.h" "$folder/*.cpp" "$folder/*.cu" |
    grep -vE "#include \"(${row##*:}|$folder)/" || true)
  if [[ -n $wrong ]]; then
    echo "Includes against the arrows in $folder/:"
    echo "$wrong"
    status=1
  fi
done
exit $status
