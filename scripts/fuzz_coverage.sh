#!/usr/bin/env bash
# Prints the share of the lines of each reader's source that the files of scripts/fuzz.sh and its seeds reach.
#   fuzz_coverage.sh [READER ...]    all readers by default; FUZZ_CORPUS=DIR as for fuzz.sh
set -euo pipefail
cd "$(dirname "$0")/.."

corpus=${FUZZ_CORPUS:-$PWD/build/fuzz/corpus}
build=build/fuzz-coverage
scripts/setup.sh --fuzz
cmake --preset fuzz -B $build -DASTROLITH_CUDA=OFF -DCMAKE_CXX_FLAGS="-fprofile-instr-generate -fcoverage-mapping" >/dev/null

# source_of READER: the sources that its fuzzer is about
source_of() {
  case $1 in
    stl_ascii | stl_binary) echo geometry/io/stl.cpp ;;
    mesh) echo geometry/io/mesh_{file,format,io}.cpp geometry/io/ply_{header,values}.cpp geometry/io/text_scanner.cpp ;;
    points) echo geometry/io/read_points.cpp ;;
    recipe) ls recipe/*_fields.cpp recipe/recipe_reader.cpp recipe/recipe_validation.cpp recipe/json_*.cpp ;;
    png) echo synthesis/picture/png_reader.cpp ;;
    classifier) echo descriptor/classification/classifier_reader.cpp ;;
    photo_header) echo estimation/gabor/image/image_header.cpp ;;
    checkpoint) echo tasks/estimation/fit_checkpoint.cpp ;;
    *) ls geometry/io/{,read_}"$1.cpp" 2>/dev/null ;;
  esac
}
readers=("$@")
[[ ${#readers[@]} -gt 0 ]] || readers=(obj ply stl_ascii stl_binary off plate icq bmf mesh points recipe png classifier photo_header checkpoint)
cmake --build $build --target "${readers[@]/#/fuzz_}" >/dev/null
for reader in "${readers[@]}"; do
  fuzzer=$build/tests/fuzz/fuzz_$reader
  LLVM_PROFILE_FILE=$build/$reader.profraw "$fuzzer" -runs=0 "$corpus/$reader" >/dev/null 2>&1
  llvm-profdata-14 merge -o "$build/$reader.profdata" "$build/$reader.profraw"
  # The last line of the report is the total: regions, functions and lines, each as number, missed and share.
  llvm-cov-14 report "$fuzzer" -instr-profile "$build/$reader.profdata" $(source_of "$reader") |
    awk -v reader="$reader" '$1 == "TOTAL" { printf "%-13s %5d lines, %s reached\n", reader, $8, $10 }'
done
