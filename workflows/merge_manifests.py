#!/usr/bin/env python3
"""Joins the manifests of ranges into one, sorted by member, and says what is missing.

    merge_manifests.py MEMBERS FOLDER -o manifest.jsonl     FOLDER holds one .jsonl file for each range
    merge_manifests.py MEMBERS FOLDER                       only checks, and prints the digest

Names of files become relative to the folder of the joined manifest. The digest is the SHA-256 of its lines without
`seconds` and `version`: sets with equal digests are equal in every byte of every file. Members beyond the first MEMBERS
are left out, which is said. Exit status 1 where members or their files are missing, where files have another size than
stated, or where members were made from several recipes, with several options or by several versions of the program.
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


def place(name):
    """The file without symbolic links on the way to it, so that `..` leads where the system goes."""
    folder, file = os.path.split(name)
    return os.path.join(os.path.realpath(folder), file)


def moved(entry, old_folder, new_folder):
    for file in entry["files"]:
        file["name"] = pathlib.PurePath(os.path.relpath(place(old_folder / file["name"]), new_folder)).as_posix()
    return entry


def damaged(entry, folder):
    """The first file of a member that is not there with the stated size; none where all are."""
    for file in entry["files"]:
        name = folder / file["name"]
        if not name.is_file() or name.stat().st_size != file["bytes"]:
            return str(name)
    return None


def digest(entries):
    sha = hashlib.sha256()
    for member in sorted(entries):
        stated = {key: value for key, value in entries[member].items() if key not in ("seconds", "version")}
        sha.update(json.dumps(stated, sort_keys=True).encode() + b"\n")
    return sha.hexdigest()


def write_whole(text, file):
    mask = os.umask(0)
    os.umask(mask)
    with tempfile.NamedTemporaryFile("w", dir=file.parent, delete=False, encoding="utf-8") as new:
        new.write(text)
    os.chmod(new.name, 0o666 & ~mask)  # as any other new file
    os.replace(new.name, file)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("members", type=int)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path)
    given = parser.parse_args()
    folder = pathlib.Path(os.path.realpath(given.folder))
    target = pathlib.Path(place((given.output or folder.parent / "manifest.jsonl").absolute()))
    entries = {}
    for manifest in sorted(folder.glob("*.jsonl")):
        for member, entry in entries_of(manifest).items():
            entries[member] = moved(entry, folder, target.parent)
    beyond = [member for member in entries if not 0 <= member < given.members]
    for member in beyond:
        del entries[member]
    if beyond:
        print(f"{len(beyond)} members beyond the first {given.members} are left out", file=sys.stderr)
    missing = [member for member in range(given.members) if member not in entries]
    if missing:
        print(f"{len(missing)} of {given.members} members are missing, the first is {missing[0]}", file=sys.stderr)
        return 1
    lost = {member: file for member in sorted(entries) if (file := damaged(entries[member], target.parent))}
    if lost:
        first = next(iter(lost))
        print(f"the files of {len(lost)} members are missing or cut short, the first is {lost[first]} of member {first}; "
              "give the command that made them once more", file=sys.stderr)
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
