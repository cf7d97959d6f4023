#!/usr/bin/env bash
# The main job on real input: a photo of gravel becomes a Gabor layer, a real asteroid becomes a recipe, and the two
# become a watertight mesh with pictures. Installs what is missing, builds, runs, says where the results lie.
#   scripts/demo.sh [MESH]      MESH: any closed shape model in place of the demo's own
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
scripts/fetch_data.sh
scripts/build.sh release fit_gabor fit_shape synth

photo=data-cache/gravel.png
# The finest model at hand: a measured Itokawa where the data folder stands beside the checkout, else Debian's Gaspra.
shape=${1:-../shared/data/shapes/itokawa_gaskell_49k.ply}
[[ -e $shape ]] || shape=data-cache/gaspra.bmf
out=demo-output
bin=build/release/bin
mkdir -p "$out"

echo
echo "1/3  A photo becomes a Gabor layer (fit_gabor $photo)"
"$bin/fit_gabor" "$photo" -o "$out/gravel.json" --mm-per-px 200 --height-rms 0.0006 --unit km \
  --report "$out/gravel_report" --summary "$out/gravel_summary.json"

echo "2/3  A shape model becomes a recipe (fit_shape $shape)"
"$bin/fit_shape" "$shape" -o "$out/body.json" --spheres 200 \
  --report "$out/body_report" --summary "$out/body_summary.json"

echo "3/3  Recipes become meshes (synth)"
"$bin/synth" "$out/body.json" -o "$out/body.ply" --resolution 256 \
  --preview "$out/body.png" --summary "$out/body_mesh_summary.json"
"$bin/synth" "$out/gravel.json" --base "$out/body.json" -o "$out/asteroid.ply" --resolution 384 \
  --preview "$out/asteroid.png" --summary "$out/asteroid_summary.json"
"$bin/synth" "$out/gravel.json" --texture 1024x1024 -o "$out/gravel_height.tif"

cat <<EOF

Done. Look at
  $out/gravel_report/     the photo, the noise made from it, their spectra
  $out/body_report/       the shape model, the fit, where they differ
  $out/asteroid.png       the synthesised asteroid
  $out/asteroid.ply       its watertight mesh, for Blender, MeshLab, CloudCompare or ParaView
  $out/gravel.json, $out/body.json   the recipes; docs/recipe.md explains every field
EOF
