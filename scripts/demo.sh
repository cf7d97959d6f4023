#!/usr/bin/env bash
# Shows Astrolith's main work on real input. A measured asteroid becomes a recipe, a photo of gravel becomes a layer,
# and both together, with craters and boulders, become a watertight mesh with pictures. The programs are those of the wheels
# in build/wheels (scripts/wheel.sh, or a release), else of the Debian package in build/package, where these are of this version
# and no older than its sources; else they are built.
#   scripts/demo.sh [MESH]      MESH: any closed shape model, in place of the demo's own
set -euo pipefail
mesh=${1:+$(realpath "$1")}
cd "$(dirname "$0")/.."
export LC_ALL=C

version=$(sed -nE 's/^project\(astrolith VERSION ([0-9.]+).*/\1/p' CMakeLists.txt)
# The time of the last commit of the sources; 0 in an archive, where the version says enough.
committed=$(git log -1 --format=%ct -- . ':!*.md' ':!docs' ':!notebooks' ':!tests' 2>/dev/null || true)

# usable FILE ...: whether all of them are there, and none is older than the sources. Says which is older.
usable() {
  local file
  for file in "$@"; do
    [[ -e $file ]] || return 1
    [[ $(stat -c %Y "$file") -ge ${committed:-0} ]] || { echo "$file is left out: it is older than the sources"; return 1; }
  done
}

# Each of these sets bin to the folder of the programs, and taken to what it belongs to.
from_wheels() {
  local tag wheels venv=build/demo-venv
  tag=$(/usr/bin/python3 -c 'import sys; v = sys.version_info; print("cp312-abi3" if v >= (3, 12) else "cp3{0}-cp3{0}".format(v[1]))' \
    2>/dev/null) || { [[ ! -e build/wheels ]] || echo "build/wheels is left out: there is no /usr/bin/python3"; return 1; }
  wheels=(build/wheels/astrolith{,_estimation}-"$version-$tag"-*"_$(uname -m).whl")
  [[ ${#wheels[@]} -eq 2 ]] && usable "${wheels[@]}" || return 1
  rm -rf "$venv"
  if ! /usr/bin/python3 -m venv "$venv" ||
     ! "$venv/bin/pip" install -q --disable-pip-version-check --find-links build/wheels/needed "${wheels[@]}"; then
    echo "build/wheels is left out: no virtual environment took the wheels (above it says why)"
    return 1
  fi
  bin=$venv/bin taken="the wheels ${wheels[*]}"
}

from_package() {
  local package root=build/demo-package
  package=build/package/astrolith_${version}_$(dpkg --print-architecture).deb
  usable "$package" || return 1
  rm -rf "$root"
  dpkg -x "$package" "$root" || return 1
  bin=$root/usr/bin taken=$package
}

from_sources() {
  echo "No wheels and no package of this version are taken: building takes ten processor minutes and more"
  scripts/setup.sh
  scripts/build.sh release fit_gabor fit_shape fit_population synth describe compare classify gravity render check_tiles
  bin=build/release/bin taken="this build, $bin"
}

# The programs run: a package that is only unpacked may lack libraries.
run_here() {
  local program
  for program in fit_shape fit_gabor synth; do
    "$bin/$program" --version >/dev/null || { echo "$taken: left out, because its $program does not run here"; return 1; }
  done
}

{ from_wheels && run_here; } || { from_package && run_here; } || from_sources
echo "The programs are those of $taken: $("$bin/synth" --version)"
scripts/fetch_data.sh
# The shape model is a measured Itokawa where the data folder lies beside the checkout, else Debian's Gaspra.
shape=${mesh:-../shared/data/shapes/itokawa_gaskell_49k.ply}
[[ -e $shape ]] || shape=data-cache/gaspra.bmf
photo=data-cache/gravel.png
out=demo-output
mkdir -p "$out"

echo
echo "1/3  A shape model becomes a recipe: fit_shape $shape"
"$bin/fit_shape" "$shape" -o "$out/body.json" --spheres 80 --noise-seeds 0 \
  --report "$out/body_report" --summary "$out/body_summary.json"

# The gravel becomes as large as boulders: a pixel is a thousandth of the body, and the relief is half a pixel.
diagonal_km=$(awk -F '[:,]' '/"diagonal"/ {print $2}' "$out/body_summary.json")
mm_per_px=$(awk "BEGIN {print $diagonal_km * 1e6 / 1000}")
height_km=$(awk "BEGIN {print $diagonal_km * 0.0005}")
echo "2/3  A photo becomes a layer: fit_gabor $photo"
"$bin/fit_gabor" "$photo" -o "$out/gravel.json" --model auto --mm-per-px "$mm_per_px" \
  --height-rms "$height_km" --unit km \
  --report "$out/gravel_report" --summary "$out/gravel_summary.json"

echo "3/3  Recipes become meshes, pictures and a height map: synth"
"$bin/synth" "$out/body.json" -o "$out/body.ply" --resolution 256 \
  --preview "$out/body.png" --summary "$out/body_mesh_summary.json"
"$bin/synth" synthesis/layers/craters_and_boulders.json --base "$out/body.json" --write-recipe "$out/terrain.json"
"$bin/synth" "$out/gravel.json" --base "$out/terrain.json" -o "$out/asteroid.ply" --resolution 400 --min-component 1e-3 \
  --preview "$out/asteroid.png" --summary "$out/asteroid_summary.json" --write-recipe "$out/asteroid.json"
"$bin/synth" "$out/gravel.json" --texture 1024x1024 -o "$out/gravel_height.tif"

cat <<EOF

Done. Look at
  $out/body_report/index.html     the shape model, the fit and their differences
  $out/body.relief.png            the measured surface over the metaballs, seen from six sides
  $out/gravel_report/index.html   the photo, noise with its spectrum, both spectra
  $out/asteroid.png       the finished asteroid: fit, craters, boulders and gravel
  $out/asteroid.ply       its watertight mesh, for Blender, MeshLab, CloudCompare or ParaView
  $out/asteroid.json      its recipe, made of body.json, gravel.json and synthesis/layers/; docs/recipe.md explains every field
EOF
