#!/usr/bin/env python3
"""Faults that befall programs while they write, as a table: every output, by every fault.

    fault_table_test.py FOLDER_OF_PROGRAMS [--full] [--only WORD] [--moments N] [--jobs N]

After a fault each output is whole, with the bytes of a run that nothing disturbed, or it is what stood there before;
nothing else is left; the status and the one line on stderr say what happened. By default one output of each program is
tried, at two moments; --full tries all. Each row that is wrong is printed, and the number of runs at the end. Faults
that need a mount are left out, with a word, where the kernel lets nobody mount.
"""

import argparse
import collections
import concurrent.futures
import hashlib
import json
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from summary_fields_test import write_ball, write_photo

BODY = """{"format_version": 1, "length_unit": "km",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1], [1, 0, 0, 0.75]]},
  "layers": [{"type": "simplex", "amplitude": 0.05, "frequency": 2, "octaves": 4},
             {"type": "craters", "craters": [{"direction": [0, 0, 1], "diameter": 0.4}]}]}"""
FAMILY = BODY[:-1] + ',\n  "family": {"fields": [{"field": "layers[0].amplitude", "low": 0.01, "high": 0.1}]}}'
PATIENCE = 300  # seconds after which a run counts as one that does not end
OLD = b"what stood here before\n"
STAR = """{"format_version": 1, "length_unit": "km", "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1]]},
  "layers": [{"type": "simplex", "amplitude": 0.02, "frequency": 1}]}"""
MESH = ["body.json", "--resolution", "72", "-o"]
FIT = ["fine.obj", "--spheres", "40", "--threads", "1"]

# output: program, arguments, the files that it writes, whether it keeps the best so far, whether the short test has it
Output = collections.namedtuple("Output", "program arguments files keeps_best quick", defaults=(False, False))
PRINT_RESULTS = {"gravity"}  # write to stdout beside their files; what is lost there is said
SAY_EACH_FILE = {"classify"}  # have a line for each input that cannot be read
OUTPUTS = {
    "mesh.ply": Output("synth", MESH + ["out.ply"], ["out.ply"], quick=True),
    "mesh.ply.zst": Output("synth", MESH + ["out.ply.zst"], ["out.ply.zst"]),
    "mesh.obj": Output("synth", MESH + ["out.obj"], ["out.obj"]),
    "mesh.stl": Output("synth", MESH + ["out.stl"], ["out.stl"]),
    "mesh.glb": Output("synth", MESH + ["out.glb", "--uv"], ["out.glb"]),
    "mesh.icq": Output("synth", ["star.json", *MESH[1:], "out.icq"], ["out.icq"]),
    "mesh.tab": Output("synth", MESH + ["out.tab"], ["out.tab"]),
    "labels": Output("synth", MESH + ["out.ply", "--labels"], ["out.ply"]),
    "points": Output("synth", MESH + ["out.ply", "--points"], ["out.ply"]),
    "tile": Output("synth", MESH + ["out.ply", "--tile", "1/2"], ["out.ply"]),
    "everything of a mesh": Output(
        "synth",
        MESH + ["out.ply", "--preview", "out.png", "--preview-maps", "out.npz", "--feature-list", "out.csv",
                "--write-recipe", "out.json"],
        ["out.ply", "out.png", "out.npz", "out.csv", "out.json"], quick=True),  # fmt: skip
    "height map": Output(
        "synth", MESH + ["out.ply", "--patch", "0", "0", "1", "0.6", "--height-map", "out.tif"],
        ["out.ply", "out.tif", "out.json"]),  # fmt: skip
    "texture": Output("synth", ["rock.json", "--texture", "512x512", "-o", "out.png"], ["out.png"]),
    "material": Output(
        "synth", ["rock.json", "--texture", "256x256", "--texture-of", "material", "-o", "out.png"],
        [f"out_{part}" for part in ("height.tif", "color.png", "normal.png", "occlusion.png")]),  # fmt: skip
    "members": Output(
        "synth", ["family.json", "--members", "0:4", "--resolution", "32", "-o", "out{member}.ply"],
        [f"out{k}.ply" for k in range(4)]),  # fmt: skip
    "histogram": Output("describe", ["fine.obj", "-o", "out.npy", "--points", "12000"], ["out.npy"], quick=True),
    "surface": Output("describe", ["fine.obj", "--surface", "-o", "out.json"], ["out.json"]),
    "comparison": Output("compare", ["fine.obj", "ball.obj", "--points", "9000", "-o", "out.json"], ["out.json"],
                         quick=True),  # fmt: skip
    "comparison on stdout": Output("compare", ["fine.obj", "ball.obj", "--points", "4000"], [], quick=True),
    "gravity.csv": Output("gravity", ["fine.obj", "--density", "2000", "-o", "out.csv"], ["out.csv"], quick=True),
    "gravity.npy": Output("gravity", ["fine.obj", "--density", "2000", "-o", "out.npy"], ["out.npy"]),
    "gravity.ply": Output(
        "gravity", ["fine.obj", "--density", "2000", "-o", "out.ply", "--preview", "out.png"],
        ["out.ply", "out.png"]),  # fmt: skip
    "classifier": Output(
        "classify", ["train", "one", "two", "-o", "out.yml", "--points", "3000", "--trees", "200"], ["out.yml"],
        quick=True),  # fmt: skip
    "fit": Output("fit_shape", [*FIT, "--base-only", "-o", "out.json"], ["out.json"], True, True),
    "compact fit": Output("fit_shape", [*FIT, "--base-only", "-o", "out.astro"], ["out.astro"], True),
    "fit with details": Output(
        "fit_shape", ["ball.obj", "--spheres", "6", "--population", "4", "--generations", "2", "-o", "out.json"],
        ["out.json"], True),  # fmt: skip
    "packing": Output("fit_shape", ["fine.obj", "--packing-only", "-o", "out.csv"], ["out.csv"], True),
    "texture fit": Output(
        "fit_gabor", ["large.png", "-o", "out.json", "--spectrum", "out.npy"], ["out.json", "out.npy"], True, True),
    "exemplar": Output("fit_gabor", ["large.png", "--model", "exemplar", "-o", "out.json"], ["out.json"], True),
}  # fmt: skip


