"""What the scripts of this folder share: programs that are run and measured, and tables in Markdown."""
import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent


def arguments_of(doc, *paths, **options):
    """The parsed command line. The last of the paths takes several; an option is its default, or what add_argument takes."""
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    for path in paths:
        parser.add_argument(path, type=pathlib.Path, nargs="+" if path == paths[-1] and path.endswith("s") else None)
    for name, given in options.items():
        described = given if isinstance(given, dict) else {"type": type(given), "default": given}
        parser.add_argument("--" + name.replace("_", "-"), **described)
    return parser.parse_args()


class Run:
    """A command that has ended: status, output, errors, seconds of the processor and of the clock, most bytes of memory.

    Any status but 0 ends the script, unless `check` is off. The system ends a command after `most_seconds` of the processor.
    """

    def __init__(self, *command, check=True, most_seconds=None):
        def limit():
            resource.setrlimit(resource.RLIMIT_CPU, (most_seconds, most_seconds))

        start = time.monotonic()
        with tempfile.TemporaryFile() as output, tempfile.TemporaryFile() as errors:
            child = subprocess.Popen([str(c) for c in command], stdout=output, stderr=errors,
                                     preexec_fn=limit if most_seconds else None)  # fmt: skip
            _, status, used = os.wait4(child.pid, 0)
            self.status = child.returncode = os.waitstatus_to_exitcode(status)
            output.seek(0), errors.seek(0)
            self.output, self.errors = (file.read().decode(errors="replace") for file in (output, errors))
        self.clock, self.seconds, self.bytes = time.monotonic() - start, used.ru_utime + used.ru_stime, 1024 * used.ru_maxrss
        if self.status != 0 and check:
            sys.exit(f"{' '.join(map(str, command))}: {self.errors.strip()}")

    def json(self):
        return json.loads(self.output)

    def rows(self):
        return [json.loads(line) for line in self.output.splitlines()]


def row(*cells):
    print("| " + " | ".join(map(str, cells)) + " |", flush=True)


def head(*cells):
    row(*cells)
    print("|---" * len(cells) + "|")
