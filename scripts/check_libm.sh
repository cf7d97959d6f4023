#!/usr/bin/env bash
# No function of the C library whose last bits differ between its versions and between processors may reach what synth,
# describe or compare write: their objects may not call it. Square roots, roundings and fma are exact everywhere.
#   check_libm.sh [BUILD_FOLDER]
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build/ci}

# object, function: why the call reaches no result
allowed='
half_edge_mesh.cpp.o cos: in OpenMesh, for feature edges, which nothing asks for
decimated_mesh.cpp.o cos: in OpenMesh, for feature edges, which nothing asks for
'
inexact='(exp|exp2|exp10|expm1|log|log2|log10|log1p|pow|sin|cos|sincos|tan|asin|acos|atan|atan2|sinh|cosh|tanh|asinh|acosh|atanh|hypot|cbrt|erf|erfc|lgamma|tgamma)[fl]?'

folders=(numerics recipe geometry gravity descriptor synthesis cuda tasks/job tasks/gravity tasks/description tasks/synth apps/CMakeFiles)
mapfile -t objects < <(cd "$build" && find "${folders[@]}" -name '*.o' ! -path '*/classify.dir/*' | sort)
for folder in "${folders[@]}"; do
  grep -q "^$folder/" <<<"$(printf '%s\n' "${objects[@]}")" || { echo "check_libm.sh: $build/$folder is not built" >&2; exit 1; }
done
calls=$(cd "$build" && nm -A -u "${objects[@]}" | awk -v inexact="^$inexact\$" '
  $NF ~ inexact {n = split($1, parts, "[/:]"); print parts[n - 1], $NF}' | sort -u)
failed=0
while read -r object function; do
  [[ -n $object ]] || continue
  grep -q "^$object $function: " <<<"$allowed" && continue
  echo "check_libm.sh: $object calls $function; use numerics/portable_double.h or portable_angles.h" >&2
  failed=1
done <<<"$calls"
exit $failed
