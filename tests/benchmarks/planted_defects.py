#!/usr/bin/env python3
"""Plants defects into a copy of the checkout, one at a time, and says which check finds each.

    planted_defects.py --check            each defect's text stands exactly once in its file (seconds)
    planted_defects.py --list             names, kinds and files
    planted_defects.py -o found.md        tries all; a second run goes on with those that found.md lacks
    planted_defects.py --only NAME        tries one
    planted_defects.py --by 'scripts/check.sh quick'      tries this one command instead of the search
    planted_defects.py --near             leaves out other rooms, programs and a sanitizer's cases that the table does not name
    planted_defects.py --in FOLDER        keeps the copy there, with all that is built in it

The defects stand in planted_defects.toml. Each is tried with more and more effort: static checks, the release tests of its
room, a sanitizer where the table says that memory or threads are concerned, and the release tests of the rooms that include
its room. A check that fails without a defect finds nothing. The copy is a worktree of git, without --in in a temporary folder.
"""
import argparse
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TABLE = Path(__file__).with_suffix(".toml")
HEADER = "| defect | kind | file | found by | first case | s |\n|---|---|---|---|---|---|\n"
NOT_FOUND = "**not found**"
MOST_LETTERS = 120  # of a case in the table

# The test executable of each room, without its ending "_tests". A room without a row has that of the folder above.
SUITES = {
    "numerics": "numerics", "recipe": "recipe", "geometry": "geometry", "gravity": "gravity", "descriptor": "descriptor",
    "descriptor/surface": "surface_statistics", "descriptor/spectrum": "spectrum",
    "descriptor/classification": "classification", "synthesis": "synthesis", "cuda": "cuda",
    "estimation/optimize": "optimize", "estimation/plot": "plot", "estimation/page": "page", "estimation/gabor": "gabor_fit",
    "estimation/shape": "shape_fit", "estimation/shape/details": "details_fit",
    "tasks": "apps", "apps": "apps", "python": "python",
}  # fmt: skip
PROGRAMS = ["apps_tests", "program_tests", "check_tiles", "classify", "compare", "describe", "fit_gabor", "fit_shape",
            "gravity", "synth"]  # fmt: skip


@dataclass(frozen=True)
class Check:
    name: str
    command: str  # for the shell, in the copy
    seconds: int = 3600  # after which the check is stopped and counts as failed


# ---- the checks -------------------------------------------------------------------------------------------------------


def run_check(check, tree):
    """Runs a check in the copy. Returns whether it passes, and the first case that fails."""
    environment = dict(os.environ, CCACHE_BASEDIR=str(tree), CCACHE_NOHASHDIR="1", CTEST_OUTPUT_ON_FAILURE="1",
                       CCACHE_SLOPPINESS="pch_defines,time_macros", ASTROLITH_PLANTED="1")  # fmt: skip
    child = subprocess.Popen(["bash", "-c", check.command], cwd=tree, env=environment, text=True, errors="replace",
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)  # fmt: skip
    try:
        said, _ = child.communicate(timeout=check.seconds)
    except BaseException as reason:
        os.killpg(child.pid, signal.SIGKILL)
        if not isinstance(reason, subprocess.TimeoutExpired):
            raise
        return False, f"no end after {check.seconds} s"
    return child.returncode == 0, "" if child.returncode == 0 else first_case(said.replace(f"{tree}/", ""))


def first_case(said):
    """The first failing case that the words of a check name, and what a sanitizer called it."""
    fault = re.search(r"(?:ERROR|WARNING): (\w+Sanitizer: [\w -]+)|(runtime error: .*)", said)
    case = re.search(r"\[  FAILED  \] ([\w/]+\.[\w/]+)", said) or re.search(r"^FAILED (\S+)", said, re.MULTILINE)
    if not case and fault:
        started = re.findall(r"\[ RUN      \] (\S+)", said[: fault.start()])
        case = re.search(r"(\S+)$", started[-1]) if started else None
    case = case or re.search(r"Test +#\d+: (\S+) \.+\**(?:Failed|Timeout|Exception)", said)
    case = case or re.search(r"(\S+: (?:warning|error|fatal error): .*)", said)
    words = [case[1]] if case else []
    if fault:
        words.append((fault[1] or fault[2]).strip())
    if not words:
        words = (said.strip().splitlines() or ["no words"])[-1:]
    return ": ".join(words).replace("|", "/")[:MOST_LETTERS]