def write_inputs(folder, programs):
    (folder / "body.json").write_text(BODY)
    (folder / "star.json").write_text(STAR)
    (folder / "family.json").write_text(FAMILY)
    write_ball(folder / "ball.obj")
    write_ball(folder / "fine.obj", 1.4, 40, 60)
    write_photo(folder / "small.png", 3)
    write_photo(folder / "large.png", 1, 192)
    for name, length in (("one", 1.2), ("two", 2.0)):
        (folder / name).mkdir()
        for k in range(3):
            write_ball(folder / name / f"{k}.obj", length + 0.1 * k)
    subprocess.run([programs / "fit_gabor", "small.png", "-o", "rock.json", "--channels", "pca", "--quiet"], cwd=folder,
                   check=True)  # fmt: skip


# How a run ended: status (negative: the signal that killed it), words on stderr, seconds.
Ending = collections.namedtuple("Ending", "status words seconds")


def finish(process, seconds=PATIENCE):
    start = time.monotonic()
    words = process.communicate(timeout=seconds)[1]
    return Ending(process.returncode, words, time.monotonic() - start)


class Run:
    """One run in a folder of its own: inputs beside it, outputs in `out`."""

    def __init__(self, place, inputs, programs, output):
        self.folder = place
        self.inputs = place / "in"
        shutil.copytree(inputs, self.inputs)
        self.out = place / "out"
        self.out.mkdir()
        known = {entry.name for entry in self.inputs.iterdir()}
        renamed = lambda word: f"in/{word}" if word in known else f"out/{word}" if word.startswith("out") else word
        self.command = [str(programs / output.program), *map(renamed, output.arguments)]

    def start(self, wrap=(), **options):
        settings = dict(cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        return subprocess.Popen([*wrap, *self.command], **{**settings, **options})


def signalled(number, times=1):
    def fault(run, after):
        process = run.start()
        try:
            process.wait(after)
        except subprocess.TimeoutExpired:
            for _ in range(times):
                process.send_signal(number)
                time.sleep(0.02)
        return finish(process)

    return fault


def without(what):
    """Removes the inputs or the folder of the outputs in the middle of the run."""

    def fault(run, after):
        process = run.start()
        time.sleep(after)
        shutil.rmtree(getattr(run, what), ignore_errors=True)
        return finish(process)

    return fault


def cut_inputs(run, after):
    """Cuts every input to half of its length, as another program does that writes it anew."""
    process = run.start()
    time.sleep(after)
    for file in run.inputs.rglob("*"):
        if file.is_file():
            os.truncate(file, file.stat().st_size // 2)
    return finish(process)


def limited_memory(run, after):
    """A limit of the address space, between what a program needs to begin and 4 GB."""
    limit = int(2**26 * 64 ** min(1.0, after / run.whole))
    return finish(run.start(preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit))))


def limited_files(run, after):
    """No file may pass a length, which is how a quota shows itself."""
    limit = 1 + int(run.largest * 0.9 * min(1.0, after / run.whole))
    return finish(run.start(preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))))


