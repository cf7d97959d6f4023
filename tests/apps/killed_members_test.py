#!/usr/bin/env python3
"""Kills `synth --members` at random moments and starts it again: the set must end as if nothing had happened.

    killed_members_test.py SYNTH [--kills N]    N sets (default 4), each killed some times; 100 take some minutes
"""
import argparse
import json
import pathlib
import random
import subprocess
import sys
import tempfile
import time

FAMILY = """{"format_version": 1, "length_unit": "m",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 100], [80, 0, 0, 60]]},
  "layers": [{"type": "simplex", "amplitude": 1, "frequency": 0.01, "octaves": 2}],
  "family": {"fields": [{"field": "layers[0].amplitude", "low": 1, "high": 10}]}}"""
MEMBERS = 12


def command(synth, recipe, folder):
    return [synth, recipe, "--members", f"0:{MEMBERS}", "--resolution", "48", "--quiet",
            "-o", f"{folder}/{{member}}.ply", "--write-recipe", f"{folder}/{{member}}.json",
            "--manifest", f"{folder}/set.jsonl"]


def entries(folder):
    """The manifest by member without seconds."""
    found = {}
    for line in (folder / "set.jsonl").read_text().splitlines():
        try:
            entry = json.loads(line)
        except ValueError:
            continue  # cut short by a kill
        entry.pop("seconds")
        found[entry["member"]] = entry
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("synth")
    parser.add_argument("--kills", type=int, default=4, metavar="N", help="sets that are killed")
    given = parser.parse_args()
    rng = random.Random(1)
    with tempfile.TemporaryDirectory() as top:
        recipe = pathlib.Path(top, "family.json")
        recipe.write_text(FAMILY)
        whole = pathlib.Path(top, "whole")
        start = time.monotonic()
        subprocess.run(command(given.synth, recipe, whole), check=True)
        duration = time.monotonic() - start
        expected = {name.name: name.read_bytes() for name in whole.iterdir() if name.name != "set.jsonl"}
        killed = 0
        for number in range(given.kills):
            folder = pathlib.Path(top, f"set{number}")
            while True:
                process = subprocess.Popen(command(given.synth, recipe, folder))
                try:
                    process.wait(rng.uniform(0.0, 0.7 * duration))
                except subprocess.TimeoutExpired:
                    process.kill()
                    process.wait()
                    killed += 1
                    continue
                break
            if process.returncode != 0:
                return f"set {number}: status {process.returncode}"
            got = {name.name: name.read_bytes() for name in folder.iterdir() if name.name != "set.jsonl"}
            if got != expected or entries(folder) != entries(whole):
                return f"set {number} differs: {sorted(set(got) ^ set(expected))}"
    print(f"{given.kills} sets of {MEMBERS} members, killed {killed} times, all end alike and leave nothing else")
    return 0


if __name__ == "__main__":
    sys.exit(main())