def tests(preset, suite, cases=()):
    """Builds and runs the tests of an executable: all, or those whose names hold one of the words `cases`."""
    settings = f"-DASTROLITH_CUDA=OFF -DASTROLITH_SHARED_DATA={shlex.quote(str(ROOT.parent / 'shared' / 'data'))}"
    if preset == "ci" and (ROOT / "build/python-venv").exists():
        settings += " -DASTROLITH_PYTHON=ON -DPython_EXECUTABLE=$PWD/build/python-venv/bin/python"
    targets = {"apps": PROGRAMS, "python": ["_synthesis_stub", "_estimation_stub", *PROGRAMS]}.get(suite, [f"{suite}_tests"])
    names = "(apps|program)" if suite == "apps" else suite
    shards = "[.]" if preset == "ci" else "[.]shard"
    filters = ":".join(f"*{case}*" for case in cases) or "*"
    run = f"GTEST_FILTER={shlex.quote(filters)} ctest --preset {preset} --stop-on-failure --no-tests=error -R '^{names}{shards}'"
    name = f"{suite} tests" + ("" if preset == "ci" else f", {preset}")
    return Check(name, f"scripts/build.sh {preset} {settings} {' '.join(targets)} && {run}")


def seeds_of(fuzzer):
    build = f"scripts/build.sh asan -DASTROLITH_CUDA=OFF fuzz_{fuzzer}"
    return Check(f"seeds of {fuzzer}, asan", f"{build} && ctest --preset asan --no-tests=error -R '^fuzz[.]{fuzzer}$'")


def static_checks(defect):
    file = shlex.quote(defect["file"])
    documents = ("scripts/check_docs.py", "scripts/recipe_reference.py --check", "scripts/summary_reference.py --check")
    checks = [Check("arrows", "scripts/check_arrows.sh"), Check("documents", " && ".join(documents))]
    if defect["file"].endswith((".h", ".cpp")):
        checks.insert(0, Check("clang-format", f"clang-format-14 --dry-run -Werror {file}"))
    # The preset of lint.py does not build the Python package.
    if defect["file"].endswith(".cpp") and not defect["file"].startswith("python/"):
        checks.append(Check("clang-tidy", f"scripts/lint.py {file}"))
    return checks


def room_of(file):
    return str(Path(file).parent)


def suite_of(room):
    while room not in SUITES and "/" in room:
        room = room.rpartition("/")[0]
    return SUITES.get(room)


def suites_that_include(room):
    """The suites of the rooms that may include this one, by the rows of check_arrows.sh."""

    def holds(name):  # "geometry" holds its rooms, "geometry/." does not
        return name in (room, room + "/.") or (not name.endswith("/.") and room.startswith(name + "/"))

    rows = re.findall(r"^(\S+) +-> (.*)$", (ROOT / "scripts/check_arrows.sh").read_text(), re.MULTILINE)
    suites = [suite_of(of) for of, names in rows if any(map(holds, names.split()))]
    return [suite for suite in dict.fromkeys(suites) if suite and suite != suite_of(room)]


def search(defect, near=False):
    """The checks that are tried on a defect, from the cheapest on."""
    yield from static_checks(defect)
    suite, cases = suite_of(room_of(defect["file"])), defect["cases"]
    if suite is None:
        return
    own = [("ci", cases), ("ci", ())] if cases else [("ci", ())]
    for kind, preset in (("memory", "asan"), ("races", "tsan")):
        if defect.get(kind):
            own += [(preset, cases)] if near and cases else [(preset, cases), (preset, ())]
    for preset, words in own:
        yield tests(preset, suite, tuple(words))
    if "fuzzer" in defect:
        yield seeds_of(defect["fuzzer"])
    if near:
        return
    if defect["file"].startswith(("numerics", "recipe", "geometry", "gravity", "descriptor", "synthesis", "cuda")):
        build = tests("ci", "apps").command.partition(" && ctest")[0]
        yield Check("C library", f"{build} && scripts/check_libm.sh build/ci")
    if "elsewhere" in defect:  # what the room's own tests leave to another suite
        yield tests("ci", defect["elsewhere"], tuple(cases))
    for other in suites_that_include(room_of(defect["file"])):
        yield tests("ci", other)


# ---- the copy ---------------------------------------------------------------------------------------------------------


def git(*arguments, where=ROOT):
    return subprocess.run(["git", *arguments], cwd=where, check=True, text=True, stdout=subprocess.PIPE).stdout.strip()


