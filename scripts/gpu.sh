#!/usr/bin/env bash
# Takes synth, describe, the GPU tests and a benchmark to a machine with a GPU, which needs a driver alone.
#   gpu.sh binaries FILE.tar.gz  here: builds them, and packs them with the libraries they load
#   gpu.sh run [TABLE.md]        there, in the unpacked folder: the tests, the rates of the GPU beside the CPU as a table
#                                (gpu_table.md), and compute-sanitizer where it is installed; exit status 3 where there is
#                                no GPU to use. About four minutes.
set -euo pipefail
cd "$(dirname "$0")/.."

build=build/synth-only
tests=$build/tests/cuda_tests
sinks=$build/tests/benchmarks/sinks_benchmark

pack_binaries() {
  command -v "${CUDACXX:-nvcc}" >/dev/null || { echo "gpu.sh: nvcc is missing; install CUDA's compiler, put it on the PATH" >&2; exit 1; }
  scripts/build.sh synth-only -DASTROLITH_CUDA=ON -DASTROLITH_BENCHMARKS=ON synth describe cuda_tests sinks_benchmark
  local pack program
  pack=$(mktemp -d)
  trap "rm -rf '$pack'" EXIT  # expanded now: the function's variable is gone at exit
  mkdir -p "$pack"/astrolith/{scripts,lib,synthesis}
  cp scripts/gpu.sh "$pack/astrolith/scripts/"
  cp -r synthesis/examples "$pack/astrolith/synthesis/"
  for program in $build/bin/{synth,describe} $tests $sinks; do
    install -D "$program" "$pack/astrolith/$program"
    # Every library that it loads, but for the C library's own, which belong to the machine.
    ldd "$program" | awk '$3 ~ /^\// {print $3}' | grep -vE '/(libc|libm|ld-linux[^/]*|libpthread|libdl|librt)\.so' |
      xargs -I{} cp -Ln {} "$pack/astrolith/lib/"
  done
  tar -C "$pack" -czf "$1" astrolith
}

# seconds COMMAND: runs it; prints the seconds on the clock.
seconds() {
  local start=$EPOCHREALTIME
  "$@" >/dev/null 2>&1 || { echo "gpu.sh: failed: $*" >&2; return 1; }
  awk "BEGIN { printf \"%.2f\", $EPOCHREALTIME - $start }"
}

# row NAME OPTION ...: a row of the table, the GPU beside the CPU, and whether the bytes are equal.
row() {
  local name=$1 on_gpu on_cpu
  on_gpu=$(seconds $build/bin/synth "${@:2}" --device cuda -o "$made/gpu.ply")
  on_cpu=$(seconds $build/bin/synth "${@:2}" --device cpu -o "$made/cpu.ply")
  cmp -s "$made/gpu.ply" "$made/cpu.ply" && same=equal || same=DIFFERENT
  echo "| $name | $on_gpu | $on_cpu | $same |"
}

table() {
  local recipe member
  echo "$(nvidia-smi --query-gpu=name,driver_version --format=csv,noheader | head -1), $(nproc) processors; seconds on the clock."
  echo
  echo "| what | GPU | CPU | bytes |"
  echo "|---|---|---|---|"
  for recipe in itokawa_relief itokawa_details comet_nucleus eros_gravel; do
    row "$recipe, 1 M triangles" synthesis/examples/$recipe.json --triangles 1e6
    row "$recipe, 10 M triangles" synthesis/examples/$recipe.json --triangles 1e7
  done
  row "comet_nucleus, an aligned patch" synthesis/examples/comet_nucleus.json \
    --patch 0.332263 0.444628 -0.197816 0.01 --aligned --resolution 1000
  local on_gpu on_cpu family=(synthesis/examples/family_of_rubble.json --members 0:200 --triangles 20000)
  on_gpu=$(seconds $build/bin/synth "${family[@]}" --device cuda -o "$made/g{member}.ply")
  on_cpu=$(seconds $build/bin/synth "${family[@]}" --device cpu --threads 2 -o "$made/c{member}.ply")
  same=equal
  for member in $(seq -f %07g 0 199); do cmp -s "$made/g$member.ply" "$made/c$member.ply" || same=DIFFERENT; done
  echo "| 200 members of 20,000 triangles; CPU: two threads | $on_gpu | $on_cpu | $same |"
  echo
  local relief=(synthesis/examples/itokawa_relief.json --triangles 1e7 --device cpu -o "$made/cpu.ply")
  echo "CPU alone, itokawa_relief, 10 M triangles: $(seconds $build/bin/synth "${relief[@]}" --threads 1) s with one" \
    "thread, $(seconds $build/bin/synth "${relief[@]}" --threads 2) s with two."
  echo
  echo "Mesher, check and file, \`sinks_benchmark itokawa_relief.json 1900\`:"
  echo
  $sinks synthesis/examples/itokawa_relief.json 1900 "$made/sinks.ply" | sed 's/^/    /'
}

sanitize() {
  command -v compute-sanitizer >/dev/null || { echo "compute-sanitizer is not installed here: left out"; return; }
  local tool recipe result name options
  for tool in memcheck racecheck synccheck initcheck; do
    for recipe in layers_combined itokawa_relief craters_power_law spots_composed kernels boulders regions \
      "comet_nucleus --patch 0.332263 0.444628 -0.197816 0.01 --aligned"; do
      result=passes
      read -r name options <<<"$recipe"
      timeout 30 compute-sanitizer --tool $tool --error-exitcode 1 $build/bin/synth synthesis/examples/$name.json $options \
        --resolution 20 --device cuda -o "$made/checked.ply" >"$made/said.txt" 2>&1 || result="FAILS ($?): $(tail -1 "$made/said.txt")"
      echo "- $tool, \`$recipe\`: $result"
    done
  done
}

run() {
  [[ -x $tests ]] || { echo "gpu.sh: the programs are not here; unpack what 'gpu.sh binaries' packed" >&2; exit 1; }
  [[ -d lib ]] && export LD_LIBRARY_PATH=$PWD/lib
  $tests
  nvidia-smi -L || { echo "gpu.sh: no GPU is here; the tests ran on the host alone" >&2; exit 3; }
  made=$(mktemp -d)
  trap "rm -rf '$made'" EXIT
  { table; echo; sanitize; } | tee "$1"
  ! grep -E 'DIFFERENT|FAILS' "$1" || { echo "gpu.sh: see $1" >&2; exit 1; }
}

case "${1:-} ${2:-}" in
  "binaries "?*) pack_binaries "$2" ;;
  "run "*) run "${2:-gpu_table.md}" ;;
  *) sed -n '2,6p' "$0" >&2; exit 2 ;;
esac
