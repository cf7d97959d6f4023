#!/usr/bin/env python3
"""Garbles meshes and gives them to every program that reads meshes: each must end in time, with status 0 or 2.

    garbled_meshes.py BIN SHAPES [--meshes 200] [--first 0] [--only PROGRAM ...] [--keep FOLDER]

BIN holds the programs, SHAPES the measured shapes as binary .ply; those of at most 100 kB are taken. Mesh number n is
the same in every run: a shape, one of the ways to garble it below, and a share of its vertices or faces. check_tiles
gets tiles of a ball, one of which is garbled and certified as it is; its status 1 says that tiles do not join. Prints
a line for each run that breaks a limit and a table of the programs. Exit status 1 if a run took more than 20 s or 1 GB,
ended with another status than 0 and 2, or said its refusal in more than one line. Where other work shares the machine,
a run's time is what its threads took, if that is less. A fit has --time-limit 8. Ctrl-C prints the table so far. Needs
the Python package of the build on PYTHONPATH, and NumPy.
"""

import argparse
import collections
import hashlib
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

import astrolith
import numpy as np

SECONDS, BYTES, LARGEST_FILE = 20.0, 1e9, 100_000
SHARES = (0.001, 0.01, 0.1, 0.5, 1.0)
BODY = """{"format_version": 1, "length_unit": "km", "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1]]}}"""


class Mesh:
    """The vertices (n, 3) of a mesh as floats, and its triangles (m, 3)."""

    def __init__(self, file):
        mesh = astrolith.read_mesh(file)
        self.vertices, self.faces = np.array(mesh.vertices, "<f4"), np.array(mesh.faces, "<i4")

    def write(self, file):
        header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(self.vertices)}\n"
        header += "".join(f"property float {axis}\n" for axis in "xyz")
        header += f"element face {len(self.faces)}\nproperty list uchar int vertex_indices\nend_header\n"
        rows = np.empty(len(self.faces), [("count", "u1"), ("corners", "<i4", 3)])
        rows["count"], rows["corners"] = 3, self.faces
        file.write_bytes(header.encode() + self.vertices.astype("<f4").tobytes() + rows.tobytes())


# Ways to garble a mesh. Of vertices or of faces, `at` are the numbers of those that were chosen.
def moved(mesh, at, chance):
    """Vertices go to random places of the box."""
    mesh.vertices[at] = chance.uniform(mesh.vertices.min(0), mesh.vertices.max(0), (len(at), 3))


def exchanged(mesh, at, chance):
    """Vertices change places with one another."""
    mesh.vertices[at] = mesh.vertices[chance.permutation(at)]


def flung(mesh, at, chance):
    """Vertices are pushed up to 1e12 times as far out."""
    mesh.vertices[at] *= 10 ** chance.uniform(0, 12, (len(at), 1))


def flipped(mesh, at, chance):
    """A bit of each vertex changes."""
    mesh.vertices.view("<u4")[at, chance.integers(3, size=len(at))] ^= np.uint32(1) << chance.integers(32, size=len(at), dtype="u4")


def joined(mesh, at, chance):
    """Vertices become one point."""
    mesh.vertices[at] = mesh.vertices[at[0]]


def flattened(mesh, at, chance):
    """Vertices lose their third coordinate."""
    mesh.vertices[at, 2] = 0


def rewired(mesh, at, chance):
    """Corners of faces become random vertices."""
    mesh.faces[at, chance.integers(3, size=len(at))] = chance.integers(len(mesh.vertices), size=len(at))


def beyond(mesh, at, chance):
    """Corners of faces become numbers that no vertex has."""
    mesh.faces[at, chance.integers(3, size=len(at))] = chance.choice([-1, 2**31 - 1, 3 * len(mesh.vertices)], len(at))


def dropped(mesh, at, chance):
    """Faces are missing."""
    mesh.faces = np.delete(mesh.faces, at, axis=0)


def turned(mesh, at, chance):
    """Faces look inwards."""
    mesh.faces[at] = mesh.faces[at][:, ::-1]


def doubled(mesh, at, chance):
    """Faces are there twice."""
    mesh.faces = np.concatenate([mesh.faces, mesh.faces[at]])


WAYS = (moved, exchanged, flung, flipped, joined, flattened, rewired, beyond, dropped, turned, doubled)
OF_FACES = (rewired, beyond, dropped, turned, doubled)


def programs(bin_folder, folder, mesh, whole):
    """The runs of a mesh, by name."""
    def at(name):
        return str(bin_folder / name)

    out = ["-o", str(folder / "out.json")]
    tiny = ["--spheres", "20", "--time-limit", "8"]
    return {
        "describe": [at("describe"), mesh, "-o", str(folder / "out.npy")],
        "describe --surface": [at("describe"), mesh, "--surface", *out],
        "compare": [at("compare"), whole, mesh, "--realism", *out],
        "compare, first": [at("compare"), mesh, whole, "--realism", *out],
        "gravity": [at("gravity"), mesh, "--density", "2000", "-o", str(folder / "out.csv")],
        "fit_shape --base-only": [at("fit_shape"), mesh, *tiny, "--base-only", *out],
        "fit_shape, relief": [at("fit_shape"), mesh, *tiny, *out],
        "fit_shape, thesis": [at("fit_shape"), mesh, *tiny, "--generations", "1", *out],
        "fit_shape --packing-only": [at("fit_shape"), mesh, *tiny[:2], "--packing-only", "-o", str(folder / "out.csv")],
        "synth --vary": [at("synth"), str(folder / "ball.json"), "--vary", "0.2", "--target", mesh, "--write-recipe",
                         str(folder / "varied.json")],
    }


