#!/usr/bin/env python3
"""Finds lines and paragraphs of the documents that are too long to read. Prints one line each, and ends with status 1."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
LONGEST_LINE = 120  # characters
LONGEST_PARAGRAPH = 600  # characters without the addresses of links: five rendered lines


def paragraphs(lines):
    """Yields (number of the first line, text) of each paragraph and list item outside code, tables and headings."""
    first, words, in_code = 0, [], False
    for number, line in enumerate([*lines, ""], 1):
        fence = line.startswith("```")
        outside = in_code or fence or not line.strip() or line.startswith(("|", "#", "    "))
        if words and (outside or re.match(r"\s*([-*]|\d+\.) ", line)):
            yield first, " ".join(words)
            words = []
        in_code ^= fence
        if not outside:
            first = first if words else number
            words.append(line.strip())


def complaints(file):
    lines = file.read_text(encoding="utf-8").splitlines()
    for number, line in enumerate(lines, 1):
        if len(line) > LONGEST_LINE:
            yield f"{file.name}:{number}: a line of {len(line)} characters; break it at {LONGEST_LINE}"
    for number, text in paragraphs(lines):
        length = len(re.sub(r"\]\([^)]*\)", "]", text))
        if length > LONGEST_PARAGRAPH:
            yield f"{file.name}:{number}: a paragraph of {length} characters; break it at {LONGEST_PARAGRAPH}"


found = [line for file in sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")]) for line in complaints(file)]
print("\n".join(found), end="\n" if found else "")
sys.exit(1 if found else 0)
