#!/usr/bin/env bash
# Runs clang-tidy (.clang-tidy) on the programs' and libraries' sources; any finding fails.
#   lint.sh [BUILD_FOLDER] [SOURCE ...]    the folder is configured, and needs not be built; all sources by default
set -euo pipefail
cd "$(dirname "$0")/.."

build=${1:-build/ci}
[[ -f $build/compile_commands.json ]] || { echo "lint.sh: $build is not configured; run cmake --preset ci first" >&2; exit 1; }
sources=("${@:2}")
if [[ ${#sources[@]} -eq 0 ]]; then
  # Those that this configuration compiles: clang-tidy would have to guess the flags of others.
  mapfile -t sources < <(git ls-files '*.cpp' ':!tests' | while read -r source; do
    grep -q "\"file\": \".*/$source\"" "$build/compile_commands.json" && echo "$source"
  done)
fi
# The count of warnings that were left out goes to stderr for each file, and says nothing.
printf '%s\n' "${sources[@]}" | xargs -P "$(nproc)" -I FILE sh -c \
  'out=$(clang-tidy-14 --quiet -p "$1" "$2" 2>&1) && exit 0; printf "%s\n" "$out" | grep -v " warnings\? generated" >&2; exit 1' lint "$build" FILE
