#!/usr/bin/env python3
"""Presses Ctrl-C at several moments in every program: it ends soon, says so, and its status tells.

    interrupted_programs_test.py FOLDER_OF_PROGRAMS MESH PHOTO [MOMENTS] [SECONDS]

MOMENTS (default 2) are spread over the run of each program. SECONDS (default 5, for a machine at other work) is the
longest time between Ctrl-C and the end. Prints the longest time of each program.
"""

import pathlib
import signal
import subprocess
import sys
import tempfile
import time

from summary_fields_test import write_ball

PROGRAMS, MESH, PHOTO = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
MOMENTS = int(sys.argv[4]) if len(sys.argv) > 4 else 2
LONGEST = float(sys.argv[5]) if len(sys.argv) > 5 else 5.0
BODY = """{"format_version": 1, "length_unit": "km",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1], [1, 0, 0, 0.75]]},
  "layers": [{"type": "simplex", "amplitude": 0.05, "frequency": 2, "octaves": 8}]}"""

# Each command, and the seconds over which its moments are spread.
COMMANDS = {
    "synth": (["body.json", "-o", "out.ply", "--resolution", "1500"], 4.0),
    "fit_shape": ([MESH, "-o", "out.json", "--spheres", "200"], 8.0),
    "fit_gabor": ([PHOTO, "-o", "out.json"], 4.0),
    "describe": ([MESH, "-o", "out.npy", "--points", "60000"], 4.0),
    "compare": ([MESH, MESH, "--points", "60000"], 4.0),
    "gravity": (["body.json", "--density", "2000", "--resolution", "256", "--exact", "-o", "out.csv"], 4.0),
    "classify": (["train", "shapes", "-o", "out.yml", "--points", "20000"], 4.0),
}
if not (MESH.exists() and PHOTO.exists()):
    print(f"skipped: {MESH} or {PHOTO} is not there; run scripts/fetch_data.sh")
    sys.exit(77)


def folder_of_inputs(folder):
    (folder / "body.json").write_text(BODY)
    for kind, least_length in (("long", 2.0), ("short", 1.0)):
        (folder / "shapes" / kind).mkdir(parents=True)
        for k in range(4):
            write_ball(folder / "shapes" / kind / f"{k}.obj", least_length + 0.1 * k)


def interrupted(folder, name, arguments, after):
    """The status, the words and the seconds from Ctrl-C to the end; None if the program was done before."""
    process = subprocess.Popen([PROGRAMS / name, *map(str, arguments)], cwd=folder, stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True)  # fmt: skip
    try:
        process.wait(after)
        return None
    except subprocess.TimeoutExpired:
        pass
    pressed = time.monotonic()
    process.send_signal(signal.SIGINT)
    words = process.communicate(timeout=120)[1]
    return process.returncode, words, time.monotonic() - pressed


def complaint(folder, status, words, seconds):
    """What is wrong with the end of a program; empty if nothing is."""
    if seconds > LONGEST:
        return f"took {seconds:.1f} s to end"
    if status == -signal.SIGINT and words == "":  # before the program heeds signals, as where it starts slowly
        return ""
    if status not in (1, 3):
        return f"status {status}"
    if "stopped" not in words:
        return "does not say that it was stopped"
    if status == 3 and not any(folder.glob("out.*")):
        return "status 3 without an output"
    if status == 1 and any(folder.glob("out.*")):
        return "status 1 with an output"
    return ""


failures = 0
for name, (arguments, span) in COMMANDS.items():
    if not (PROGRAMS / name).exists():
        continue
    slowest, stopped = 0.0, 0
    for moment in range(MOMENTS):
        with tempfile.TemporaryDirectory() as place:
            folder = pathlib.Path(place)
            folder_of_inputs(folder)
            after = 0.3 + span * (moment * 0.618 % 1.0)
            result = interrupted(folder, name, arguments, after)
            if result is None:
                continue
            stopped += 1
            slowest = max(slowest, result[2])
            if wrong := complaint(folder, *result):
                failures += 1
                print(f"{name} after {after:.2f} s: {wrong}: {result[1].strip()[-300:]}")
    print(f"{name}: stopped {stopped} of {MOMENTS} times, at most {slowest:.2f} s after Ctrl-C")
    failures += stopped == 0
sys.exit(1 if failures else 0)
