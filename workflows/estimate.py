#!/usr/bin/env python3
"""Says what a set of bodies will take, from its first members, which are made in a folder that goes away.

    estimate.py family.json --members 10000 [--options "--resolution 64"] [--program synth]
      --minutes 10            how many members fill a job of so many minutes
      --most-gigabytes 500    exit status 1 where the set would take more, before anything is made
      --most-hours 48         the same for hours of one processor
  --keep meshes           what is kept of a member: meshes, packed (meshes compressed by Zstandard) or recipes

Prints JSON: `seconds` of a processor and `bytes` of a member, `hours` of one processor and `gigabytes` of all, and
`members_per_job`.
"""
import argparse
import hashlib
import json
import pathlib
import resource
import shlex
import subprocess
import sys
import tempfile

TRIED = 8  # members that are made
KEPT = {"meshes": ("-o", ".ply"), "packed": ("-o", ".ply.zst"), "recipes": ("--write-recipe", ".astro")}
OUTPUTS = {"--preview": ".png", "--feature-list": ".csv", "--write-recipe": ".json", "--preview-maps": ".npz",
           "--height-map": ".tif", "--hazard-map": ".tif", "--sheet": ".png", "--summary": ".json"}
OF_ALL = {"--sheet", "--summary"}  # one file for all members


def moved(options, folder):
    """The options with their outputs in the folder, so that nothing is written into the set itself."""
    words = []
    for word in shlex.split(options):
        option, equals, value = word.partition("=")
        words += [option, value] if equals and option in OUTPUTS else [word]
    for place, word in enumerate(words[:-1]):
        if word in OUTPUTS:
            name = word.strip("-") if word in OF_ALL else "{member}"
            words[place + 1] = f"{folder}/{name}{pathlib.PurePath(words[place + 1]).suffix or OUTPUTS[word]}"
    return words


def tried_members(program, recipe, members, keep, options):
    """The lines of the manifest of the first members, and the processor seconds that these took."""
    with tempfile.TemporaryDirectory() as folder:
        manifest = pathlib.Path(folder, "tried.jsonl")
        option, ending = KEPT[keep]
        command = [program, recipe, "--members", f"0:{min(TRIED, members)}", "--threads", "1",
                   "--quiet", "--manifest", str(manifest), option, f"{folder}/{{member}}{ending}",
                   *moved(options, folder)]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        try:
            status = subprocess.run(command, check=False).returncode
        except OSError as error:
            sys.exit(f"estimate.py: {program}: cannot be run ({error.strerror}); name it by --program, or put it "
                     "into PATH")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        lines = manifest.read_text().splitlines() if manifest.exists() else []
        if not lines:
            sys.exit(status or 1)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return [json.loads(line) for line in lines], seconds


def of_member(program, recipe, members, keep, options, kept=None):
    """The processor seconds and the bytes of a member. A file `kept` remembers them for what was asked."""
    content = pathlib.Path(recipe)  # or a word that names a body of the library
    asked = {"recipe": hashlib.sha256(content.read_bytes()).hexdigest() if content.is_file() else recipe,
             "program": program, "keep": keep, "options": options}
    if kept is not None and kept.exists():
        try:
            remembered = json.loads(kept.read_text())
            if remembered["asked"] == asked:
                return float(remembered["seconds"]), float(remembered["bytes"])
        except (ValueError, KeyError, TypeError):
            pass  # of an earlier version, or cut short
    entries, all_seconds = tried_members(program, recipe, members, keep, options)
    seconds = all_seconds / len(entries)
    size = sum(file["bytes"] for entry in entries for file in entry["files"]) / len(entries)
    if kept is not None:
        kept.parent.mkdir(parents=True, exist_ok=True)
        kept.write_text(json.dumps({"asked": asked, "seconds": seconds, "bytes": size}) + "\n")
    return seconds, size


def of_set(seconds, size, members, minutes):
    """What a set takes whose members take so many seconds and bytes."""
    return {
        "seconds": round(seconds, 4),
        "bytes": round(size),
        "hours": float(f"{seconds * members / 3600:.4g}"),
        "gigabytes": float(f"{size * members / 1e9:.4g}"),
        "members_per_job": max(1, min(members, int(60 * minutes / max(seconds, 1e-9)))),
    }


def refusal(taken, most):
    """Why a set that takes `taken` is refused; empty where it keeps the limits, by the figures that they limit."""
    for figure, limit in most.items():
        if limit is not None and taken[figure] > limit:
            return (f"the set would take {taken[figure]:g} {figure}, above {limit:g}; make fewer or smaller members, or "
                    "keep recipes instead of meshes")
    return ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recipe")
    parser.add_argument("--members", type=int, required=True)
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--most-gigabytes", type=float)
    parser.add_argument("--most-hours", type=float)
    parser.add_argument("--program", default="synth")
    parser.add_argument("--options", default="")
    parser.add_argument("--keep", choices=sorted(KEPT), default="meshes")
    given = parser.parse_args()
    taken = of_set(*of_member(given.program, given.recipe, given.members, given.keep, given.options), given.members,
                   given.minutes)
    print(json.dumps(taken))
    refused = refusal(taken, {"gigabytes": given.most_gigabytes, "hours": given.most_hours})
    if refused:
        print(f"estimate.py: {refused}", file=sys.stderr)
    return 1 if refused else 0


if __name__ == "__main__":
    sys.exit(main())