def few_descriptors(run, after):
    """So few open files that even libraries may fail to load: it must still end in words."""
    limit = 5 + int(12 * min(1.0, after / run.whole))
    return finish(run.start(preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (limit, limit))))


def full_disk(run, after):
    pages = 1 + int(run.largest * 0.9 * min(1.0, after / run.whole) / 4096)
    listing = 'mount -t tmpfs -o size=$0 none out && "$@"; s=$?; ls -A out >names; exit $s'
    ending = finish(run.start(["unshare", "-rm", "sh", "-c", listing, str(4096 * pages)]))
    run.left_behind = set((run.folder / "names").read_text().split())
    return ending


def read_only_folder(run, after):
    del after
    mounts = 'mount --bind out out && mount -o remount,bind,ro out && "$@"'
    return finish(run.start(["unshare", "-rm", "sh", "-c", mounts, "sh"]))


def closed_reader(stream):
    """The other end of stdout or stderr is closed, as by `| head`."""

    def fault(run, after):
        del after
        reader, writer = os.pipe()
        os.close(reader)
        process = run.start(**{stream: writer})
        os.close(writer)
        status = process.wait(PATIENCE)
        return Ending(status, "" if stream == "stderr" else process.stderr.read(), 0.0)

    return fault


# fault: what is done to a run, the statuses it may end with, and a word that the line must hold when it fails
Fault = collections.namedtuple("Fault", "do statuses moments word", defaults=("",))
DONE, FAILED, WRONG, STOPPED = 0, 1, 2, 3
FAULTS = {
    "SIGKILL": Fault(signalled(signal.SIGKILL), {DONE, -9}, True),
    "SIGTERM": Fault(signalled(signal.SIGTERM), {DONE, FAILED, STOPPED, -15}, True),
    "Ctrl-C": Fault(signalled(signal.SIGINT), {DONE, FAILED, STOPPED, -2}, True),
    "Ctrl-C twice": Fault(signalled(signal.SIGINT, 2), {DONE, FAILED, STOPPED, -2}, True),
    "inputs vanish": Fault(without("inputs"), {DONE, FAILED, WRONG}, True),
    "inputs are cut": Fault(cut_inputs, {DONE, FAILED, WRONG}, True),
    "the folder vanishes": Fault(without("out"), {DONE, FAILED, WRONG}, True),
    "little memory": Fault(limited_memory, {DONE, FAILED, WRONG, 127}, True, "memory"),
    "files may not grow": Fault(limited_files, {DONE, FAILED, WRONG}, True),
    "few descriptors": Fault(few_descriptors, {DONE, FAILED, WRONG, 127}, True),
    "the disk is full": Fault(full_disk, {DONE, FAILED, WRONG}, True),
    "a folder to read only": Fault(read_only_folder, {DONE, WRONG}, False),
    "stdout is closed": Fault(closed_reader("stdout"), {DONE}, False),
    "stderr is closed": Fault(closed_reader("stderr"), {DONE}, False),
}
NEED_MOUNTS = {"the disk is full", "a folder to read only"}


def may_mount():
    command = ["unshare", "-rm", "sh", "-c", "mount -t tmpfs none /mnt"]
    return shutil.which("unshare") and subprocess.run(command, capture_output=True, check=False).returncode == 0


def digest(file):
    return hashlib.sha256(file.read_bytes()).hexdigest()


def is_recipe(programs, file):
    """Whether synth reads it to the end: what a fit keeps after Ctrl-C must be of use."""
    command = [programs / "synth", file, "--predict", "--resolution", "16", "--quiet"]
    if json_of(file).get("body") is None and file.suffix == ".json":
        command = [programs / "synth", file, "--texture", "16x16", "-o", file.with_suffix(".check.png"), "--quiet"]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    file.with_suffix(".check.png").unlink(missing_ok=True)
    return done.returncode == 0


def json_of(file):
    try:
        return json.loads(file.read_text())
    except ValueError:
        return {}


def wrong_files(run, output, wanted, programs, ending):
    """What is wrong with the folder of the outputs after a fault; empty if nothing is."""
    if not run.out.exists():
        return ""
    for file in sorted(run.out.iterdir()):
        if file.name not in wanted:
            return f"leaves {file.name}"
        if file.read_bytes() == OLD or digest(file) == wanted[file.name]:
            continue
        best = output.keeps_best and ending.status == STOPPED
        if not best:
            return f"{file.name} is not whole"
        if file.suffix in (".json", ".astro") and not is_recipe(programs, file):
            return f"{file.name} is no recipe"
    if ending.status == DONE and not run.left_behind:
        for name in wanted:
            if not (run.out / name).exists() or (run.out / name).read_bytes() == OLD:
                return f"status 0 without {name}"
    return ""


