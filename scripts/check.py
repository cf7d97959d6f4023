#!/usr/bin/env python3
"""Runs the checks of scripts/check_plan.toml: see scripts/check.sh."""

import os
import re
import shutil
import subprocess
import sys
import time
import tomllib
from pathlib import Path

sys.dont_write_bytecode = True
import touched_rooms  # noqa: E402  (beside this file)

ROOT = Path(__file__).resolve().parent.parent
PLAN = tomllib.loads((ROOT / "scripts/check_plan.toml").read_text())
SLICES = range(1, PLAN["slices"] + 1)
USAGE = f"one of: quick, slice K (K from 1 to {len(SLICES)}), all, plan [--hold BUILD]"
TOOLS = {"git": "git", "cmake": "cmake", "ninja": "ninja-build", "clang-format-14": "clang-format-14",
         "clang-tidy-14": "clang-tidy-14", "clang++-14": "clang-14"}  # fmt: skip
LONG = re.compile(r"Long(/\d+)?$|_long$")
THREADS = re.compile("|".join(PLAN["threads"]))
KINDS = {"short": {"threads", "plain"}, "threads": {"threads"}, "long": {"long"}, "all": {"threads", "plain", "long"}}


def fail(words):
    """Ends the program as every wrong use of it does."""
    print(f"check.sh: {words}", file=sys.stderr)
    sys.exit(2)


def kind_of(case):
    """The kind of a test case, of which KINDS makes the words of the plan."""
    if LONG.search(case):
        return "long"
    return "threads" if THREADS.search(case) else "plain"


def share_out(suites, touched):
    """For each [[tests]] row, by its name: what it runs, as {suite: set of kinds}.

    A preset's rows come in turn, and each takes what the rows before it left."""
    shares, left = {}, {}
    for row in PLAN["tests"]:
        rest = left.setdefault(row["preset"], {suite: set(KINDS["all"]) for suite in suites})
        share = shares[row["name"]] = {}
        for suite in suites:
            is_program = suite in PLAN["programs"]
            if row["suites"] == ("libraries" if is_program else "programs"):
                continue
            if row["preset"] == "tsan" and suite in PLAN["not_threaded"]:
                continue
            if row.get("rooms") == "touched" and suite not in touched:
                continue
            if kinds := rest[suite] & KINDS[row["cases"]]:
                share[suite] = kinds
                rest[suite] -= kinds
    return shares


def filter_of(kinds):
    """The GTEST_FILTER that chooses the cases of some kinds."""
    threads, long = ":".join(f"*{word}*" for word in PLAN["threads"]), "*Long:*Long/*"
    return {("long", "plain", "threads"): "*", ("plain", "threads"): f"-{long}", ("threads",): f"{threads}-{long}",
            ("plain",): f"-{threads}:{long}", ("long",): long}[tuple(sorted(kinds))]  # fmt: skip


def run_cases(preset, share):
    """Builds the suites of one row and runs its cases; true if all pass."""
    if not share:
        return True
    # What tests of programs start is no dependency of the executables alone, so all is built for them.
    targets = [] if any(suite in PLAN["programs"] for suite in share) else touched_rooms.targets(share)
    if subprocess.run(["scripts/build.sh", preset, "-DASTROLITH_PYTHON=OFF", *targets], cwd=ROOT).returncode != 0:
        return False
    passed = True
    for kinds in sorted({tuple(sorted(kinds)) for kinds in share.values()}):
        # Two calls where thread cases ran elsewhere: no filter says "long ones, and those without threads".
        parts = [("plain",), ("long",)] if set(kinds) == {"plain", "long"} else [kinds]
        names = "|".join(suite for suite, its in share.items() if tuple(sorted(its)) == kinds)
        for part in parts:
            chosen = ["-R", f"^({names})[.]"]
            if "long" not in part:
                chosen += ["-E", "_long$"]
            elif part == ("long",):
                chosen = ["-R", f"^({names})[.](shard_[0-9]+|.*_long)$"]
            environment = dict(os.environ, GTEST_FILTER=filter_of(part))
            done = subprocess.run(["ctest", "--preset", preset, *chosen], cwd=ROOT, env=environment)
            passed &= done.returncode == 0
    return passed


def rows_of(place):
    """The rows of the plan that stand in "quick" or in a slice, in the order of the file."""
    return [row for row in ordered_rows() if row["in"] == place]


def ordered_rows():
    """All rows in the order of the file, which tomllib keeps for each of the two kinds only."""
    text = (ROOT / "scripts/check_plan.toml").read_text()
    names = re.findall(r'^name = "(.*)"$', text, re.MULTILINE)
    by_name = {row["name"]: row for row in PLAN["check"] + PLAN["tests"]}
    return [by_name[name] for name in names]


