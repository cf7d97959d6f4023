"""The rooms of the sources, which of them lately changed, and the suites of tests that belong to them."""

import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def arrows():
    """The rows of scripts/check_arrows.sh: {room: the names that it may include}."""
    text = (ROOT / "scripts/check_arrows.sh").read_text()
    return {room: names.split() for room, names in re.findall(r"^([a-z_/]+) +-> (.*)$", text, re.MULTILINE)}


def test_lists():
    """The files that name tests, without those of the benchmarks."""
    return [file for file in sorted(ROOT.glob("tests/**/CMakeLists.txt")) if "benchmarks" not in file.parts]


def suites():
    """The suites of tests: {name: the folder whose rooms it tests}. Folders without an executable hold scripts.

    The tests of benchmarks go with the benchmarks' build."""
    found = {}
    for file in test_lists():
        folder = file.parent.relative_to(ROOT / "tests").as_posix()
        for name in re.findall(r"^ *astrolith_test\((\w+)", file.read_text(), re.MULTILINE):
            found[name] = folder
        for name in re.findall(r"add_test\(NAME (\w+)[.]", file.read_text()):
            found.setdefault(name, folder)
    return found | {"python": "python", "fuzz": "fuzz"}


def targets(names):
    """What has to be built to run these suites."""
    text = "".join(file.read_text() for file in test_lists())
    executables = [f"{name}_tests" for name in names if re.search(rf"^ *astrolith_test\({name}\b", text, re.MULTILINE)]
    return executables + (["fuzzers"] if "fuzz" in names else [])


def executables(build):
    """The executables of GoogleTest cases in a build folder: {suite: file}."""
    return {name: file for name, folder in suites().items() if (file := build / "tests" / folder / f"{name}_tests").exists()}


def room_of(path):
    """The room of a source or of a test of it; None for other files."""
    folder = Path(path.removeprefix("tests/")).parent
    rooms = arrows()
    while str(folder) != "." and folder.as_posix() not in rooms:
        folder = folder.parent
    return folder.as_posix() if folder.as_posix() in rooms else None


def touched(commits):
    """The rooms that the last commits or the working tree touched, and apart those of which only the tests were touched.

    Where the history is shorter than that, all rooms."""
    changed = subprocess.run(["git", "diff", "--name-only", f"HEAD~{commits}"], cwd=ROOT, stdout=subprocess.PIPE,
                             stderr=subprocess.DEVNULL, text=True)  # fmt: skip
    if changed.returncode != 0:
        return set(arrows()), set()
    files = changed.stdout.split()
    sources = {room for file in files if not file.startswith("tests/") and (room := room_of(file))}
    return sources, {room for file in files if file.startswith("tests/") and (room := room_of(file))} - sources


def with_dependents(rooms):
    """All rooms whose sources changed, those that include them, however indirectly, and those whose tests changed."""
    rows = arrows()
    sources, tests_alone = rooms
    reached = set(sources)
    while True:
        names = {room for room, allowed in rows.items() if any(names_room(name, known) for name in allowed for known in reached)}
        if names <= reached:
            return reached | tests_alone
        reached |= names


def names_room(name, room):
    """Whether a name in a row of arrows stands for a room: "geometry" for it and all inside, "geometry/." for it alone."""
    return room == name.removesuffix("/.") if name.endswith("/.") else room == name or room.startswith(name + "/")


def suites_of(rooms):
    """The suites that test these rooms: for each room the one with the longest folder that holds it, and the seeds of fuzzers."""
    known = suites()
    found = {"fuzz"} & set(known)
    for room in rooms:
        holding = [name for name, folder in known.items() if room == folder or room.startswith(folder + "/")]
        if holding:
            longest = max(len(known[name]) for name in holding)
            found |= {name for name in holding if len(known[name]) == longest}
    return found
