#!/usr/bin/env bash
# Fills data-cache/ with real input from two Debian packages, which are downloaded and unpacked, not installed:
# gravel.png (a CC0 photo, python3-skimage) and 16 small bodies as .bmf shape models (openuniverse-common).
# Does nothing, and needs no network, when all is there; needs no root rights where apt knows the packages.
set -euo pipefail
cd "$(dirname "$0")/.."

cache=$PWD/data-cache
bodies=(amalthea bacchus castalia deimos epimetheus gaspra geographos hyperion ida janus ky phobos prometheus
        proteus toutatis vesta)

missing=0
for file in gravel.png "${bodies[@]/%/.bmf}"; do
  [[ -s "$cache/$file" ]] || missing=$((missing + 1))
done
if [[ $missing -eq 0 ]]; then
  echo "fetch_data.sh: data-cache/ is complete"
  exit 0
fi

fail() {
  echo "fetch_data.sh: $1" >&2
  exit 1
}
for tool in apt-get dpkg-deb; do
  command -v "$tool" >/dev/null || fail "$tool is missing: on a system without it, tests that need data-cache/ are skipped"
done

mkdir -p "$cache"
work=$(mktemp -d "$cache/.fetch.XXXXXX")
trap 'rm -rf "$work"' EXIT

# apt-get runs its downloads as another user when it can; "unsandboxed" warnings go to the log.
download() { (cd "$work" && apt-get download -qq python3-skimage openuniverse-common) >"$work/log" 2>&1; }
if ! download; then
  # A bare image has no package lists yet.
  as_root=()
  [[ $EUID -eq 0 ]] || as_root=(sudo)
  "${as_root[@]}" apt-get update -qq >>"$work/log" 2>&1 || true
  download || fail "cannot download python3-skimage and openuniverse-common; connect to a Debian mirror and run 'apt-get update' as root; apt-get said: $(tail -n 1 "$work/log")"
fi

for package in "$work"/*.deb; do
  dpkg-deb -x "$package" "$work/unpacked" || fail "$(basename "$package") is damaged; run this script again"
done

# One rename a file: an interrupted run never leaves half a file under its final name.
take() {
  local found
  found=$(find "$work/unpacked" -type f -ipath "*$1" -print -quit)
  [[ -n "$found" ]] || fail "the downloaded packages hold no $1; this script was written for Debian 12"
  chmod 644 "$found"
  mv -f "$found" "$cache/$2"
}
take /skimage/data/gravel.png gravel.png
for body in "${bodies[@]}"; do
  take "/3dmodels/$body.bmf" "$body.bmf"
done
echo "fetch_data.sh: data-cache/ now holds gravel.png and ${#bodies[@]} bodies"
