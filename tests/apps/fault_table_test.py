#!/usr/bin/env python3
"""Lets faults befall programs while they write: every output (fault_outputs.py), by every fault (fault_kinds.py).

    fault_table_test.py FOLDER_OF_PROGRAMS [--full] [--only WORD] [--moments N] [--jobs N] [--slowness F]

After a fault each output is whole, with the bytes of a run that nothing disturbed, or it is what stood there before;
nothing else is left; the status and the one line on stderr say what happened. Long work ends soon after Ctrl-C. A
command that was killed makes everything when it is started again. The short selection has one output or two of each
program; --full tries all. Each row that is wrong is printed, and the number of runs at the end.
"""

import argparse
import concurrent.futures
import hashlib
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time

from fault_kinds import DONE, FAILED, FAULTS, IN_LONG_WORK, MORE_MOMENTS, STOPPED, WRONG, Run, finish, impossible_here
from fault_outputs import OUTPUTS, write_inputs

OLD = b"what stood here before\n"
LATEST = 10.0  # seconds after which a program must have ended that heeds Ctrl-C, on a machine at other work
PRINT_RESULTS = {"gravity"}  # write to stdout beside their files; what is lost there is said


def content(file):
    """A set of what a file says: the hash of its bytes, or the entries of a manifest without their seconds.

    A manifest grows by a line for each member, so that one that was cut off holds some of the entries.
    """
    if file.suffix != ".jsonl":
        return {hashlib.sha256(file.read_bytes()).hexdigest()}
    entries = set()
    for line in file.read_text().splitlines():
        try:
            entry = json.loads(line)
        except ValueError:
            continue  # cut short by a kill
        entry.pop("seconds", None)
        entries.add(json.dumps(entry, sort_keys=True))
    return entries


def new_files(run):
    """The files of the outputs, but for those that stand as they stood before."""
    return [file for file in sorted(run.out.iterdir()) if file.read_bytes() != OLD] if run.out.exists() else []


def is_complete(run, wanted):
    return {file.name: content(file) for file in new_files(run)}.items() >= wanted.items()


def makes_members(output):
    return "--members" in output.arguments


def is_recipe(programs, file):
    """Whether synth reads it to the end: what a fit keeps after Ctrl-C must be of use."""
    command = [programs / "synth", file, "--predict", "--resolution", "16", "--quiet"]
    if file.suffix == ".json" and "body" not in json.loads(file.read_text()):
        command = [programs / "synth", file, "--texture", "16x16", "-o", file.parent.parent / "check.png", "--quiet"]
    return subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False).returncode == 0


def wrong_files(run, output, kind, wanted, programs, ending):
    """What is wrong with the folder of the outputs after a fault; empty if nothing is."""
    if not run.out.exists():
        return ""
    files = new_files(run)
    for file in files:
        # A kill between the two system calls that replace a file leaves the whole file under a temporary name.
        if kind in MORE_MOMENTS and file.name.startswith(".astrolith_") and content(file) in wanted.values():
            continue
        if file.name not in output.files:
            return f"leaves {file.name}"
        if content(file) <= wanted.get(file.name, set()):
            continue
        if output.program == "classify" and kind.startswith("inputs") and ending.status == FAILED:
            continue  # it says which shapes it could not read, and learns from the others
        if not output.keeps_best or ending.status not in STOPPED:
            return f"{file.name} is not whole"
        if file.suffix in (".json", ".astro") and not is_recipe(programs, file):
            return f"{file.name} is no recipe"
    lost = run.left_behind or kind == "the folder vanishes" and makes_members(output)  # members make their folder again
    if ending.status == DONE and not lost and not is_complete(run, wanted):
        return "status 0 without all outputs"
    return f"leaves {sorted(run.left_behind)}" if run.left_behind - set(output.files) else ""


def wrong_words(run, output, kind, wanted, ending, slowness):
    """What is wrong with the message, the status and the time; empty if nothing is."""
    fault = FAULTS[kind]
    result_is_lost = kind == "stdout is closed" and (output.program in PRINT_RESULTS or not output.files)
    if ending.status not in ({FAILED} if result_is_lost else fault.statuses):
        return f"status {ending.status}"
    if fault.word == "stopped" and ending.seconds > LATEST * slowness:
        return f"took {ending.seconds:.1f} s to end"
    if fault.word and ending.status == FAILED and not re.search(fault.word, ending.words):
        return f"does not speak of {fault.word}"
    if ending.status not in (FAILED, WRONG) or kind == "stderr is closed":
        return ""
    lines = [line for line in ending.words.splitlines() if line.startswith(f"{output.program}: ")]
    if not lines:
        return "no message"
    if len(lines) > 1 and output.program != "classify" and not makes_members(output):  # they have a line for each body
        return "more than one message"
    return "a message of more than 400 characters" if len(lines[0]) > 400 else ""


