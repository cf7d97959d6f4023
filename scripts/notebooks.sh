#!/usr/bin/env bash
# Executes the notebooks headless: notebooks.sh [--full] [NN ...]
#   quick (default): small sizes, some minutes in all; results, figures and pages in build/notebooks/
#   --full:          the thesis's sizes, much longer; the figures go to docs/figures/ and the table of claims to docs/claims.md
#   NN ...:          only the notebooks with these numbers, such as 01 12
# Installs what is missing, builds the programs and benchmarks. Says which notebooks failed; exit status 1 if any did.
set -euo pipefail
cd "$(dirname "$0")/.."

export ASTROLITH_FULL=0
numbers=()
for argument in "$@"; do
  case $argument in
    --full) ASTROLITH_FULL=1 ;;
    [0-9][0-9]) numbers+=("$argument") ;;
    *) echo "notebooks.sh: '$argument' is neither --full nor a notebook's two digits" >&2; exit 2 ;;
  esac
done

scripts/setup.sh --notebooks
scripts/fetch_data.sh
if [[ -z "${ASTROLITH_BIN:-}" ]]; then
  cmake --preset release -DASTROLITH_BENCHMARKS=ON >/dev/null
  scripts/build.sh release
fi

out=${ASTROLITH_OUT:-$PWD/build/notebooks}
export ASTROLITH_OUT=$out
mkdir -p "$out/executed"
# Peers from the Python package index. Without it, the notebooks that need them are skipped with a word.
if [[ ! -x $out/venv/bin/python ]]; then
  rm -rf "$out/venv"
  if /usr/bin/python3 -m venv --system-site-packages "$out/venv.new" &&
     "$out/venv.new/bin/pip" install -q -r notebooks/requirements.txt; then
    mv "$out/venv.new" "$out/venv"
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

failed=()
for notebook in "${chosen[@]}"; do
  name=$(basename "$notebook" .ipynb)
  echo "$name"
  start=$SECONDS
  # Debian's interpreter, whose packages setup.sh installs; another python3 may stand before it in PATH.
  if PYTHONPATH=notebooks /usr/bin/python3 -m nbconvert --to html --execute --ExecutePreprocessor.timeout=-1 \
       --output-dir "$out/executed" "$notebook" >"$out/executed/$name.log" 2>&1; then
    echo "  done in $((SECONDS - start)) s: $out/executed/$name.html"
  elif grep -q "^NotAtHand: " "$out/executed/$name.log"; then
    sed -n 's/^NotAtHand: /  skipped: /p' "$out/executed/$name.log" | tail -n 1
  else
    echo "  FAILED after $((SECONDS - start)) s:"
    tail -n 15 "$out/executed/$name.log" | sed 's/^/  /'
    failed+=("$name")
  fi
done

/usr/bin/python3 notebooks/claims_table.py "$out/claims" >"$out/claims.md"
[[ $ASTROLITH_FULL == 1 && ${#numbers[@]} -eq 0 ]] && cp "$out/claims.md" docs/claims.md
if [[ ${#failed[@]} -gt 0 ]]; then
  echo "notebooks.sh: failed: ${failed[*]}" >&2
  exit 1
fi
echo "All ${#chosen[@]} done; the table of claims is $out/claims.md"
