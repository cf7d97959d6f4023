"""What the tests share: examples, and the programs whose bytes the package repeats."""

import os
import pathlib
import signal
import subprocess

import pytest
from astrolith import _synthesis

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(autouse=True)
def ctrl_c_is_heeded():
    """A shell's background jobs begin with SIGINT ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def example():
    """Names an example recipe of the repository."""
    return lambda name: str(ROOT / "synthesis" / "examples" / f"{name}.json")


@pytest.fixture
def program(tmp_path):
    """Runs a program of ASTROLITH_BIN in a folder of its own: program("synth", argument, ...)."""
    folder = os.environ.get("ASTROLITH_BIN")
    if not folder:
        pytest.skip("ASTROLITH_BIN names no folder of programs")
    version = [os.path.join(folder, "synth"), "--version"]
    said = subprocess.run(version, check=True, capture_output=True, text=True).stdout.strip()
    if said != "synth " + _synthesis.version():
        pytest.skip(f"the programs are {said}, and the package is {_synthesis.version()}")

    def run(name, *arguments):
        command = [os.path.join(folder, name), *map(str, arguments), "--quiet"]
        return subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True).stdout

    return run
