#!/usr/bin/env bash
# Takes synth and the GPU tests to a machine with a GPU that has none of the fitting packages.
#   gpu.sh pack FILE.tar.gz      here: the sources that synth and the GPU tests need, and no others
#   gpu.sh binaries FILE.tar.gz  here: builds them, and packs the programs with the libraries they load; that machine
#                                then needs a driver alone
#   gpu.sh build                 there, in the unpacked sources: builds them (scripts/setup.sh --synth installs the packages)
#   gpu.sh run                   there: tests, compute-sanitizer where it is installed, and the benchmark's table; exit status 3
#                                where there is no GPU to use
set -euo pipefail
cd "$(dirname "$0")/.."

folders=(numerics recipe geometry gravity descriptor synthesis cuda tasks apps cmake scripts tests)
build=build/synth-only
programs=("$build/bin/synth" "$build/bin/describe" "$build/tests/cuda/cuda_tests" "$build/tests/cuda/gpu_benchmark")

refuse() {
  echo "gpu.sh: $1" >&2
  exit 1
}

build_programs() {
  command -v "${CUDACXX:-nvcc}" >/dev/null || refuse "nvcc is not here, without which nothing for a GPU can be built: install CUDA's compiler, put it on the PATH"
  scripts/build.sh synth-only synth describe cuda_tests gpu_benchmark
}

# Every library that a program loads, but for the C library's own, which belong to the machine.
pack_binaries() {
  local pack
  pack=$(mktemp -d)
  trap "rm -rf '$pack'" EXIT  # expanded now: the function's variable is gone at exit
  mkdir -p "$pack/astrolith/scripts" "$pack/astrolith/lib"
  cp scripts/gpu.sh "$pack/astrolith/scripts/"
  mkdir "$pack/astrolith/synthesis"
  cp -r synthesis/examples "$pack/astrolith/synthesis/"
  for program in "${programs[@]}"; do
    install -D "$program" "$pack/astrolith/$program"
    ldd "$program" | awk '$3 ~ /^\// {print $3}' | grep -vE '/(libc|libm|ld-linux[^/]*|libpthread|libdl|librt)\.so' |
      xargs -I{} cp -Ln {} "$pack/astrolith/lib/"
  done
  tar -C "$pack" -czf "$1" astrolith
}

sanitize() {
  if ! command -v compute-sanitizer >/dev/null; then
    echo "compute-sanitizer is not installed here: left out"
    return
  fi
  for tool in memcheck racecheck synccheck initcheck; do
    compute-sanitizer --tool "$tool" --error-exitcode 1 "${programs[2]}" --gtest_filter='*OnGpu*:Device*'
  done
}

run() {
  [[ -x "${programs[2]}" && -x "${programs[3]}" ]] ||
    refuse "the programs are not here: unpack what 'gpu.sh binaries' packed, or run 'gpu.sh build' first"
  [[ -d lib ]] && export LD_LIBRARY_PATH=$PWD/lib
  date -u
  if ! "${programs[3]}" --probe; then
    echo "gpu.sh: the tests run on the host alone, and there is no table." >&2
    "${programs[2]}"
    exit 3
  fi
  "${programs[2]}"
  sanitize
  "${programs[3]}"
}

case "${1:-} ${2:-}" in
  "pack "?*) git archive --prefix=astrolith/ HEAD CMakeLists.txt CMakePresets.json LICENSE README.md "${folders[@]}" | gzip >"$2" ;;
  "binaries "?*) build_programs && pack_binaries "$2" ;;
  "build ") build_programs ;;
  "run ") run ;;
  *) sed -n '2,8p' "$0" >&2; exit 2 ;;
esac
