#!/usr/bin/env python3
"""Joins the manifests of ranges into one, sorted by member, and says what is missing.

    merge_manifests.py MEMBERS FOLDER -o manifest.jsonl     FOLDER holds one .jsonl file for each range
    merge_manifests.py MEMBERS FOLDER                       only checks, and prints the digest

Names of files become relative to the folder of the joined manifest. The digest is the SHA-256 of its lines without
`seconds` and `version`: sets with equal digests are equal in every byte of every file. Exit status 1 where members are
missing, or were made from several recipes, with several options or by several versions of the program.
"""
import argparse
import hashlib
import json
import os
import pathlib
import sys
import tempfile


def entries_of(manifest):
    """The lines of one manifest by member; the last of a member counts, and lines cut short are passed over."""
    entries = {}
    for line in manifest.read_text(encoding="utf-8", errors="replace").splitlines():
        try:
            entry = json.loads(line)
            entries[int(entry["member"])] = entry
        except (ValueError, KeyError, TypeError):
            print(f"{manifest}: a line cut short is passed over", file=sys.stderr)
    return entries


def moved(entry, old_folder, new_folder):
    for file in entry["files"]:
        file["name"] = pathlib.PurePath(os.path.relpath(old_folder / file["name"], new_folder)).as_posix()
    return entry


def digest(entries):
    sha = hashlib.sha256()
    for member in sorted(entries):
        stated = {key: value for key, value in entries[member].items() if key not in ("seconds", "version")}
        sha.update(json.dumps(stated, sort_keys=True).encode() + b"\n")
    return sha.hexdigest()


def write_whole(text, file):
    with tempfile.NamedTemporaryFile("w", dir=file.parent, delete=False, encoding="utf-8") as new:
        new.write(text)
    os.replace(new.name, file)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("members", type=int)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path)
    given = parser.parse_args()
    target = (given.output or given.folder.parent / "manifest.jsonl").absolute()
    entries = {}
    for manifest in sorted(given.folder.glob("*.jsonl")):
        for member, entry in entries_of(manifest).items():
            entries[member] = moved(entry, given.folder.absolute(), target.parent)
    missing = [member for member in range(given.members) if member not in entries]
    if missing:
        print(f"{len(missing)} of {given.members} members are missing, the first is {missing[0]}", file=sys.stderr)
        return 1
    for field in ("family", "version"):
        stated = sorted({str(entry.get(field)) for entry in entries.values()})
        if len(stated) > 1:
            print(f"members of several sets: {field} is {' and '.join(stated[:2])}", file=sys.stderr)
            return 1
    if given.output:
        write_whole("".join(json.dumps(entries[m]) + "\n" for m in sorted(entries)), target)
    print(f"{len(entries)} members, digest {digest(entries)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
