#!/usr/bin/env bash
# Makes the virtual environment build/python-venv with what the Python package is built and tested with. Debian's Python
# installs nothing outside one. Exit status 3 and a word where the Python package index cannot be reached.
set -euo pipefail
cd "$(dirname "$0")/.."

venv=build/python-venv
cmp -s python/requirements.txt "$venv/requirements.txt" && exit 0
mkdir -p build
rm -rf "$venv" "$venv.new"
/usr/bin/python3 -m venv "$venv.new"
if ! "$venv.new/bin/pip" install -q --disable-pip-version-check -r python/requirements.txt; then
  rm -rf "$venv.new"
  echo "python_venv.sh: the Python package index cannot be reached; the Python package is left out" >&2
  exit 3
fi
mv "$venv.new" "$venv"
cp python/requirements.txt "$venv/"
