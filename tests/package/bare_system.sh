#!/usr/bin/env bash
# Installs wheels into a bare Debian: Python, its module venv and the C++ library, no shell and no font. Runs programs and the
# package there, and says how long the installation and a first picture take: bare_system.sh FOLDER_OF_WHEELS
set -euo pipefail
cd "$(dirname "$0")/../.."
export LC_ALL=C

bare=$PWD/build/bare
if [[ ! -e $bare/usr/bin/python3 ]]; then
  rm -rf "$bare" "$bare.new"
  mmdebstrap --quiet --variant=extract --include=python3-venv,libstdc++6 bookworm "$bare.new"
  mv "$bare.new" "$bare"
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
# timed WORDS PROGRAM ...: says how long a program takes.
timed() {
  local begin=${EPOCHREALTIME/./}
  inside "${@:2}" >/dev/null
  echo "$1: $(((${EPOCHREALTIME/./} - begin) / 1000)) ms"
}
pip=(python -m pip --disable-pip-version-check -q install --no-index --find-links wheels/needed --find-links wheels)

inside /usr/bin/python3 -m venv venv
timed "pip install astrolith" "${pip[@]}" astrolith
timed "a first picture" synth eros -o eros.glb --preview eros.png --quiet
for file in eros.glb eros.png; do [[ -s $bare/try/$file ]] || { echo "no $file" >&2; exit 1; }; done
# Labels have a font, or the C library of fonts would complain.
[[ -z $(inside synth ky26 -o ky26.glb --preview ky26.png --quiet 2>&1) ]]
inside astrolith describe eros.glb -o eros.npy --points 2000 --quiet
inside gravity bennu --density 1190 --quiet
inside python -c 'import astrolith; assert astrolith.mesh("itokawa", resolution=32).figures.closed'
# The fits are named where they are missing, and then installed.
if said=$(inside astrolith fit_shape eros.glb -o fit.json 2>&1); then echo "fit_shape ran" >&2; exit 1; fi
[[ $said == *"pip install 'astrolith[fit]'"* ]] || { echo "$said" >&2; exit 1; }
timed "pip install astrolith[fit]" "${pip[@]}" 'astrolith[fit]'
inside fit_shape eros.glb -o fit.json --spheres 20 --base-only --quiet
inside synth fit.json -o fit.ply --resolution 48 --quiet
inside python -c 'import astrolith; astrolith.repair_mesh(astrolith.read_mesh("eros.glb"))'
[[ ! -e build/web/page.html ]] || inside synth eros --page page.html --quiet
echo "both wheels work in a bare system"