class Table:
    """The outputs by the faults, as rows that can be tried one by one."""

    def __init__(self, folder, programs, slowness):
        self.folder, self.programs, self.slowness = folder, programs, slowness
        self.inputs = folder / "inputs"
        self.inputs.mkdir()
        write_inputs(self.inputs)
        self.known = {}  # of each output: the contents of its files, the seconds and the greatest length of a file

    def learn(self, name):
        """Runs in peace what can be let end."""
        output = OUTPUTS[name]
        if output.span:
            self.known[name] = {}, output.span, 1
            return
        with tempfile.TemporaryDirectory(dir=self.folder) as place:
            run = Run(pathlib.Path(place), self.inputs, self.programs, output)
            start = time.monotonic()
            ending = finish(run.start())
            whole = time.monotonic() - start
            files = {file.name: file for file in run.out.iterdir()}
            if ending.status != DONE or set(files) != set(output.files):
                sys.exit(f"{' '.join(run.command)}: status {ending.status}, wrote {sorted(files)}: {ending.words}")
            largest = max((file.stat().st_size for file in files.values()), default=1)
            self.known[name] = {name: content(file) for name, file in files.items()}, whole, largest

    def attempt(self, name, kind, moment):
        """Tries one row. Returns a line that says what is wrong, or an empty one."""
        output = OUTPUTS[name]
        wanted, whole, largest = self.known[name]
        with tempfile.TemporaryDirectory(dir=self.folder) as place:
            run = Run(pathlib.Path(place), self.inputs, self.programs, output, whole, largest)
            if int(1000 * moment) % 2 and kind != "the disk is full":  # half of the runs replace what stood there
                for file in output.files:
                    if not file.endswith(".jsonl"):  # a manifest is extended
                        (run.out / file).write_bytes(OLD)
            try:
                ending = FAULTS[kind].do(run, whole * moment)
            except subprocess.TimeoutExpired:
                return f"{name}, {kind} at {moment:.2f}: does not end"
            wrong = wrong_words(run, output, kind, wanted, ending, self.slowness)
            wrong = wrong or wrong_files(run, output, kind, wanted, self.programs, ending)
            return f"{name}, {kind} at {moment:.2f}: {wrong}: {ending.words.strip()[-300:]}" if wrong else ""


def rows_of(names, faults, only, moments, slowness):
    """The rows, with moments that are spread evenly over a run however many there are. Slow programs get no more kills."""
    rows = []
    for name in names:
        for kind in faults:
            if bool(OUTPUTS[name].span) == (kind == IN_LONG_WORK) and (only in name or only in kind):
                times = min(OUTPUTS[name].kills, MORE_MOMENTS.get(kind, 1)) if slowness <= 1 else 1
                count = moments * times if FAULTS[kind].moments else 1
                rows += [(name, kind, (0.05 + k * 0.618 + 0.13 * len(rows)) % 1.0) for k in range(count)]
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--full", action="store_true", help="all outputs, not one or two of each program")
    parser.add_argument("--only", default="", metavar="WORD", help="outputs and faults whose names hold this word")
    parser.add_argument("--moments", type=int, default=1, metavar="N", help="moments of each fault (default 1)")
    parser.add_argument("--jobs", type=int, default=2, metavar="N", help="runs at a time (default 2)")
    parser.add_argument("--slowness", type=float, default=1, metavar="F", help="time that Ctrl-C may take, in tens of seconds")
    given = parser.parse_args()
    programs = given.programs.resolve()
    with tempfile.TemporaryDirectory() as scratch:
        impossible = impossible_here(programs, scratch)
        for kind, reason in impossible.items():
            print(f"{kind}: left out, since {reason}")
        faults = [kind for kind in FAULTS if kind not in impossible]
        names = [name for name, output in OUTPUTS.items()
                 if (given.full or output.quick or given.only) and (programs / output.program).exists()]
        rows = rows_of(names, faults, given.only, given.moments, given.slowness)
        table = Table(pathlib.Path(scratch), programs, given.slowness)
        for name in dict.fromkeys(row[0] for row in rows):
            table.learn(name)
        with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
            wrong = [line for line in pool.map(lambda row: table.attempt(*row), rows) if line]
    print("\n".join(wrong + [f"{len(rows)} runs of {len(table.known)} outputs by {len(faults)} faults, {len(wrong)} wrong"]))
    return 1 if wrong or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
