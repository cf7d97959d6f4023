#!/usr/bin/env bash
# The page that makes bodies in a browser (web/).
#   web.sh            builds it and serves it at http://127.0.0.1:8055 until Ctrl-C
#   web.sh build      builds build/web/page.html, one file that needs no other and no network
#   web.sh install    also puts it where the programs of PREFIX (default /usr/local) look for it: synth --page
#   web.sh test SYNTH tests the core in node, and the page in a headless Chromium, against the program synth
set -euo pipefail
cd "$(dirname "$0")/.."

# Debian's emscripten asks node for packages that only Debian's node finds by itself.
export NODE_PATH=${NODE_PATH:-/usr/share/nodejs}
build() {
  scripts/setup.sh --synth --web
  scripts/build.sh web
}

case ${1:-} in
  "")
    build
    echo "http://127.0.0.1:8055/page.html (Ctrl-C ends it)"
    exec python3 -m http.server --bind 127.0.0.1 --directory build/web 8055
    ;;
  build) build ;;
  install)
    build
    cmake --install build/web --prefix "${PREFIX:-/usr/local}"
    ;;
  test)
    synth=${2:?web.sh: name the program synth}
    build
    node tests/web/fresh_values_test.js build/web/web/core
    node tests/web/core_test.js build/web/web/core "$synth"
    status=0
    /usr/bin/python3 tests/web/page_test.py build/web/page.html "$synth" || status=$?
    [[ $status -eq 77 ]] || exit "$status"
    ;;
  *) sed -n '2,6s/^# *//p' "$0" >&2; exit 2 ;;
esac