def wrong_words(output, fault, ending):
    """What is wrong with the message and the status; empty if nothing is."""
    prints = output.program in PRINT_RESULTS or not output.files
    result_is_lost = prints and fault is FAULTS["stdout is closed"]
    if ending.status not in ({FAILED} if result_is_lost else fault.statuses):
        return f"status {ending.status}"
    if ending.status not in (FAILED, WRONG):
        return ""
    lines = [line for line in ending.words.splitlines() if line.startswith(f"{output.program}: ")]
    if not lines:
        return "no message"
    if len(lines) > 1 and output.program not in SAY_EACH_FILE:
        return "more than one message"
    if len(lines[0]) > 400:
        return "a message of more than 400 characters"
    if fault.word and ending.status == FAILED and fault.word not in lines[0]:
        return f"the message does not speak of {fault.word}"
    return ""


def undisturbed(place, inputs, programs, output):
    """The digests of the outputs, the seconds and the greatest length of a run in peace."""
    run = Run(place, inputs, programs, output)
    start = time.monotonic()
    ending = finish(run.start())
    if ending.status != DONE:
        sys.exit(f"{' '.join(run.command)}: status {ending.status}: {ending.words}")
    whole = time.monotonic() - start
    files = {file.name: file for file in run.out.iterdir()}
    if set(files) != set(output.files):
        sys.exit(f"{' '.join(run.command)}: wrote {sorted(files)}")
    return {name: digest(file) for name, file in files.items()}, whole, max((f.stat().st_size for f in files.values()), default=1)


def attempt(name, kind, moment, known, inputs, programs):
    """One run of the table: a line that says what is wrong, or an empty one."""
    output, fault = OUTPUTS[name], FAULTS[kind]
    wanted, whole, largest = known[name]
    with tempfile.TemporaryDirectory() as scratch:
        run = Run(pathlib.Path(scratch), inputs, programs, output)
        run.whole, run.largest, run.left_behind = whole, largest, set()
        if int(1000 * moment) % 2 and kind != "the disk is full":  # half of the runs replace what stood there
            for file in output.files:
                (run.out / file).write_bytes(OLD)
        try:
            ending = fault.do(run, whole * moment)
        except subprocess.TimeoutExpired:
            return f"{name}, {kind} at {moment:.2f}: does not end"
        wrong = wrong_words(output, fault, ending) or wrong_files(run, output, wanted, programs, ending)
        if not wrong and run.left_behind - set(output.files):
            wrong = f"leaves {sorted(run.left_behind)}"
        return f"{name}, {kind} at {moment:.2f}: {wrong}: {ending.words.strip()[-300:]}" if wrong else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--full", action="store_true", help="all outputs, not one of each program")
    parser.add_argument("--only", default="", metavar="WORD", help="outputs and faults whose names hold this word")
    parser.add_argument("--moments", type=int, default=2, metavar="N", help="moments of each fault (default 2)")
    parser.add_argument("--jobs", type=int, default=2, metavar="N", help="runs at a time (default 2)")
    given = parser.parse_args()
    programs = given.programs.resolve()
    faults = dict(FAULTS)
    if not may_mount():
        print(f"left out, since nobody may mount here: {', '.join(sorted(NEED_MOUNTS))}")
        for kind in NEED_MOUNTS:
            del faults[kind]
    chosen = [name for name, output in OUTPUTS.items() if given.full or output.quick or given.only]
    with tempfile.TemporaryDirectory() as scratch:
        top = pathlib.Path(scratch)
        inputs = top / "inputs"
        inputs.mkdir()
        write_inputs(inputs, programs)
        rows = []
        for name in chosen:
            for kind, fault in faults.items():
                if given.only in name or given.only in kind:
                    count = given.moments if fault.moments else 1
                    rows += [(name, kind, (0.05 + k * 0.618 + 0.13 * len(rows)) % 1.0) for k in range(count)]
        known = {}
        for name in dict.fromkeys(row[0] for row in rows):
            (top / "peace").mkdir()
            known[name] = undisturbed(top / "peace", inputs, programs, OUTPUTS[name])
            shutil.rmtree(top / "peace")
        with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
            lines = list(pool.map(lambda row: attempt(*row, known, inputs, programs), rows))
    wrong = [line for line in lines if line]
    print("\n".join(wrong + [f"{len(rows)} runs of {len(known)} outputs by {len(faults)} faults, {len(wrong)} wrong"]))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