def check_tiles_run(bin_folder, folder, number):
    """Garbles one of two tiles of a ball and returns the run of check_tiles."""
    tiles = folder / "tiles"
    if not tiles.exists():
        tiles.mkdir()
        for i in (1, 2):
            subprocess.run([str(bin_folder / "synth"), str(folder / "ball.json"), "--resolution", "24", "--tile",
                            f"{i}/2", "-o", str(tiles / f"{i}.ply"), "--summary", str(tiles / f"{i}.json"), "--quiet"],
                           check=True)
        (tiles / "2.ply").rename(folder / "whole_tile.ply")
    garble(folder / "whole_tile.ply", number, tiles / "2.ply")
    summary = json.loads((tiles / "2.json").read_text())
    tile = summary["tile"]
    tile["file_sha256"] = hashlib.sha256((tiles / "2.ply").read_bytes()).hexdigest()
    del tile["checksum"]
    tile["checksum"] = hashlib.sha256(json.dumps(tile, separators=(",", ":")).encode()).hexdigest()
    (tiles / "2.json").write_text(json.dumps(summary))
    return [str(bin_folder / "check_tiles"), str(tiles / "1.json"), str(tiles / "2.json"), "--meshes", str(tiles)]


def garble(file, number, output):
    """Writes the garbled mesh of this number and says what was done."""
    chance = np.random.default_rng(number)
    way, share = WAYS[number % len(WAYS)], SHARES[number // len(WAYS) % len(SHARES)]
    mesh = Mesh(file)
    count = len(mesh.faces if way in OF_FACES else mesh.vertices)
    way(mesh, chance.choice(count, max(1, int(share * count)), replace=False), chance)
    mesh.write(output)
    return f"{file.name} {way.__name__} {share:g}"


def run(command):
    """Status, seconds, bytes and the lines on stderr. Well past the limit the system ends the run."""
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (int(2 * SECONDS), int(2 * SECONDS)))

    start = time.monotonic()
    with tempfile.TemporaryFile() as words:
        process = subprocess.Popen([*command, "--quiet"], stdout=subprocess.DEVNULL, stderr=words, preexec_fn=limit)
        _, status, usage = os.wait4(process.pid, 0)
        seconds = min(time.monotonic() - start, usage.ru_utime + usage.ru_stime)
        process.returncode = os.waitstatus_to_exitcode(status)
        words.seek(0)
        lines = words.read().decode(errors="replace").splitlines()
    return process.returncode, seconds, 1024 * usage.ru_maxrss, lines


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("shapes", type=pathlib.Path)
    parser.add_argument("--meshes", type=int, default=200)
    parser.add_argument("--first", type=int, default=0, help="number of the first mesh")
    parser.add_argument("--only", nargs="+", default=[], help="programs to run")
    parser.add_argument("--keep", type=pathlib.Path, help="keep the garbled meshes that break a limit here")
    arguments = parser.parse_args()
    shapes = sorted(f for f in arguments.shapes.glob("*.ply") if f.stat().st_size <= LARGEST_FILE)
    statuses, most = collections.defaultdict(collections.Counter), collections.defaultdict(lambda: [0.0, 0.0])
    broken = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "ball.json").write_text(BODY)
        try:
            for number in range(arguments.first, arguments.first + arguments.meshes):
                shape, mesh = shapes[number % len(shapes)], folder / "garbled.ply"
                what = f"{number}: {garble(shape, number, mesh)}"
                runs = programs(arguments.bin, folder, str(mesh), str(shape))
                runs["check_tiles"] = check_tiles_run(arguments.bin, folder, number)
                for program, command in runs.items():
                    if arguments.only and program not in arguments.only:
                        continue
                    status, seconds, size, lines = run(command)
                    statuses[program][status] += 1
                    most[program] = [max(most[program][0], seconds), max(most[program][1], size)]
                    told = program == "check_tiles" or len(lines) == (status == 2)
                    fine = status in (0, 2) or (program == "check_tiles" and status == 1)
                    if fine and told and seconds <= SECONDS and size <= BYTES:
                        continue
                    broken += 1
                    figures = f"status {status}, {seconds:.1f} s, {size / 1e6:.0f} MB"
                    print(f"{what}: {program}: {figures}, {lines[-1:]}", flush=True)
                    if arguments.keep:
                        arguments.keep.mkdir(exist_ok=True)
                        garble(shape, number, arguments.keep / f"{number}.ply")
        except KeyboardInterrupt:
            print("stopped; the table holds the runs so far")
    print(f"\n{'program':26} {'status 0':>8} {'status 2':>8} {'other':>6} {'seconds':>8} {'MB':>6}")
    for program, counts in statuses.items():
        other = counts.total() - counts[0] - counts[2]
        seconds, megabytes = most[program][0], most[program][1] / 1e6
        print(f"{program:26} {counts[0]:8} {counts[2]:8} {other:6} {seconds:8.1f} {megabytes:6.0f}")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