class Copy:
    """A worktree. Without a folder to keep it in it goes at the end."""

    def __init__(self, revision, kept):
        self.revision = git("rev-parse", revision)
        self.folder = None if kept else tempfile.mkdtemp(prefix="planted_")
        self.tree = kept.resolve() if kept else Path(self.folder) / "tree"

    def __enter__(self):
        if self.tree.exists():
            self.restore()
            return self
        git("worktree", "add", "--quiet", "--detach", str(self.tree), self.revision)
        (self.tree / "build").mkdir()
        for there in ("data-cache", "build/python-venv"):  # made once, by fetch_data.sh and python_venv.sh
            if (ROOT / there).exists():
                (self.tree / there).symlink_to((ROOT / there).resolve())
        return self

    def __exit__(self, *_):
        if self.folder:
            git("worktree", "remove", "--force", str(self.tree))
            shutil.rmtree(self.folder)

    def plant(self, defect, commit=False):
        file = self.tree / defect["file"]
        text = file.read_text()
        if text.count(defect["before"]) != 1:
            sys.exit(f"planted_defects.py: {defect['name']} cannot be planted in {self.revision}; choose another --revision")
        file.write_text(text.replace(defect["before"], defect["after"]))
        if commit:
            author = ("-c", "user.name=planted", "-c", "user.email=planted@localhost")
            git(*author, "commit", "-qam", defect["name"], where=self.tree)

    def restore(self):
        git("reset", "--quiet", "--hard", self.revision, where=self.tree)


# ---- the rows ---------------------------------------------------------------------------------------------------------


class Trial:
    """Tries defects on a copy."""

    def __init__(self, copy):
        self.copy, self.sound = copy, {}

    def is_sound(self, check):
        """Whether a check passes without a defect. It is run once."""
        if check not in self.sound:
            self.sound[check], case = run_check(check, self.copy.tree)
            if not self.sound[check]:
                print(f"   {check.name} fails without a defect, too: {case}", file=sys.stderr, flush=True)
        return self.sound[check]

    def finder(self, defect, checks, commit=False):
        """The name of the first check that fails, and its first case."""
        for check in checks:
            if not self.sound.get(check, True):
                continue
            self.copy.plant(defect, commit)
            passes, case = run_check(check, self.copy.tree)
            self.copy.restore()
            print(f"   {check.name}: {'passes' if passes else case}", file=sys.stderr, flush=True)
            if not passes and self.is_sound(check):
                return check.name, case
        return NOT_FOUND, ""


def faults_of(table):
    """What is wrong with the table: one line each."""
    names = [defect["name"] for defect in table]
    for defect in table:
        file = ROOT / defect["file"]
        count = file.read_text().count(defect["before"]) if file.is_file() else 0
        if count != 1:
            yield f"{defect['name']}: its text stands {count} times in {defect['file']}; bring the row up to date"
        if defect["before"] == defect["after"]:
            yield f"{defect['name']}: changes nothing"
        if names.count(defect["name"]) > 1:
            yield f"{defect['name']}: two defects have this name"


def chosen(table, only):
    unknown = set(only) - {defect["name"] for defect in table}
    if unknown:
        sys.exit(f"planted_defects.py: there is no defect {', '.join(sorted(unknown))}; --list names all")
    return [defect for defect in table if not only or defect["name"] in only]


def done_in(output):
    lines = output.read_text().splitlines() if output and output.exists() else []
    return {line.split("|")[1].strip() for line in lines if line.startswith("| ")}


def try_all(defects, arguments):
    with Copy(arguments.revision, arguments.kept) as copy:
        trial = Trial(copy)
        for defect in defects:
            print(f"{defect['name']}: {defect['kind']}", file=sys.stderr, flush=True)
            start = time.monotonic()
            checks = [Check(arguments.by, arguments.by, 4 * 3600)] if arguments.by else search(defect, arguments.near)
            name, case = trial.finder(defect, checks, commit=bool(arguments.by))
            row = [defect["name"], defect["kind"], defect["file"], name, case, f"{time.monotonic() - start:.0f}"]
            yield "| " + " | ".join(row) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--only", action="append", default=[], metavar="NAME")
    parser.add_argument("--by", metavar="COMMAND", help="a command of the checkout; the defect is committed before it runs")
    parser.add_argument("--near", action="store_true")
    parser.add_argument("--in", dest="kept", type=Path, metavar="FOLDER")
    parser.add_argument("--revision", default="HEAD", help="the commit that is copied")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE.md", help="gets each row as soon as it is known")
    arguments = parser.parse_args()
    table = tomllib.loads(TABLE.read_text())["defect"]
    defects = chosen(table, arguments.only)
    if arguments.list:
        for defect in defects:
            print(f"{defect['name']:32} {defect['kind']:42} {defect['file']}")
        return
    # The checks that run in a copy may include this one.
    faults = [] if os.environ.get("ASTROLITH_PLANTED") else list(faults_of(table))
    if faults:
        sys.exit("\n".join(faults))
    if arguments.check:
        print(f"planted_defects.py: {len(table)} defects can be planted")
        return
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # the copy goes then, too
    output, done = arguments.output, done_in(arguments.output)
    if not output or not output.exists():
        print(HEADER, end="", file=output.open("w") if output else sys.stdout)
    for row in try_all([defect for defect in defects if defect["name"] not in done], arguments):
        print(row, file=output.open("a") if output else sys.stdout, flush=True)


if __name__ == "__main__":
    main()
