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
import json
import pathlib
import resource
import shlex
import subprocess
import sys
import tempfile

TRIED = 8  # members that are made
KEPT = {"meshes": ("-o", ".ply"), "packed": ("-o", ".ply.zst"), "recipes": ("--write-recipe", ".astro")}
OUTPUTS = {"--preview": ".png", "--feature-list": ".csv", "--write-recipe": ".json", "--preview-maps": ".npz"}


def moved(options, folder):
    """The options with their outputs in the folder, so that nothing is written into the set itself."""
    words = shlex.split(options)
    for place, word in enumerate(words[:-1]):
        if word in OUTPUTS:
            words[place + 1] = f"{folder}/{{member}}{pathlib.PurePath(words[place + 1]).suffix or OUTPUTS[word]}"
    return words


def tried_members(given):
    """The lines of the manifest of the first members, and the processor seconds that these took."""
    with tempfile.TemporaryDirectory() as folder:
        manifest = pathlib.Path(folder, "tried.jsonl")
        option, ending = KEPT[given.keep]
        command = [given.program, given.recipe, "--members", f"0:{min(TRIED, given.members)}", "--threads", "1",
                   "--quiet", "--manifest", str(manifest), option, f"{folder}/{{member}}{ending}",
                   *moved(given.options, folder)]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        try:
            status = subprocess.run(command, check=False).returncode
        except OSError as error:
            sys.exit(f"estimate.py: {given.program}: cannot be run ({error.strerror}); name it by --program, or put it "
                     "into PATH")
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        lines = manifest.read_text().splitlines() if manifest.exists() else []
        if not lines:
            sys.exit(status or 1)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return [json.loads(line) for line in lines], seconds


def estimate(given):
    entries, all_seconds = tried_members(given)
    seconds = all_seconds / len(entries)
    size = sum(file["bytes"] for entry in entries for file in entry["files"]) / len(entries)
    return {
        "seconds": round(seconds, 4),
        "bytes": round(size),
        "hours": round(seconds * given.members / 3600, 3),
        "gigabytes": round(size * given.members / 1e9, 3),
        "members_per_job": max(1, min(given.members, int(60 * given.minutes / seconds))),
    }


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
    taken = estimate(given)
    print(json.dumps(taken))
    for figure, most in (("gigabytes", given.most_gigabytes), ("hours", given.most_hours)):
        if most is not None and taken[figure] > most:
            print(f"estimate.py: the set would take {taken[figure]:g} {figure}, above {most:g}; make fewer or smaller "
                  f"members, or keep recipes instead of meshes", file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
