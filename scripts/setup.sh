#!/usr/bin/env bash
# Installs the packages that are missing to build and test Astrolith on Debian 12. Where none is missing, it needs no rights.
set -euo pipefail

packages=(
  build-essential cmake ninja-build pkg-config python3
  libtbb-dev libeigen3-dev nlohmann-json3-dev libvalijson-dev libssl-dev libfmt-dev libcli11-dev
  libembree-dev libopenmesh-dev libtinygltf-dev libnanoflann-dev libpng-dev libspng-dev libtiff-dev libcairo2-dev libzip-dev libzstd-dev zlib1g-dev
  libgtest-dev
)
fitting=(libceres-dev libnlopt-dev libnlopt-cxx-dev libopencv-dev libgdal-dev libfftw3-dev libspectra-dev libcgal-dev)
# --synth leaves out the packages of the fits. --format and --lint add what checks the sources, --sanitizers the compiler of
# sanitized builds, --package what makes a Debian package, --python what builds the Python package, --browser what opens the
# pages of reports in a test, --fuzz what builds the fuzzers, --web what builds the page that makes bodies, --engines what tests
# of assets load them in, --site what builds the site of the documents, --wheel what builds wheels and tries them in a bare
# system, --arm64 what builds and runs programs of arm64, and --notebooks the packages of the notebooks.
for option in "$@"; do
  case $option in
    --synth) fitting=() ;;
    --format) packages+=(clang-format-14) ;;
    --lint) packages+=(clang-tidy-14 clang-14) ;;
    --package) packages+=(help2man dpkg-dev) ;;
    --browser) packages+=(chromium chromium-driver python3-selenium python3-numpy python3-pil) ;;
    --sanitizers) packages+=(clang-14 libclang-rt-14-dev) ;;
    --fuzz) packages+=(clang-14 libclang-rt-14-dev llvm-14) ;;
    --engines) packages+=(blender godot3-server) ;;
    --web) packages+=(emscripten nodejs) ;;
    --python) packages+=(python3-dev python3-venv) ;;
    --wheel) packages+=(python3-dev python3-venv dpkg-dev make unzip mmdebstrap fonts-dejavu-core) ;;
    --arm64) packages+=(clang-14 g++-aarch64-linux-gnu qemu-user-static mmdebstrap) ;;
    --site) packages+=(doxygen libjs-katex python3-venv git) ;;
    --notebooks) packages+=(python3-nbconvert python3-ipykernel python3-venv python3-numpy python3-scipy python3-matplotlib python3-sklearn python3-torch libegl1) ;;
    *) echo "setup.sh: unknown option $option" >&2; exit 2 ;;
  esac
done

packages+=("${fitting[@]}")
missing=()
for package in "${packages[@]}"; do
  [[ "$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null)" == "install ok installed" ]] || missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] && exit 0

as_root=()
if [[ $EUID -ne 0 ]]; then
  command -v sudo >/dev/null || { echo "setup.sh: run as root (or install sudo): these packages are missing: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "Installing ${#missing[@]} Debian packages: ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
