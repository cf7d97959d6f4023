#!/usr/bin/env bash
# Builds the wheel of the Python package into build/wheels, installs it into an empty virtual environment, and runs its tests
# there: wheel.sh [FOLDER_OF_PROGRAMS]. With the folder, such as build/release/bin, bytes are compared with the programs'.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh --python
command -v ccache >/dev/null && export CMAKE_CXX_COMPILER_LAUNCHER=ccache
rm -rf build/wheels build/wheel-venv
/usr/bin/python3 -m venv build/wheel-venv
pip=(build/wheel-venv/bin/pip --disable-pip-version-check)
"${pip[@]}" wheel -q --no-deps -w build/wheels .
"${pip[@]}" install -q "$(ls build/wheels/astrolith-*.whl)[test]"
[[ $# -gt 0 ]] && export ASTROLITH_BIN=$(realpath "$1")
# -P: the checkout's own folders are no packages here.
build/wheel-venv/bin/python -P -m pytest -q python/tests
