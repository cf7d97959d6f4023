#!/usr/bin/env bash
# Installs wheels into a bare Debian: Python, its module venv and the C++ library, no shell and no font. Runs programs and the
# package there, and says how long the installation and a first picture take: bare_system.sh FOLDER_OF_WHEELS
set -euo pipefail
cd "$(dirname "$0")/../.."

bare=$PWD/build/bare
if [[ ! -e $bare/usr/bin/python3 ]]; then
  mmdebstrap --quiet --variant=extract --include=python3-venv,libstdc++6 bookworm "$bare" 2>/dev/null
fi
rm -rf "$bare/try"
mkdir -p "$bare/try" "$bare/proc"
mkdir -p "$bare/try/wheels"
cp -r "$1"/*.whl "$1/needed" "$bare/try/wheels/"
# inside PROGRAM ...: runs a program of the bare system.
inside() {
  env -i HOME=/try PATH=/try/venv/bin:/usr/bin \
    unshare --map-root-user --mount --pid --fork --root="$bare" --mount-proc --wd=/try "$@"
}
# timed SECONDS WORDS PROGRAM ...: says how long a program takes, and fails where it takes longer than that.
timed() {
  local begin=${EPOCHREALTIME/./} took
  inside "${@:3}" >/dev/null
  took=$(((${EPOCHREALTIME/./} - begin) / 1000))
  echo "$2: $took ms"
  [[ $took -le $1000 ]]
}
pip=(python -m pip --disable-pip-version-check -q install --no-index --find-links wheels/needed --find-links wheels)

inside /usr/bin/python3 -m venv venv
timed 20 "pip install astrolith" "${pip[@]}" astrolith
timed 5 "a first picture" synth eros -o eros.glb --preview eros.png --quiet
for file in eros.glb eros.png; do [[ -s $bare/try/$file ]] || { echo "no $file" >&2; exit 1; }; done
inside astrolith describe eros.glb -o eros.npy --points 2000 --quiet
inside gravity bennu --density 1190 --quiet
inside python -c 'import astrolith; assert astrolith.mesh("itokawa", resolution=32).figures.closed'
# The fits are named where they are missing, and then installed.
if said=$(inside astrolith fit_shape eros.glb -o fit.json 2>&1); then echo "fit_shape ran" >&2; exit 1; fi
[[ $said == *"pip install 'astrolith[fit]'"* ]] || { echo "$said" >&2; exit 1; }
timed 20 "pip install astrolith[fit]" "${pip[@]}" 'astrolith[fit]'
inside fit_shape eros.glb -o fit.json --spheres 20 --base-only --quiet
inside synth fit.json -o fit.ply --resolution 48 --quiet
inside python -c 'import astrolith; astrolith.repair_mesh(astrolith.read_mesh("eros.glb"))'
[[ ! -e build/web/page.html ]] || inside synth eros --page page.html --quiet
echo "both wheels work in a bare system"
