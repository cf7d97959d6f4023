#!/usr/bin/env python3
"""The version of CMakeLists.txt and the date of CHANGELOG.md, in every file that states them.

version.py          writes them
version.py --check  ends with status 1, and a line for each file that states another version or date
"""
import datetime
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# The file, what stands before and behind, and whether it is the version, its numbers or the date.
PLACES = [
    ("CITATION.cff", r"^version: ()", r"$", "version"),
    ("CITATION.cff", r"^date-released: ()", r"$", "date"),
    ("codemeta.json", r'"version": "', r'"', "version"),
    ("codemeta.json", r'"datePublished": "', r'"', "date"),
    ("packaging/conda/meta.yaml", r'set version = "', r'"', "version"),
    ("paper/paper.md", r"^date: ()", r"$", "words"),
    ("python/blender/astrolith_addon/blender_manifest.toml", r'^version = "', r'"', "version"),
    ("python/blender/astrolith_addon/__init__.py", r'"version": \(', r"\)", "numbers"),
]


def main():
    version = re.search(r"project\(astrolith VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
    newest = re.search(r"^## \[?([0-9.]+)\]?[^0-9]*([0-9-]+)?", (ROOT / "CHANGELOG.md").read_text(), re.M)
    faults = [] if newest[1] == version else [f"CHANGELOG.md: begins with {newest[1]}, and CMakeLists.txt states {version}"]
    if newest[2] is None:
        sys.exit("CHANGELOG.md: its newest version has no date such as 2026-11-29")
    day = datetime.date.fromisoformat(newest[2])
    values = {"version": version, "numbers": version.replace(".", ", "), "date": newest[2], "words": f"{day.day} {day:%B %Y}"}
    for name, before, behind, kind in PLACES:
        file = ROOT / name
        text = file.read_text(encoding="utf-8")
        place = re.search(rf"({before})(.*?)({behind})", text, re.M)
        if place is None:
            faults.append(f"{name}: states no {kind} where {before!r} is looked for")
            continue
        start = place.end(1)
        end = text.index("\n", start) if behind == "$" else text.index(behind.replace("\\", ""), start)
        if text[start:end] != values[kind] and sys.argv[1:] == ["--check"]:
            faults.append(f"{name}: states {text[start:end]} for {values[kind]}; run scripts/version.py")
        elif text[start:end] != values[kind]:
            file.write_text(text[:start] + values[kind] + text[end:], encoding="utf-8")
    print("\n".join(faults), end="\n" if faults else "")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
