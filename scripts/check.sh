#!/usr/bin/env bash
# The checks of this project. The first that fails ends the run; at the end stands how long each took.
#   check.sh quick      what every change must pass
#   check.sh slice K    one of the slices, K from 1 to 5, that are together everything else but the wheels and arm64
#   check.sh all        everything; before a version is dated in CHANGELOG.md
set -euo pipefail
cd "$(dirname "$0")/.."

short='-*Long:*Long/*' long='*Long:*Long/*'  # the names of cases that take seconds (GTEST_FILTER)
first=(numerics recipe geometry gravity descriptor surface_statistics spectrum classification synthesis)
second=(cuda optimize page repair gabor_fit shape_fit details_fit)
python="-DASTROLITH_PYTHON=ON -DPython_EXECUTABLE=$PWD/build/python-venv/bin/python"
times=$(mktemp)
trap 'cat "$times" >&2; rm "$times"' EXIT

# check NAME COMMAND: runs a check.
check() {
  echo "== $1"
  TIMEFORMAT="$1: %0R s on the clock, %0U s of processors, %0S s of the system"
  { time bash -euo pipefail -c "$2" 2>&3; } 3>&2 2>>"$times"
}

# sanitized PRESET SUITE ...: builds and runs the short cases of suites with a sanitizer.
sanitized() {
  local suites=$(IFS='|' && echo "${*:2}")
  check "$1: ${*:2}" "scripts/build.sh $1 -DASTROLITH_PYTHON=OFF $(printf '%s_tests ' "${@:2}")
    GTEST_FILTER='$short' ctest --preset $1 -R '^($suites)[.]shard'"
}

quick() {
  check formatting "git ls-files '*.h' '*.cpp' '*.cu' | xargs clang-format-14 --dry-run -Werror"
  check arrows scripts/check_arrows.sh
  check tests "scripts/test.sh ci"
  check "C library" "scripts/check_libm.sh build/ci"
}

# Each slice compiles a fifth of the sources by themselves, too.
slice_1() {
  check clang-tidy scripts/lint.py
  sanitized tsan "${first[@]}" "${second[@]}"
}

slice_2() { sanitized asan "${first[@]}"; }

# What slice 2 leaves out: whatever it is called.
slice_3() {
  check "asan: the rest" "scripts/build.sh asan -DASTROLITH_PYTHON=OFF
    GTEST_FILTER='$short' ctest --preset asan -E '_long$|^($(IFS='|' && echo "${first[*]}"))[.]'"
}

slice_4() {
  check "long tests" "scripts/test.sh --long ci"
  check "asan: long tests" "scripts/build.sh asan -DASTROLITH_PYTHON=OFF
    GTEST_FILTER='$long' ctest --preset asan -R '[.]shard|_long$'"
}

slice_5() {
  check "benchmarks and notebooks" "scripts/build.sh ci -DASTROLITH_BENCHMARKS=ON $python
    ASTROLITH_BIN=\$PWD/build/ci/bin ASTROLITH_BUILD=\$PWD/build/ci scripts/notebooks.sh --jobs 2"
  check "the page" "scripts/setup.sh --browser && scripts/web.sh test build/ci/bin/synth"
  check "the site" "ASTROLITH_BUILD=build/ci scripts/site.sh || [[ \$? -eq 3 ]]"  # 3: no package index is reached
  check fuzzers "scripts/setup.sh --fuzz && scripts/build.sh fuzz fuzzers"
  if command -v "${CUDACXX:-nvcc}" >/dev/null; then
    check "GPU code" "scripts/build.sh ci -DASTROLITH_CUDA=ON astrolith_cuda cuda_tests synth"
  else
    echo "GPU code: skipped: no nvcc"
  fi
}

slice() {
  "slice_$1"
  check "each source by itself" "scripts/lint.py --includes $1/5"
}

case "${1:-} ${2:-}" in
  "quick ") quick ;;
  "slice "[1-5]) slice "$2" ;;
  "all ")
    quick
    for k in 1 2 3 4 5; do slice $k; done
    check wheels scripts/wheel.sh
    check arm64 "scripts/arm64.sh build/ci/bin/synth"
    ;;
  *) sed -n '2,5s/^# *//p' "$0" >&2; exit 2 ;;
esac
