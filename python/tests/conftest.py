"""What the tests share: examples, and the programs whose bytes the package repeats."""

import os
import pathlib
import signal
import struct
import subprocess
import zlib

import astrolith
import pytest
from astrolith import _synthesis

ROOT = pathlib.Path(__file__).resolve().parents[2]
# A long body. Fits and variations are measured on meshes of so many cells along the longest side, of which a long body
# makes few triangles: a fit takes half the time of one of a ball.
WORM = {"format_version": 1, "length_unit": "km",
        "body": {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2,
                 "spheres": [[1.2 * (k - 4.5), 0, 0, 0.8 + 0.1 * (k % 2)] for k in range(10)]}}  # fmt: skip
FAST = {"spheres": 12, "population": 4, "generations": 2, "noise_seeds": 0, "seed": 3}


def png_of(values):
    """The bytes of a grey PNG."""
    chunk = lambda name, data: struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    height, width = values.shape
    rows = b"".join(b"\0" + row.tobytes() for row in values)
    header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


@pytest.fixture(autouse=True)
def ctrl_c_is_heeded():
    """A shell's background jobs begin with SIGINT ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture(scope="session")
def worm():
    return astrolith.mesh(WORM, resolution=56)


@pytest.fixture(scope="session")
def fit_of_metres(worm):
    """A fit without details of a mesh that says that its unit is the metre, on one thread."""
    pytest.importorskip("astrolith._estimation")
    in_metres = astrolith.Mesh(worm.vertices, worm.faces, length_unit="m")
    return astrolith.fit_shape(in_metres, base_only=True, threads=1, **FAST)


@pytest.fixture(scope="session")
def varied():
    return astrolith.vary(WORM, 0.3, seed=4)


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
