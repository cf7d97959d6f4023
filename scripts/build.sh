#!/usr/bin/env bash
# Configures and builds one preset of CMakePresets.json. The build uses ccache where it is installed, set up so that a fresh
# clone in another folder finds what was compiled here.
#   build.sh PRESET [-DNAME=VALUE ...] [TARGET ...]
set -euo pipefail
cd "$(dirname "$0")/.."

preset=$1
shift
# The GPU code is built where a GPU is, unless a setting says otherwise.
settings=(-DASTROLITH_CUDA=OFF)
nvidia-smi -L >/dev/null 2>&1 && settings=(-DASTROLITH_CUDA=ON)
while [[ ${1:-} == -D* ]]; do
  settings+=("$1")
  shift
done
if command -v ccache >/dev/null; then
  # Paths in the checkout count as relative ones. ccache keeps precompiled headers only with this sloppiness.
  export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros
  settings+=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  command -v nvcc >/dev/null && settings+=(-DCMAKE_CUDA_COMPILER_LAUNCHER=ccache)
fi
cmake --preset "$preset" "${settings[@]}" >/dev/null
targets=()
[[ $# -gt 0 ]] && targets=(--target "$@")
cmake --build "build/$preset" "${targets[@]}"
