#!/usr/bin/env bash
# Builds synth for arm64 by Debian's cross compiler, runs it in an emulator, and compares the meshes of all examples with those
# of this machine: arm64.sh SYNTH [CELLS]. The libraries of an arm64 system are unpacked into build/arm64/root.
set -euo pipefail
cd "$(dirname "$0")/.."
export LC_ALL=C

native=$(realpath "${1:?arm64.sh: name the program synth of this machine}")
cells=${2:-48}
scripts/setup.sh --synth --arm64
root=$PWD/build/arm64/root
if [[ ! -e $root/usr/include/zip.h ]]; then
  mkdir -p build/arm64
  rm -rf "$root" "$root.new"
  packages=$(sed -n '/^packages=(/,/^)/p' scripts/setup.sh | grep -o 'lib[^ ]*-dev\|nlohmann[^ ]*\|zlib1g-dev' | paste -sd,)
  mmdebstrap --quiet --variant=extract --architectures=arm64 --include="$packages,libstdc++-12-dev" bookworm "$root.new"
  mv "$root.new" "$root"
fi
command -v ccache >/dev/null && export CMAKE_CXX_COMPILER_LAUNCHER=ccache
cmake --preset synth-only -B build/arm64/build -DCMAKE_TOOLCHAIN_FILE="$PWD/cmake/arm64.cmake" \
  -DASTROLITH_ARM64_ROOT="$root" -DASTROLITH_TESTS=OFF >/dev/null
cmake --build build/arm64/build --target synth

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# All headers by clang for that machine, and the sources with branches for other systems as if for none that they name.
check=(clang++-14 --target=aarch64-linux-gnu "--sysroot=$root" -std=c++20 -fsyntax-only -Wall -Wextra -Werror -Wno-psabi
  -Wno-unused-const-variable -Wno-unused-function -I. "-I$root/usr/include/cairo" "-I$root/usr/include/eigen3")
git ls-files {numerics,recipe,geometry,gravity,descriptor,synthesis}/'*.h' tasks/{job,synth}/'*.h' |
  grep -vE '^descriptor/(classification|spectrum)/' | sed 's/.*/#include "&"/' >"$work/headers.cpp"
"${check[@]}" "$work/headers.cpp"
for source in $(git grep -lE '#.*(__linux__|__GLIBC__|O_TMPFILE)' -- '*.cpp') tasks/synth/synth.cpp; do
  "${check[@]}" -U__linux__ -U__GLIBC__ "$source"
done
echo "the headers compile for arm64 and, where they branch, for a system that is neither Linux nor glibc"

# mesh NAME COMMAND ...: the SHA-256 of the mesh of an example, without the line that names the program.
mesh() {
  "${@:2}" "$recipe" -o "$work/$1.ply" --resolution "$cells" --device cpu --quiet
  sed '/^comment made by /d' "$work/$1.ply" | sha256sum | cut -c 1-64
}
count=0 unlike=0
for recipe in synthesis/examples/*.json; do
  here=$(mesh native "$native")
  there=$(mesh arm64 qemu-aarch64-static -L "$root" build/arm64/build/bin/synth)
  count=$((count + 1))
  [[ $here == "$there" ]] && continue
  unlike=$((unlike + 1))
  echo "$(basename "$recipe"): $here here, $there on arm64"
done
echo "$count examples at $cells cells: $unlike differ on arm64"
[[ $unlike -eq 0 ]]
