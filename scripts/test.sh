#!/usr/bin/env bash
# Sets up, builds and runs every test: test.sh [--full] [PRESET]
#   PRESET   one of release (default), ci, debug, asan, tsan
#   --full   runs the large size of the tests that have two sizes, which takes some minutes more
set -euo pipefail
cd "$(dirname "$0")/.."

if [[ ${1:-} == --full ]]; then
  export ASTROLITH_FULL_TESTS=1
  shift
fi
preset=${1:-release}
scripts/setup.sh --python
scripts/fetch_data.sh
settings=(-DASTROLITH_CUDA=ON -DASTROLITH_PYTHON=OFF)
# An interpreter without a sanitizer does not load a module with one.
if [[ $preset != asan && $preset != tsan ]] && scripts/python_venv.sh; then
  settings+=(-DASTROLITH_PYTHON=ON -DPython_EXECUTABLE="$PWD/build/python-venv/bin/python")
fi
scripts/build.sh "$preset" "${settings[@]}"
ctest --preset "$preset"
