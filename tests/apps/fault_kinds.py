"""What can befall a program while it writes, as a table."""

import collections
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import tempfile
import time

PATIENCE = 300  # seconds after which a run counts as one that does not end

# How a run ended: status (negative: the signal that killed it), words on stderr, seconds since the fault.
Ending = collections.namedtuple("Ending", "status words seconds", defaults=(0.0,))


def finish(process, seconds=PATIENCE):
    start = time.monotonic()
    try:
        words = process.communicate(timeout=seconds)[1]
    finally:
        process.kill()
    return Ending(process.returncode, words or "", time.monotonic() - start)


class Run:
    """One run in a folder of its own: inputs in `in`, outputs in `out`.

    `whole` and `largest` are the seconds and the greatest length of a file of a run that nothing disturbs.
    """

    def __init__(self, folder, inputs, programs, output, whole=1.0, largest=1):
        self.folder, self.inputs, self.out = folder, folder / "in", folder / "out"
        self.whole, self.largest, self.left_behind = whole, largest, set()
        shutil.copytree(inputs, self.inputs)
        self.out.mkdir()
        known = {entry.name for entry in self.inputs.iterdir()}
        renamed = lambda word: f"in/{word}" if word in known else f"out/{word}" if word.startswith("out") else word
        self.command = [str(programs / output.program), *map(renamed, output.arguments)]

    def start(self, wrap=(), **options):
        settings = dict(cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        return subprocess.Popen([*wrap, *self.command], **{**settings, **options})

    def share(self, after):
        """Where a moment lies in the whole run, from 0 to 1."""
        return min(1.0, after / self.whole)

    def limited(self, what, limit):
        return finish(self.start(preexec_fn=lambda: resource.setrlimit(what, (limit, limit))))


def ended_within(process, seconds):
    try:
        process.wait(seconds)
        return True
    except subprocess.TimeoutExpired:
        return False


def signalled(number, times=1):
    def fault(run, after):
        process = run.start()
        if not ended_within(process, after):
            for _ in range(times):
                process.send_signal(number)
                time.sleep(0.02)
        return finish(process)

    return fault


def heeds_ctrl_c(process):
    """Whether the program has come so far that it catches SIGINT."""
    try:
        status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
    except OSError:
        return False
    return any(int(line.split()[1], 16) >> (signal.SIGINT - 1) & 1 for line in status.splitlines() if line.startswith("SigCgt"))


def stopped_in_long_work(run, after):
    """The moment counts from where the program heeds Ctrl-C, which it must do soon and end soon.

    Where a fast machine had done the work before, it is done again and stopped earlier."""
    for _ in range(5):
        process = run.start()
        for _ in range(1000):
            if heeds_ctrl_c(process) or ended_within(process, 0.01):
                break
        if not ended_within(process, after):
            process.send_signal(signal.SIGINT)
        ending = finish(process, PATIENCE / 10)
        if ending.status != DONE:
            break
        for file in run.out.iterdir():
            file.unlink()
        after *= 0.4
    return ending


def killed_and_started_again(run, after):
    """Killed three times at different moments, the same command must then make all that was wanted."""
    for share in (1.0, 0.3, 0.6):
        process = run.start()
        ended_within(process, share * after)
        process.kill()
        process.communicate()
    return finish(run.start())


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
    return run.limited(resource.RLIMIT_AS, int(7.5e7 * 53 ** run.share(after)))


def limited_files(run, after):
    """No file may pass a length, which is how a quota shows itself."""
    return run.limited(resource.RLIMIT_FSIZE, 1 + int(run.largest * 0.9 * run.share(after)))


def few_descriptors(run, after):
    """So few open files that even libraries may fail to load: it must still end in words."""
    return run.limited(resource.RLIMIT_NOFILE, 5 + int(12 * run.share(after)))


def full_disk(run, after):
    pages = 1 + int(run.largest * 0.9 * run.share(after) / 4096)
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
        return finish(process)

    return fault


# What is done to a run, the statuses that it may end with, whether the moment matters, and words (a regular expression)
# one of which the line must hold when the program fails or stops.
Fault = collections.namedtuple("Fault", "do statuses moments word", defaults=(True, ""))
DONE, FAILED, WRONG = 0, 1, 2
STOPPED = {-signal.SIGINT, -signal.SIGTERM}  # a program dies of the signal that stopped it
MORE_MOMENTS = {"SIGKILL": 30, "killed and started again": 4}  # at most, for outputs that ask for them
IN_LONG_WORK = "Ctrl-C in long work"
FAULTS = {
    "SIGKILL": Fault(signalled(signal.SIGKILL), {DONE, -9}),
    "killed and started again": Fault(killed_and_started_again, {DONE}),
    "SIGTERM": Fault(signalled(signal.SIGTERM), {DONE, -signal.SIGTERM}, word="stopped"),
    "Ctrl-C": Fault(signalled(signal.SIGINT), {DONE, -signal.SIGINT}, word="stopped"),
    "Ctrl-C twice": Fault(signalled(signal.SIGINT, 2), {DONE, -signal.SIGINT}, word="stopped"),
    IN_LONG_WORK: Fault(stopped_in_long_work, {-signal.SIGINT}, word="stopped"),
    "inputs vanish": Fault(without("inputs"), {DONE, FAILED, WRONG}),
    "inputs are cut": Fault(cut_inputs, {DONE, FAILED, WRONG}),
    "the folder vanishes": Fault(without("out"), {DONE, FAILED, WRONG}),
    "little memory": Fault(limited_memory, {DONE, FAILED, WRONG, 127}, word="memory|Resource temporarily unavailable"),
    "files may not grow": Fault(limited_files, {DONE, FAILED, WRONG}),
    "few descriptors": Fault(few_descriptors, {DONE, FAILED, WRONG, 127}),
    "the disk is full": Fault(full_disk, {DONE, FAILED, WRONG}),
    "a folder to read only": Fault(read_only_folder, {DONE, WRONG}, False),
    "stdout is closed": Fault(closed_reader("stdout"), {DONE}, False),
    "stderr is closed": Fault(closed_reader("stderr"), {DONE}, False),
}


def impossible_here(programs, folder):
    """The faults that this machine or this build cannot make, each with the reason."""
    succeeds = lambda command, **options: subprocess.run(command, capture_output=True, check=False, **options).returncode == 0
    found = {}
    mounts = ["unshare", "-rm", "sh", "-c", "mount -t tmpfs none /mnt"]
    if not (shutil.which("unshare") and succeeds(mounts)):
        found |= dict.fromkeys(("the disk is full", "a folder to read only"), "nobody may mount here")
    limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (2**32, 2**32))
    if not succeeds([programs / "synth", "--version"], preexec_fn=limit):
        # It reserves terabytes of addresses, and finds out through a pipe what memory may be read.
        found |= dict.fromkeys(("little memory", "few descriptors"), "a sanitizer needs them for itself")
    try:
        os.close(os.open(folder, os.O_TMPFILE | os.O_WRONLY, 0o600))
    except OSError:
        found["SIGKILL"] = "the file system has no files without names"
    return found
