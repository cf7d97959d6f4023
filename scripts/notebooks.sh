#!/usr/bin/env bash
# Executes the notebooks headless: notebooks.sh [--full] [--jobs N] [NN ...]
#   quick (default): small sizes, some minutes in all; results, figures and pages in build/notebooks/
#   --full:          the thesis's sizes, hours in all; the figures go to docs/figures/, the claims to docs/claims.md
#   --jobs N:        so many at a time (default 1: seconds that are measured want a machine of their own)
#   NN ...:          only the notebooks with these numbers, such as 01 12
# Installs what is missing, builds the programs, the benchmarks and the Python package. Says which notebooks failed; exit status 1 if any did.
set -euo pipefail
cd "$(dirname "$0")/.."

export ASTROLITH_FULL=0
jobs=1
numbers=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --full) ASTROLITH_FULL=1 ;;
    --jobs) jobs=${2:-}; shift || true; [[ $jobs =~ ^[1-9][0-9]*$ ]] || { echo "notebooks.sh: --jobs wants a number, such as 2" >&2; exit 2; } ;;
    [0-9][0-9]) numbers+=("$1") ;;
    *) echo "notebooks.sh: '$1' is neither --full, --jobs nor a notebook's two digits" >&2; exit 2 ;;
  esac
  shift || true
done

scripts/setup.sh --notebooks --python
scripts/fetch_data.sh
if [[ -z "${ASTROLITH_BIN:-}" ]]; then
  settings=(-DASTROLITH_BENCHMARKS=ON)
  # Without the Python package, the notebook that begins with it is skipped with a word.
  if scripts/python_venv.sh; then
    settings+=(-DASTROLITH_PYTHON=ON -DPython_EXECUTABLE="$PWD/build/python-venv/bin/python")
  fi
  scripts/build.sh release "${settings[@]}"
fi

out=${ASTROLITH_OUT:-$PWD/build/notebooks}
export ASTROLITH_OUT=$out
mkdir -p "$out/executed"
# Peers from the Python package index. Without it, the notebooks that need them are skipped with a word.
if ! cmp -s notebooks/requirements.txt "$out/venv/requirements.txt"; then
  rm -rf "$out/venv" "$out/venv.new"
  if /usr/bin/python3 -m venv --system-site-packages "$out/venv.new" &&
     "$out/venv.new/bin/pip" install -q -r notebooks/requirements.txt; then
    mv "$out/venv.new" "$out/venv"
    cp notebooks/requirements.txt "$out/venv/"
  else
    rm -rf "$out/venv.new"
    echo "notebooks.sh: the Python package index cannot be reached; notebooks that compare with its packages are skipped" >&2
  fi
fi
chosen=()
for notebook in notebooks/[0-9][0-9]_*.ipynb; do
  number=$(basename "$notebook" | cut -c1-2)
  [[ ${#numbers[@]} -eq 0 || " ${numbers[*]} " == *" $number "* ]] && chosen+=("$notebook")
done
[[ ${#chosen[@]} -gt 0 ]] || { echo "notebooks.sh: no notebook has such a number" >&2; exit 2; }

# Executes one; exit status 1 where it failed. Debian's interpreter, whose packages setup.sh installs: another python3 may stand
# before it in PATH.
execute() {
  local notebook=$1 name start=$SECONDS
  name=$(basename "$notebook" .ipynb)
  if PYTHONPATH="$PWD/notebooks:${ASTROLITH_BUILD:-$PWD/build/release}/python" /usr/bin/python3 -m nbconvert --to html --execute --ExecutePreprocessor.timeout=-1 \
       --output-dir "$out/executed" "$notebook" >"$out/executed/$name.log" 2>&1; then
    echo "$name: done in $((SECONDS - start)) s: $out/executed/$name.html"
  elif grep -q "^NotAtHand: " "$out/executed/$name.log"; then
    sed -n "s/^NotAtHand: /$name: skipped: /p" "$out/executed/$name.log" | tail -n 1
  else
    echo "$name: FAILED after $((SECONDS - start)) s:"
    tail -n 15 "$out/executed/$name.log" | sed 's/^/  /'
    return 1
  fi
}

failures=0
running=0
for notebook in "${chosen[@]}"; do
  if ((running == jobs)); then
    wait -n || failures=$((failures + 1))
    running=$((running - 1))
  fi
  execute "$notebook" &
  running=$((running + 1))
done
for ((; running > 0; --running)); do
  wait -n || failures=$((failures + 1))
done

if [[ $ASTROLITH_FULL == 1 ]]; then
  claims=docs/claims.md
  /usr/bin/python3 notebooks/claims_list.py "$out/claims_full" --keep docs/claims.md
else
  claims=$out/claims.md
  /usr/bin/python3 notebooks/claims_list.py "$out/claims" >"$claims"
fi
if ((failures > 0)); then
  echo "notebooks.sh: $failures of ${#chosen[@]} failed" >&2
  exit 1
fi
echo "All ${#chosen[@]} done; the list of claims is $claims"
