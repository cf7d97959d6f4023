#!/usr/bin/env bash
# The checks of this project, in two depths. scripts/check_plan.toml says which check runs when.
#   check.sh quick      what every change must pass
#   check.sh slice K    one of the slices that are, together, everything that `quick` is not
#   check.sh all        everything; before a version is dated in CHANGELOG.md
#   check.sh plan       prints the plan; with `--hold BUILD` fails where it leaves out a check or a test case of a build
set -euo pipefail
cd "$(dirname "$0")/.."
command -v python3 >/dev/null || { echo "check.sh: python3 is missing; install it (Debian: apt install python3)" >&2; exit 2; }
exec python3 scripts/check.py "$@"
