#!/usr/bin/env bash
# Sets up, builds and runs every test. test.sh [PRESET], PRESET one of release (default), ci, debug, asan, tsan.
set -euo pipefail
cd "$(dirname "$0")/.."

preset=${1:-release}
scripts/setup.sh
scripts/fetch_data.sh
scripts/build.sh "$preset"
ctest --preset "$preset"
