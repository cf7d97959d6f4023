#!/usr/bin/env bash
# Takes synth, describe and the GPU tests to a machine with a GPU, which needs a driver alone.
#   gpu.sh binaries FILE.tar.gz  here: builds them, and packs them with the libraries they load
#   gpu.sh run                   there, in the unpacked folder: the tests, and compute-sanitizer where it is installed; exit
#                                status 3 where there is no GPU to use
set -euo pipefail
cd "$(dirname "$0")/.."

build=build/synth-only
tests=$build/tests/cuda_tests

pack_binaries() {
  command -v "${CUDACXX:-nvcc}" >/dev/null || { echo "gpu.sh: nvcc is missing; install CUDA's compiler, put it on the PATH" >&2; exit 1; }
  scripts/build.sh synth-only synth describe cuda_tests
  local pack program
  pack=$(mktemp -d)
  trap "rm -rf '$pack'" EXIT  # expanded now: the function's variable is gone at exit
  mkdir -p "$pack"/astrolith/{scripts,lib,synthesis}
  cp scripts/gpu.sh "$pack/astrolith/scripts/"
  cp -r synthesis/examples "$pack/astrolith/synthesis/"
  for program in $build/bin/{synth,describe} $tests; do
    install -D "$program" "$pack/astrolith/$program"
    # Every library that it loads, but for the C library's own, which belong to the machine.
    ldd "$program" | awk '$3 ~ /^\// {print $3}' | grep -vE '/(libc|libm|ld-linux[^/]*|libpthread|libdl|librt)\.so' |
      xargs -I{} cp -Ln {} "$pack/astrolith/lib/"
  done
  tar -C "$pack" -czf "$1" astrolith
}

run() {
  [[ -x $tests ]] || { echo "gpu.sh: the programs are not here; unpack what 'gpu.sh binaries' packed" >&2; exit 1; }
  [[ -d lib ]] && export LD_LIBRARY_PATH=$PWD/lib
  $tests
  nvidia-smi -L || { echo "gpu.sh: no GPU is here; the tests ran on the host alone" >&2; exit 3; }
  command -v compute-sanitizer >/dev/null || { echo "compute-sanitizer is not installed here: left out"; return; }
  for tool in memcheck racecheck synccheck initcheck; do
    compute-sanitizer --tool $tool --error-exitcode 1 $tests --gtest_filter='*OnGpu*:Device*'
  done
}

case "${1:-} ${2:-}" in
  "binaries "?*) pack_binaries "$2" ;;
  "run ") run ;;
  *) sed -n '2,6p' "$0" >&2; exit 2 ;;
esac
