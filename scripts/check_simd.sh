#!/usr/bin/env bash
# check_simd.sh [RESOLUTION]: every example has the same SHA-256 from a scalar build, one for AVX2 and the ordinary one, which
# takes the best the machine has, and from one thread and two. Builds synth three times; not part of CI.
set -euo pipefail
cd "$(dirname "$0")/.."

resolution=${1:-40}
levels=(scalar x86-64-v3 ordinary)
command -v ccache >/dev/null && export CMAKE_CXX_COMPILER_LAUNCHER=ccache
for level in "${levels[@]}"; do
  cmake --preset synth-only -B "build/simd/$level" -DASTROLITH_SIMD="${level#ordinary}" -DASTROLITH_TESTS=OFF >/dev/null
  cmake --build "build/simd/$level" --target synth -- -j2 >/dev/null
done
grep -o -m1 avx512vl /proc/cpuinfo || echo "no AVX-512 here: it is not compared"

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
