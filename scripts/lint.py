#!/usr/bin/env python3
"""Runs clang-tidy (.clang-tidy) on the sources of the programs and libraries; any finding fails.

    lint.py             all sources, in the groups of the preset lint, whose headers are read once a group
    lint.py SOURCE ...  these sources alone

Nothing is built; the folder build/lint, or build/debug for single sources, is configured. A unity source includes its sources,
and what is included is to clang-tidy a header: the static analyzer passes it by, or analyses all headers of the system with it,
which takes two thirds of the time. So each group is written as one file that holds the text of its sources.
"""
import concurrent.futures
import json
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
INCLUDED = re.compile(r'^#include "(/.*\.cpp)"', re.MULTILINE)


def configure(preset):
    """The folder of a preset, configured."""
    done = subprocess.run(["cmake", "--preset", preset], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"lint.py: cmake --preset {preset} failed:\n{done.stdout}")
    return ROOT / "build" / preset


def write_group(group, members):
    """Writes the members' text one after another; returns for each line of the group its source and line."""
    origins, text = [], []
    for member in members:
        lines = member.read_text().splitlines()
        text += lines
        origins += [f"{member}:{number}" for number in range(1, len(lines) + 1)]
    group.write_text("\n".join(text) + "\n")
    return origins


def write_groups(build):
    """The files to check, each with the origins of its lines (none where it is itself a source), and the folder of their commands.

    The tests, and the sources that a build generates, are left out.
    """
    folder = build / "groups"
    folder.mkdir(exist_ok=True)
    entries, files = [], {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        source, origins = Path(entry["file"]), []
        if source.suffix not in (".cpp", ".cxx") or any(source.is_relative_to(base / "tests") for base in (ROOT, build)):
            continue
        if source.stem.startswith("unity_"):
            members = [member for member in map(Path, INCLUDED.findall(source.read_text())) if member.is_file()]
            if not members:
                continue
            target, number = source.parts[-3].removesuffix(".dir"), source.stem.split("_")[1]
            group = folder / f"{target}_{number}.cpp"
            origins = write_group(group, members)
            entry = dict(entry, file=str(group), command=entry["command"].replace(str(source), str(group)))
        files[entry["file"]] = origins
        entries.append(entry)
    (folder / "compile_commands.json").write_text(json.dumps(entries, indent=1))
    return files, folder


def findings(file, origins, commands):
    """What clang-tidy says of one file, with the names and lines of the sources; empty where it finds nothing."""
    done = subprocess.run(["clang-tidy-14", "--quiet", "-p", commands, file], cwd=ROOT, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True)  # fmt: skip
    if done.returncode == 0:
        return ""
    # The count of warnings that were left out says nothing.
    said = "\n".join(line for line in done.stdout.splitlines() if not re.fullmatch(r"\d+ warnings? generated\.", line))
    said = said.strip() or f"{file}: clang-tidy ended with status {done.returncode} and said nothing"
    return re.sub(re.escape(file) + r":(\d+)", lambda place: origins[int(place[1]) - 1] if origins else place[0], said)


def main():
    if sys.argv[1:2] in (["-h"], ["--help"]):
        print(__doc__)
        return
    sources = [str(Path(source).resolve()) for source in sys.argv[1:]]
    if sources:
        files, commands = {source: [] for source in sources}, configure("debug")
    else:
        files, commands = write_groups(configure("lint"))
    # The largest first, so that none is left alone at the end.
    order = sorted(files, key=lambda file: -Path(file).stat().st_size)
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for said in pool.map(lambda file: findings(file, files[file], str(commands)), order):
            if said:
                print(said, flush=True)
                failed += 1
    if not files or failed:
        sys.exit(f"lint.py: findings in {failed} of {len(files)} files" if files else "lint.py: found no source to check")


if __name__ == "__main__":
    main()
