#!/usr/bin/env python3
"""Prints how many members of a family fill a job of so many minutes, from the seconds of its first members.

    members_per_job.py family.json --minutes 10 --members 10000 [--program synth] [--options "--resolution 64"]

The members are made in a folder that goes away.
"""
import argparse
import json
import pathlib
import shlex
import subprocess
import tempfile

TRIED = 4  # members whose seconds are taken


def seconds_of_a_member(recipe, members, program, options):
    with tempfile.TemporaryDirectory() as folder:
        manifest = pathlib.Path(folder, "tried.jsonl")
        command = [program, recipe, "--members", f"0:{min(TRIED, members)}", "--threads", "1", "--quiet",
                   "-o", f"{folder}/{{member}}.ply", "--manifest", str(manifest), *options]
        subprocess.run(command, check=True)
        seconds = [json.loads(line)["seconds"] for line in manifest.read_text().splitlines()]
    return sum(seconds) / len(seconds)


def without_outputs(options):
    """Options that name further files are left out: they would write into the set itself."""
    words, kept = shlex.split(options), []
    while words:
        word = words.pop(0)
        if word in ("--preview", "--feature-list", "--write-recipe"):
            words.pop(0)
        else:
            kept.append(word)
    return kept


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recipe")
    parser.add_argument("--minutes", type=float, required=True)
    parser.add_argument("--members", type=int, required=True)
    parser.add_argument("--program", default="synth")
    parser.add_argument("--options", default="")
    given = parser.parse_args()
    seconds = seconds_of_a_member(given.recipe, given.members, given.program, without_outputs(given.options))
    print(max(1, min(given.members, int(60 * given.minutes / seconds))))


if __name__ == "__main__":
    main()