def run(places):
    """Runs all rows of these places; the first that fails ends the run. Prints how long each took."""
    for tool, package in TOOLS.items():
        if shutil.which(tool) is None:
            fail(f"{tool} is missing; run scripts/setup.sh --format --lint --sanitizers (Debian's package {package})")
    rooms = touched_rooms.with_dependents(touched_rooms.touched(PLAN["commits"]))
    shares = share_out(touched_rooms.suites(), touched_rooms.suites_of(rooms))
    times, failed = [], None
    for row in [row for place in places for row in rows_of(place)]:
        print(f"== {row['name']}", flush=True)
        start, before = time.monotonic(), os.times()
        if "command" in row:
            command = row["command"].replace("{touched}", " ".join(sorted(rooms)))
            passed = subprocess.run(["bash", "-e", "-o", "pipefail", "-c", command], cwd=ROOT).returncode == 0
        else:
            passed = run_cases(row["preset"], shares[row["name"]])
        after = os.times()
        processor = sum(after[2:4]) - sum(before[2:4])
        times.append(f"{row['name']:<34} {time.monotonic() - start:5.0f} s, {processor / 60:5.1f} processor minutes")
        if not passed:
            failed = row["name"]
            break
    print("\n" + "\n".join(times))
    total = os.times()
    print(f"{'together':<34} {sum(total[2:4]) / 60:22.1f} processor minutes")
    if failed:
        sys.exit(f"check.sh: {failed}: failed")


def print_plan():
    """Prints which check runs where."""
    for place in ("quick", *SLICES):
        print("quick" if place == "quick" else f"slice {place}")
        for row in rows_of(place):
            what = row.get("command") or f"{row['cases']} cases of {row['suites']}, preset {row['preset']}"
            print(f"  {row['name']:<34} {what if len(what) < 90 else what[:87] + '...'}")


def complaints(build):
    """What the plan leaves out, and what it names that does not exist, for the tests of a build."""
    suites = touched_rooms.suites()
    for name in PLAN["programs"] + PLAN["not_threaded"]:
        if name not in suites:
            yield f"no suite is called {name}"
    scripts = re.findall(r"Test +#\d+: (\S+)", subprocess.run(
        ["ctest", "-N"], cwd=build, stdout=subprocess.PIPE, text=True, check=True).stdout)  # fmt: skip
    cases = [(name.split(".")[0], name) for name in scripts if ".shard_" not in name]
    for suite, executable in touched_rooms.executables(build).items():
        listed = subprocess.run([executable, "--gtest_list_tests"], stdout=subprocess.PIPE, text=True, check=True).stdout
        group = ""
        for line in listed.splitlines():
            name = line.split("#")[0].rstrip()
            if not line.startswith(" "):
                group = name
                continue
            cases.append((suite, group + name.strip()))
    for suite, case in cases:
        if suite not in suites:
            yield f"{case}: no suite of the plan"
        if "DISABLED" in case:
            yield f"{case}: a test that is never run"
    for word in PLAN["threads"]:
        if not any(word in case for _, case in cases):
            yield f"threads: no test case is called *{word}*"
    for row in PLAN["check"] + PLAN["tests"]:
        if row["in"] != "quick" and row["in"] not in SLICES:
            yield f"{row['name']}: in = {row['in']} is neither quick nor a slice"
        for script in re.findall(r"scripts/\S+\.(?:sh|py)", row.get("command", "")):
            if not os.access(ROOT / script, os.X_OK):
                yield f"{row['name']}: {script} is no program"
    for touched in (set(), set(suites)):
        shares = share_out(suites, touched)
        for row in PLAN["tests"]:
            takes = [case for suite, case in cases if kind_of(case) in shares[row["name"]].get(suite, ())]
            if not takes and (row.get("rooms") != "touched" or touched) and row["preset"] == "ci":
                yield f"{row['name']}: takes no test case"
        taken = {(row["preset"], suite, kind) for row in PLAN["tests"] for suite, kinds in shares[row["name"]].items() for kind in kinds}
        for preset in ("ci", "asan"):
            for suite, case in cases:
                if suite in suites and (preset, suite, kind_of(case)) not in taken:
                    yield f"{case}: no row of the preset {preset} takes it"


def main(words):
    match words:
        case ["quick"]:
            run(["quick"])
        case ["slice", number] if number.isdigit() and int(number) in SLICES:
            run([int(number)])
        case ["all"]:
            run(["quick", *SLICES])
        case ["plan"]:
            print_plan()
        case ["plan", "--hold", build]:
            found = list(dict.fromkeys(complaints(Path(build))))
            print("\n".join(found), end="\n" if found else "")
            sys.exit(1 if found else 0)
        case ["-h"] | ["--help"]:
            print(Path(ROOT / "scripts/check.sh").read_text().split("set -euo")[0].replace("#!/usr/bin/env bash\n", "").replace("# ", ""))
        case _:
            fail(f"'{' '.join(words)}' is not {USAGE}")


if __name__ == "__main__":
    main(sys.argv[1:])
