#!/usr/bin/env python3
"""Writes docs/summaries.md from apps/summary_fields.json.

summary_reference.py          rewrites docs/summaries.md
summary_reference.py --check  exit status 1, and a word, where docs/summaries.md is not what it would write
"""
import json
import pathlib
import sys

from narrow_table import narrow_table

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/summaries.md"
HEAD = """# What summaries and feature lists say

Every program writes the figures of its run as JSON with `--summary FILE.json`. This page names every field of them,
and of the list of landforms that `synth --feature-list` writes. `scripts/summary_reference.py` makes it from
`apps/summary_fields.json`, and a test holds both to what the programs write.

A dot leads into an object and `[]` into each element of a list; `*` stands for any name. A field that does not apply
to a run is absent. A field without a unit is a number, a word, or true or false.
"""
CSV = """
A list that ends in `.csv` has the columns of `features[]`, and `length_unit` in each row.
"""


def page(programs):
    text = HEAD
    for program, fields in programs.items():
        text += f"\n## {program}\n\n| field | meaning | unit |\n|---|---|---|\n"
        text += narrow_table(([f"`{path}`", meaning, unit] for path, (unit, meaning) in fields.items()), shortened=1)
    return text + CSV


def main():
    text = page(json.loads((ROOT / "apps/summary_fields.json").read_text()))
    if "--check" in sys.argv[1:]:
        if PAGE.read_text() != text:
            print("docs/summaries.md differs from apps/summary_fields.json; run scripts/summary_reference.py")
            return 1
        return 0
    PAGE.write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
