#!/usr/bin/env bash
# Takes synth and the GPU tests to a machine with a GPU that has none of the fitting packages.
#   gpu.sh pack FILE.tar.gz      here: the sources that synth and the GPU tests need, and no others
#   gpu.sh binaries FILE.tar.gz  here: builds them, and packs the programs with the libraries they load; that machine
#                                then needs a driver alone
#   gpu.sh build                 there, in the unpacked sources: builds them (scripts/setup.sh --synth installs the packages)
#   gpu.sh run                   there: tests, compute-sanitizer where it is installed, and the benchmark's table
set -euo pipefail
cd "$(dirname "$0")/.."

folders=(numerics recipe geometry descriptor synthesis cuda apps cmake scripts tests)
build=build/synth-only
programs=("$build/bin/synth" "$build/bin/describe" "$build/tests/cuda/cuda_tests" "$build/tests/cuda/gpu_benchmark")

build_programs() {
  scripts/build.sh synth-only synth describe cuda_tests gpu_benchmark
}

# Every library that a program loads, but for the C library's own, which belong to the machine.
pack_binaries() {
  local pack
  pack=$(mktemp -d)
  trap 'rm -rf "$pack"' EXIT
  mkdir -p "$pack/astrolith/scripts" "$pack/astrolith/lib"
  cp scripts/gpu.sh "$pack/astrolith/scripts/"
  for program in "${programs[@]}"; do
    install -D "$program" "$pack/astrolith/$program"
    ldd "$program" | awk '$3 ~ /^\// {print $3}' | grep -vE '/(libc|libm|ld-linux[^/]*|libpthread|libdl|librt)\.so' |
      xargs -I{} cp -Ln {} "$pack/astrolith/lib/"
  done
  tar -C "$pack" -czf "$1" astrolith
}

run() {
  [[ -d lib ]] && export LD_LIBRARY_PATH=$PWD/lib
  date -u
  "${programs[2]}"
  if command -v compute-sanitizer >/dev/null; then
    for tool in memcheck racecheck synccheck; do
      compute-sanitizer --tool "$tool" --error-exitcode 1 "${programs[2]}" --gtest_filter='*OnGpu*:Device*'
    done
  else
    echo "compute-sanitizer is not installed here: left out"
  fi
  "${programs[3]}"
  if command -v cuobjdump >/dev/null; then
    echo
    echo "Instructions of the kernels, counted in the machine code of the newest architecture:"
    cuobjdump -sass -arch sm_90 "${programs[3]}" | awk '/Function :/ {name=$3} /^ *\/\*[0-9a-f]+\*\/ / {n[name]++} END {for (k in n) print n[k], k}' | sort -n
  fi
}

case "${1:-} ${2:-}" in
  "pack "?*) git archive --prefix=astrolith/ HEAD CMakeLists.txt CMakePresets.json LICENSE README.md "${folders[@]}" | gzip >"$2" ;;
  "binaries "?*) build_programs && pack_binaries "$2" ;;
  "build ") build_programs ;;
  "run ") run ;;
  *) sed -n '2,8p' "$0" >&2; exit 2 ;;
esac
