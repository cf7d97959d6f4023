#!/usr/bin/env bash
# Feeds every reader with files made by libFuzzer from its seeds, with the address and undefined-behaviour sanitizers on.
#   fuzz.sh SECONDS [READER ...]    SECONDS for each reader; all readers by default
#   FUZZ_CORPUS=DIR                 keeps what it found worth keeping there for the next run (default build/fuzz/corpus)
# A file that crashes a reader, or takes more than 2 s or more memory than its fuzzer in tests/fuzz states, ends the run. It lies
# in build/fuzz then.
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=${1:?fuzz.sh: give the seconds for each reader}
readers=("${@:2}")
corpus=${FUZZ_CORPUS:-$PWD/build/fuzz/corpus}
scripts/setup.sh --fuzz
scripts/build.sh fuzz fuzzers
[[ ${#readers[@]} -gt 0 ]] || readers=($(cd build/fuzz/tests/fuzz && ls fuzz_* | sed s/fuzz_//))

# seeds_of READER: the folders of its first files
seeds_of() {
  case $1 in
    mesh) echo tests/fuzz/seeds/{obj,ply,stl_ascii,stl_binary,off,plate,icq,bmf,grid_table,zst} ;;
    recipe) echo synthesis/examples ;;
    *) echo "tests/fuzz/seeds/$1" ;;
  esac
}
for reader in "${readers[@]}"; do
  mkdir -p "$corpus/$reader"
  for seeds in $(seeds_of "$reader"); do cp -n "$seeds"/*.* "$corpus/$reader"; done
  log=build/fuzz/$reader.log
  # Inputs of up to 8 kB: longer ones reach no further lines and are slower.
  build/fuzz/tests/fuzz/fuzz_"$reader" -max_total_time="$seconds" -timeout=2 -max_len=8192 -rss_limit_mb=2048 -seed=1 \
    -print_final_stats=1 -artifact_prefix="build/fuzz/$reader-" "$corpus/$reader" >"$log" 2>&1 ||
    { tail -n 40 "$log" >&2; echo "fuzz.sh: $reader failed; the file is named above" >&2; exit 1; }
  awk -v reader="$reader" '/number_of_executed_units/ { n = $2 } /slowest_unit_time_sec/ { s = $2 } /peak_rss_mb/ { m = $2 }
    END { printf "%-13s %9d files, slowest %d s, at most %d MB\n", reader, n, s, m }' "$log"
done
