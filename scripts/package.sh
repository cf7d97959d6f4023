#!/usr/bin/env bash
# Makes build/package/astrolith_VERSION_ARCHITECTURE.deb: the programs without GPU code, and their man pages.
#   scripts/package.sh && sudo apt install ./build/package/astrolith_*.deb
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh --package
command -v ccache >/dev/null && export CMAKE_CXX_COMPILER_LAUNCHER=ccache
cmake --preset release -B build/package -DCMAKE_INSTALL_PREFIX=/usr -DASTROLITH_TESTS=OFF >/dev/null
cmake --build build/package
cd build/package
cpack -G DEB
sha256sum astrolith_*.deb | tee SHA256SUMS
