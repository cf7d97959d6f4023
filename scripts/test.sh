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
scripts/setup.sh
scripts/fetch_data.sh
scripts/build.sh "$preset" -DASTROLITH_CUDA=ON
ctest --preset "$preset"
