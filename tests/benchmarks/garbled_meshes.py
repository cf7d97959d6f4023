#!/usr/bin/env python3
"""Garbles meshes and gives them to every program that reads meshes: each must end in time, with status 0 or 2.

    garbled_meshes.py BIN SHAPES [--meshes 200] [--first 0] [--only PROGRAM ...] [--keep FOLDER]

BIN holds the programs, SHAPES the measured shapes as binary .ply; those of at most 100 kB are taken. Mesh number n is
the same in every run: a shape, one of the ways to garble it below, and a share of its vertices or faces. check_tiles
gets tiles of a ball, one of which is garbled and certified as it is; its status 1 says that tiles do not join. Prints
a line for each run that breaks a limit and a table of the programs. Exit status 1 if a run took more than 20 s or 1 GB,
ended with another status than 0 and 2, or said its refusal in more than one line. Where other work shares the machine,
a run's time is what its threads took, if that is less. A fit has --time-limit 8. Ctrl-C prints the table so far.
"""

import argparse
import array
import collections
import hashlib
import json
import os
import pathlib
import random
import resource
import subprocess
import sys
import tempfile
import time

SECONDS, BYTES, LARGEST_FILE = 20.0, 1e9, 100_000
SHARES = (0.001, 0.01, 0.1, 0.5, 1.0)
BODY = """{"format_version": 1, "length_unit": "km", "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1]]}}"""


class Mesh:
    """A binary .ply whose vertices are floats, at least three, and whose faces are triangles."""

    def __init__(self, file):
        data = file.read_bytes()
        end = data.index(b"end_header\n") + len(b"end_header\n")
        self.header = data[:end].decode().splitlines()
        vertices, faces = (self.count(name) for name in ("vertex", "face"))
        before_faces = self.header[: next(i for i, line in enumerate(self.header) if "element face" in line)]
        self.floats = sum(line.startswith("property float") for line in before_faces)
        self.vertices = array.array("f", data[end : end + 4 * self.floats * vertices])
        start = end + 4 * self.floats * vertices
        self.faces = [list(array.array("i", data[start + 13 * f + 1 : start + 13 * f + 13])) for f in range(faces)]

    def count(self, name):
        return next(int(line.split()[2]) for line in self.header if line.startswith(f"element {name} "))

    def write(self, file):
        header = [f"element face {len(self.faces)}" if "element face" in line else line for line in self.header]
        rows = b"".join(b"\x03" + array.array("i", face).tobytes() for face in self.faces)
        file.write_bytes(("\n".join(header) + "\n").encode() + self.vertices.tobytes() + rows)

    def point(self, v):
        return slice(v * self.floats, v * self.floats + 3)

    def chosen(self, share, number, chance):
        return chance.sample(range(number), max(1, int(share * number)))

    def chosen_vertices(self, share, chance):
        return self.chosen(share, len(self.vertices) // self.floats, chance)

    def chosen_faces(self, share, chance):
        return self.chosen(share, len(self.faces), chance)


def moved(mesh, share, chance):
    """Vertices go to random places of the box."""
    axes = [mesh.vertices[axis :: mesh.floats] for axis in range(3)]
    box = [(min(axis), max(axis)) for axis in axes]
    for v in mesh.chosen_vertices(share, chance):
        mesh.vertices[mesh.point(v)] = array.array("f", [chance.uniform(low, high) for low, high in box])


def exchanged(mesh, share, chance):
    """Vertices change places with one another."""
    chosen = mesh.chosen_vertices(share, chance)
    points = [mesh.vertices[mesh.point(v)] for v in chosen]
    chance.shuffle(points)
    for v, point in zip(chosen, points):
        mesh.vertices[mesh.point(v)] = point


def flung(mesh, share, chance):
    """Vertices are pushed up to 1e12 times as far out."""
    for v in mesh.chosen_vertices(share, chance):
        factor = 10 ** chance.uniform(0, 12)
        mesh.vertices[mesh.point(v)] = array.array("f", [factor * x for x in mesh.vertices[mesh.point(v)]])


def flipped(mesh, share, chance):
    """A bit of each vertex changes."""
    data = bytearray(mesh.vertices.tobytes())
    for v in mesh.chosen_vertices(share, chance):
        bit = chance.randrange(96)
        data[4 * v * mesh.floats + bit // 8] ^= 1 << bit % 8
    mesh.vertices = array.array("f", bytes(data))


def joined(mesh, share, chance):
    """Vertices become one point."""
    chosen = mesh.chosen_vertices(share, chance)
    for v in chosen:
        mesh.vertices[mesh.point(v)] = mesh.vertices[mesh.point(chosen[0])]


def flattened(mesh, share, chance):
    """Vertices lose their third coordinate."""
    for v in mesh.chosen_vertices(share, chance):
        mesh.vertices[v * mesh.floats + 2] = 0.0


def rewired(mesh, share, chance):
    """Corners of faces become random vertices."""
    for f in mesh.chosen_faces(share, chance):
        mesh.faces[f][chance.randrange(3)] = chance.randrange(len(mesh.vertices) // mesh.floats)


def beyond(mesh, share, chance):
    """Corners of faces become numbers that no vertex has."""
    for f in mesh.chosen_faces(share, chance):
        mesh.faces[f][chance.randrange(3)] = chance.choice([-1, 2**31 - 1, len(mesh.vertices)])


def dropped(mesh, share, chance):
    """Faces are missing."""
    missing = set(mesh.chosen_faces(share, chance))
    mesh.faces = [face for f, face in enumerate(mesh.faces) if f not in missing]


def turned(mesh, share, chance):
    """Faces look inwards."""
    for f in mesh.chosen_faces(share, chance):
        mesh.faces[f].reverse()


def doubled(mesh, share, chance):
    """Faces are there twice."""
    mesh.faces += [mesh.faces[f] for f in mesh.chosen_faces(share, chance)]


WAYS = (moved, exchanged, flung, flipped, joined, flattened, rewired, beyond, dropped, turned, doubled)


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
    chance = random.Random(number)
    way, share = WAYS[number % len(WAYS)], SHARES[number // len(WAYS) % len(SHARES)]
    mesh = Mesh(file)
    way(mesh, share, chance)
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
