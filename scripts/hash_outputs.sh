#!/usr/bin/env bash
# hash_outputs.sh [BUILD_FOLDER] [THREADS ...]: prints the SHA-256 of what the programs make: every example at two sizes
# with one thread and two, a tile, a patch, a texture, a variation, a picture, labels, and fits of a shape and a photo.
#   scripts/hash_outputs.sh build/release > before.txt     # change the code, build, and then
#   scripts/hash_outputs.sh build/release | diff before.txt -
# Changes of structure keep every line. Bytes of fits depend on the machine's BLAS, so compare on one machine.
# The program's version is left out of recipes and meshes, since it changes with every commit.
set -euo pipefail
cd "$(dirname "$0")/.."

bin=$(realpath "${1:-build/release}")/bin
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
examples=synthesis/examples
shape=data-cache/castalia.bmf
photo=data-cache/gravel.png
for file in "$shape" "$photo"; do
  [[ -s $file ]] || { echo "hash_outputs.sh: $file is missing; run scripts/fetch_data.sh" >&2; exit 1; }
done

# report NAME FILE ...: prints one line for each file.
report() {
  local name=$1 file
  shift
  for file in "$@"; do
    case $file in
      *.json) sed -E 's/"tool": *"[^"]*"//' "$file" ;;
      *.stl) tail -c +81 "$file" ;;  # its first 80 bytes are a comment
      *.ply | *.obj) LC_ALL=C sed -E '/^(comment|#) made by /d' "$file" ;;
      *) cat "$file" ;;
    esac | sha256sum | awk -v name="$name $(basename "$file")" '{print $1, name}'
  done
}

synth() { "$bin/synth" "$@" --quiet; }

for recipe in "$examples"/*.json; do
  name=$(basename "$recipe" .json)
  for cells in 24 56; do
    for threads in 1 2; do
      synth "$recipe" -o "$work/mesh.ply" --resolution "$cells" --threads "$threads" --device cpu
      report "$name $cells $threads" "$work/mesh.ply"
    done
  done
done

for threads in 1 2; do
  use=(--threads "$threads" --device cpu)
  synth "$examples/itokawa_details.json" -o "$work/tile.ply" --resolution 96 --tile 2/3 "${use[@]}"
  synth "$examples/fractal_hills.json" -o "$work/patch.ply" --patch -216.71 -72.92 -89.43 20 --resolution 96 "${use[@]}"
  synth "$examples/eros_gravel.json" -o "$work/patch_gabor.ply" --patch 13576 -2563 -2418 400 --resolution 96 "${use[@]}"
  synth "$examples/craters_power_law.json" -o "$work/labels.ply" --resolution 48 --labels "${use[@]}" \
    --feature-list "$work/landforms.csv"
  synth "$examples/boulders.json" -o "$work/picture.obj" --resolution 48 --preview "$work/picture.png" "${use[@]}"
  synth "$examples/talus_slopes.json" -o "$work/eroded.stl" --resolution 64 "${use[@]}"
  synth "$examples/fractal_hills.json" -o "$work/varied.ply" --vary 0.2 --seed 3 --resolution 48 "${use[@]}"
  report "synth $threads" "$work"/{tile,patch,patch_gabor,labels,varied}.ply "$work"/landforms.csv \
    "$work"/picture.{obj,png} "$work/eroded.stl"

  "$bin/fit_gabor" "$photo" -o "$work/gravel.json" --quiet --mm-per-px 1 --threads "$threads"
  synth "$work/gravel.json" --texture 256x192 -o "$work/gravel.tif" --threads "$threads"
  synth "$work/gravel.json" --texture 128x128 --tileable -o "$work/gravel.png" --threads "$threads"
  "$bin/fit_shape" "$shape" -o "$work/castalia.json" --spheres 60 --optimizer pso --population 8 --generations 6 \
    --points 2000 --quiet --threads "$threads"
  synth "$work/gravel.json" --base "$work/castalia.json" -o "$work/laid.ply" --resolution 48 "${use[@]}"
  "$bin/describe" "$shape" -o "$work/castalia.npy" --points 2000 --quiet "${use[@]}"
  "$bin/compare" "$shape" "$work/laid.ply" --points 2000 --threads "$threads" | grep -v "$work" >"$work/compared.txt"
  report "fit $threads" "$work"/{gravel,castalia}.json "$work"/gravel.{tif,png} "$work"/laid.ply \
    "$work/castalia.npy" "$work/compared.txt"
done
