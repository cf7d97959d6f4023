#!/usr/bin/env python3
"""Runs clang-tidy (.clang-tidy) on the sources of the programs and libraries; any finding fails.

    lint.py                  all sources, in the groups of the preset lint, whose headers are read once a group
    lint.py --rooms ROOM ... the groups that hold a source of these rooms, such as geometry/io
    lint.py --but ROOM ...   all other groups
    lint.py --includes       compiles each source by itself, tests too, which tells a missing #include
    lint.py SOURCE ...       these sources alone

Nothing is built; the folder build/lint, or build/debug for single sources, is configured. A unity source includes its sources,
and what is included is to clang-tidy a header: the static analyzer passes it by, or analyses all headers of the system with it,
which takes two thirds of the time. So each group is written as one file that holds the text of its sources.

A group without findings is remembered by the hash of its preprocessed text, of .clang-tidy and of clang-tidy's version, in the
folder astrolith/clang-tidy of $XDG_CACHE_HOME (default ~/.cache), and is not checked again. Nothing else is remembered.
"""
import concurrent.futures
import hashlib
import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CACHE = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "astrolith/clang-tidy"
INCLUDED = re.compile(r'^#include "(/.*\.cpp)"', re.MULTILINE)
# CGAL's templates take clang-tidy more than six minutes. Whoever changes this source names it.
TOO_HEAVY = "tasks/repair/cgal_repair.cpp"


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


def digest(command):
    """The hash of all that clang-tidy's verdict on one file depends on; None where the file cannot be preprocessed."""
    words = [word for word in shlex.split(command["command"]) if word != "-c"]
    words = [word for word, before in zip(words, ["", *words]) if word != "-o" and before != "-o"]
    # -CC keeps comments, which may hold NOLINT; -P leaves out the names of folders.
    done = subprocess.run([*words, "-E", "-P", "-CC"], cwd=command["directory"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    if done.returncode != 0:
        return None
    version = subprocess.run(["clang-tidy-14", "--version"], stdout=subprocess.PIPE).stdout
    text = b"\0".join([version, (ROOT / ".clang-tidy").read_bytes(), done.stdout])
    return hashlib.sha256(text).hexdigest()


def findings(file, origins, commands):
    """What clang-tidy says of one file, with the names and lines of the sources; empty where it finds nothing."""
    entry = next(entry for entry in json.loads((Path(commands) / "compile_commands.json").read_text()) if entry["file"] == file)
    key = digest(entry)
    known = CACHE / key if key else None
    if known and known.exists():
        return ""
    done = subprocess.run(["clang-tidy-14", "--quiet", "-p", commands, file], cwd=ROOT, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True)  # fmt: skip
    if done.returncode == 0:
        if known:
            CACHE.mkdir(parents=True, exist_ok=True)
            known.touch()
        return ""
    # The count of warnings that were left out says nothing.
    said = "\n".join(line for line in done.stdout.splitlines() if not re.fullmatch(r"\d+ warnings? generated\.", line))
    said = said.strip() or f"{file}: clang-tidy ended with status {done.returncode} and said nothing"
    return re.sub(re.escape(file) + r":(\d+)", lambda place: origins[int(place[1]) - 1] if origins else place[0], said)


def is_of(rooms, file, origins):
    """Whether a file to check holds a source of these rooms or of the rooms inside them."""
    members = {Path(place.rsplit(":", 1)[0]) for place in origins} or {Path(file)}
    return any(member.is_relative_to(ROOT / room) for member in members for room in rooms)


def compiled_alone(entry):
    """What the compiler says of one source that no other source precedes; empty where it says nothing."""
    words = shlex.split(entry["command"])
    words = [word for word, before in zip(words, ["", *words]) if word != "-o" and before != "-o"]
    done = subprocess.run([*words, "-fsyntax-only"], cwd=entry["directory"], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True)  # fmt: skip
    return done.stdout.strip() if done.returncode != 0 else ""


def report(said):
    """Prints findings as they come; the number of files that have some, and of all."""
    count = failed = 0
    for words in said:
        count += 1
        if words:
            print(words, flush=True)
            failed += 1
    return failed, count


def main():
    if sys.argv[1:2] in (["-h"], ["--help"]):
        print(__doc__)
        return
    mode, names = (sys.argv[1], sys.argv[2:]) if sys.argv[1:2] and sys.argv[1].startswith("--") else ("", sys.argv[1:])
    if mode not in ("", "--rooms", "--but", "--includes"):
        sys.exit(f"lint.py: {mode} is none of --rooms, --but and --includes")
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        if mode == "--includes":
            entries = json.loads((configure("debug") / "compile_commands.json").read_text())
            written = [entry for entry in entries  # what a build makes is not there yet
                       if entry["file"].endswith(".cpp") and not Path(entry["file"]).is_relative_to(ROOT / "build")]  # fmt: skip
            failed, count = report(pool.map(compiled_alone, written))
        else:
            if names and not mode:
                sources = [str(Path(source).resolve()) for source in names]
                files, commands = {source: [] for source in sources}, configure("debug")
            else:
                files, commands = write_groups(configure("lint"))
                files.pop(str(ROOT / TOO_HEAVY), None)
            if mode:
                files = {file: origins for file, origins in files.items() if is_of(names, file, origins) == (mode == "--rooms")}
            # The largest first, so that none is left alone at the end.
            order = sorted(files, key=lambda file: -Path(file).stat().st_size)
            failed, count = report(pool.map(lambda file: findings(file, files[file], str(commands)), order))
    if failed or (count == 0 and not mode):
        sys.exit(f"lint.py: findings in {failed} of {count} files" if count else "lint.py: found no source to check")


if __name__ == "__main__":
    main()
