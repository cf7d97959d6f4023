#!/usr/bin/env bash
# Sets up, builds and runs the tests: test.sh [--long|--full] [PRESET]
#   PRESET   one of release (default), ci, debug, asan, tsan
#   --long   runs only the long tests, which are left out otherwise: cases whose names end in Long, scripts whose names end in _long
#   --full   runs all tests, with the large size of those that have two sizes, and those of the page where Emscripten is installed
# GTEST_FILTER chooses cases by their names, such as 'Ply*', and `ctest --preset PRESET -R '^geometry'` one folder after a build.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts=(-E '_long$') filter='-*Long:*Long/*'
case ${1:-} in
  --long) scripts=(-R '_long$|[.]shard_') filter='*Long:*Long/*'; shift ;;
  --full) scripts=() filter='*'; export ASTROLITH_FULL_TESTS=1; shift ;;
  -*) echo "test.sh: $1 is neither --long nor --full" >&2; exit 2 ;;
esac
preset=${1:-release}
scripts/setup.sh --python
[[ $preset == asan || $preset == tsan ]] && scripts/setup.sh --sanitizers
scripts/fetch_data.sh
settings=(-DASTROLITH_PYTHON=OFF)
# An interpreter without a sanitizer does not load a module with one.
if [[ $preset != asan && $preset != tsan ]] && scripts/python_venv.sh; then
  settings+=(-DASTROLITH_PYTHON=ON -DPython_EXECUTABLE="$PWD/build/python-venv/bin/python")
fi
scripts/build.sh "$preset" "${settings[@]}"
GTEST_FILTER=${GTEST_FILTER:-$filter} ctest --preset "$preset" "${scripts[@]}"
if [[ -n ${ASTROLITH_FULL_TESTS:-} && $preset != asan && $preset != tsan ]]; then
  if command -v emcc >/dev/null; then
    scripts/web.sh test "build/$preset/bin/synth"
  else
    echo "skipped: the page, since emcc is missing (scripts/setup.sh --web)"
  fi
fi
