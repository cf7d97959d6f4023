#!/usr/bin/env bash
# Runs clang-tidy (.clang-tidy) on the programs' and libraries' sources; any finding fails.
#   lint.sh [BUILD_FOLDER] [SOURCE ...]    the folder is configured, and needs not be built; all sources by default
# The folder of the preset lint is the quickest: the headers of a group of 16 sources are read once. A single SOURCE needs
# the preset debug.
set -euo pipefail
cd "$(dirname "$0")/.."

build=${1:-build/lint}
commands=$build/compile_commands.json
[[ -f $commands ]] || { echo "lint.sh: $build is not configured; run cmake --preset ${build##*/} first" >&2; exit 1; }
sources=("${@:2}")
if [[ ${#sources[@]} -eq 0 ]]; then
  # Those that this configuration compiles: clang-tidy would have to guess the flags of others. Groups of sources that the
  # build makes are left out: they do not exist yet.
  mapfile -t sources < <(sed -n 's/^ *"file": "\(.*\.\(cpp\|cxx\)\)",\?$/\1/p' "$commands" | grep -v "^$PWD/tests/\|/build/[a-z]*/tests/" |
    while read -r source; do grep -qs "#include \"$PWD/build/" "$source" || echo "$source"; done)
fi
options=()
# What a unity source includes is to clang-tidy what a header is: to be reported by name, and analysed only if asked.
if grep -q '/Unity/unity_' "$commands"; then
  options=(--header-filter="^$PWD/[a-z0-9_/]*\.(h|cpp)\$" --checks=-bugprone-suspicious-include
    --extra-arg=-Xclang --extra-arg=-analyzer-opt-analyze-headers)
fi
# The count of warnings that were left out goes to stderr for each file, and says nothing.
printf '%s\n' "${sources[@]}" | xargs -P "$(nproc)" -I FILE sh -c \
  'source=$1; shift; out=$(clang-tidy-14 --quiet "$@" "$source" 2>&1) && exit 0; printf "%s\n" "$out" | grep -v " warnings\? generated" >&2; exit 1' \
  lint FILE -p "$build" "${options[@]}"
