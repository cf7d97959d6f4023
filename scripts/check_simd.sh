#!/usr/bin/env bash
# check_simd.sh [RESOLUTION]: every example has the same SHA-256 from the scalar, the AVX2 and (where the machine has
# it) the AVX-512 build, and from one thread and two. Builds synth once for each; not part of CI.
set -euo pipefail
cd "$(dirname "$0")/.."

resolution=${1:-40}
levels=(scalar x86-64-v3)
grep -q avx512vl /proc/cpuinfo && levels+=(x86-64-v4)
launcher=()
command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
for level in "${levels[@]}"; do
  cmake --preset synth-only -B "build/simd/$level" -DASTROLITH_SIMD="$level" -DASTROLITH_TESTS=OFF "${launcher[@]}" >/dev/null
  cmake --build "build/simd/$level" --target synth -- -j2 >/dev/null
done

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failed=0
for recipe in synthesis/examples/*.json; do
  hashes=$(for level in "${levels[@]}"; do
    for threads in 1 2; do
      "build/simd/$level/bin/synth" "$recipe" -o "$folder/mesh.ply" --resolution "$resolution" --threads "$threads" --quiet
      sha256sum <"$folder/mesh.ply"
    done
  done | sort | uniq -c)
  if [[ $(wc -l <<<"$hashes") -eq 1 ]]; then
    echo "same  $(basename "$recipe")"
  else
    echo "DIFFERENT  $(basename "$recipe")"
    echo "$hashes"
    failed=1
  fi
done
exit $failed
