#!/usr/bin/env python3
"""Runs clang-tidy (.clang-tidy) on the sources of the programs and libraries; any finding fails.

    lint.py                 all sources
    lint.py --includes K/N  compiles every Nth source by itself instead, tests too, which tells a missing #include

Nothing is built; build/lint or build/debug is configured. clang-tidy reads the groups of sources that the preset lint
compiles as one, since that reads their headers once. To clang-tidy what is included is a header, which its static
analyzer passes by, so each group is written as one file that holds the text of its sources.
"""
import concurrent.futures
import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# CGAL takes clang-tidy more than six minutes each.
TOO_HEAVY = ("tasks/repair/cgal_repair.cpp", "tasks/repair/cgal_union.cpp")


def run(words, where=ROOT):
    return subprocess.run(words, cwd=where, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)


def commands_of(preset):
    """The compiler's commands for all sources that somebody wrote, in a configured build folder."""
    done = run(["cmake", "--preset", preset])
    if done.returncode != 0:
        sys.exit(f"lint.py: cmake --preset {preset} failed:\n{done.stdout}")
    return json.loads((ROOT / "build" / preset / "compile_commands.json").read_text())


def members_of(source):
    """The sources that a file to compile stands for."""
    included = re.findall(r'^#include "(/.*\.cpp)"', source.read_text(), re.MULTILINE) if source.stem.startswith("unity_") else [source]
    return [Path(member) for member in included if ROOT / "build" not in Path(member).parents]


def write_groups(folder):
    """Writes one file for each group, and their commands. Returns for each the sources and lines that its lines come from."""
    groups, entries = {}, []
    folder.mkdir(parents=True, exist_ok=True)
    for entry in commands_of("lint"):
        source = Path(entry["file"])
        parts = source.relative_to(ROOT).parts
        if source.suffix not in (".cpp", ".cxx") or "tests" in parts or source in [ROOT / heavy for heavy in TOO_HEAVY]:
            continue
        group = folder / "_".join(parts[1:] if parts[0] == "build" else parts)
        lines = [(f"{member}:{number}", line) for member in members_of(source) if member.is_file()
                 for number, line in enumerate(member.read_text().splitlines(), 1)]  # fmt: skip
        if lines:
            group.write_text("\n".join(line for _, line in lines) + "\n")
            groups[group] = [place for place, _ in lines]
            entries.append(dict(entry, file=str(group), command=entry["command"].replace(str(source), str(group))))
    (folder / "compile_commands.json").write_text(json.dumps(entries))
    return groups


def findings(group, origins):
    """What clang-tidy says of one group, with the names and lines of its sources; empty where it finds nothing."""
    done = run(["clang-tidy-14", "--quiet", "-p", str(group.parent), str(group)])
    if done.returncode == 0:
        return ""
    said = re.sub(re.escape(str(group)) + r":(\d+)", lambda place: origins[int(place[1]) - 1], done.stdout)
    return said.strip() or f"{group}: clang-tidy ended with status {done.returncode} and said nothing"


def compiled_alone(entry):
    """What the compiler says of one source that no other source precedes; empty where it says nothing."""
    words = re.sub(r" -o \S+", "", entry["command"])
    done = run([*shlex.split(words), "-fsyntax-only"], entry["directory"])
    return done.stdout.strip() if done.returncode != 0 else ""


def main():
    part = re.fullmatch(r"--includes (\d+)/([1-9]\d*)", " ".join(sys.argv[1:]))
    if sys.argv[1:] and not part:
        sys.exit(__doc__)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        if part:
            entries = [entry for entry in commands_of("debug") if entry["file"].endswith(".cpp") and members_of(Path(entry["file"]))]
            said = pool.map(compiled_alone, entries[int(part[1]) % int(part[2])::int(part[2])])
        else:
            groups = write_groups(ROOT / "build/lint/groups")
            # The largest first, so that none is left alone at the end.
            said = pool.map(lambda group: findings(group, groups[group]), sorted(groups, key=lambda group: -group.stat().st_size))
        failed = 0
        for words in filter(None, said):
            print(words, flush=True)
            failed += 1
    if failed:
        sys.exit(f"lint.py: findings in {failed} files")


if __name__ == "__main__":
    main()
