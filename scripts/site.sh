#!/usr/bin/env bash
# The site of the documents, of the Python package and of the C++ headers, with the page of the browser as its first screen.
#   site.sh          builds build/site/html, which needs no network, and checks it: dead links, long pages, docstrings
#   site.sh serve    also serves it at http://127.0.0.1:8056 until Ctrl-C
# Takes the Python package of ASTROLITH_BUILD (default build/release), which it builds where it is not there, and the page of
# build/web where scripts/web.sh build has made it. Exit status 3 and a word where the Python package index is not reached.
set -euo pipefail
cd "$(dirname "$0")/.."
case "${1:-}" in "" | serve) ;; *) sed -n '2,6s/^# *//p' "$0" >&2; exit 2 ;; esac

scripts/setup.sh --synth --site
venv=build/site-venv
if ! cmp -s docs/site/requirements.txt "$venv/requirements.txt"; then
  rm -rf "$venv"
  /usr/bin/python3 -m venv "$venv"
  if ! "$venv/bin/pip" install -q --disable-pip-version-check -r docs/site/requirements.txt 2>"$venv/pip.log"; then
    cat "$venv/pip.log" >&2
    grep -qE 'connection broken by|NewConnectionError|ConnectTimeout|NameResolutionError|ProxyError' "$venv/pip.log" || exit 1
    echo "site.sh: the Python package index cannot be reached, which has MkDocs and its theme" >&2
    exit 3
  fi
  cp docs/site/requirements.txt "$venv/"
fi
build=${ASTROLITH_BUILD:-build/release}
if ! ls "$build"/python/astrolith/_estimation.*.so >/dev/null 2>&1; then
  scripts/setup.sh --python
  scripts/python_venv.sh
  scripts/build.sh release -DASTROLITH_PYTHON=ON -DPython_EXECUTABLE="$PWD/build/python-venv/bin/python" python/all
fi

/usr/bin/python3 docs/site/pages.py build/site
PYTHONPATH=$build/python NO_MKDOCS_2_WARNING=1 "$venv/bin/mkdocs" build --quiet --strict --config-file docs/site/mkdocs.yml
doxygen docs/site/Doxyfile
/usr/bin/python3 docs/site/check.py build/site
[[ ${1:-} != serve ]] || { echo "http://127.0.0.1:8056 (Ctrl-C ends it)"; exec python3 -m http.server --bind 127.0.0.1 --directory build/site/html 8056; }
