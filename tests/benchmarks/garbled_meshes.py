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

import collections
import hashlib
import json
import pathlib
import sys
import tempfile

import astrolith
import numpy as np

from measure import Run, arguments_of

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

    # Ways to garble it. Of vertices or of faces, `at` are the numbers of those that were chosen.
    def moved(self, at, chance):
        """Vertices go to random places of the box."""
        self.vertices[at] = chance.uniform(self.vertices.min(0), self.vertices.max(0), (len(at), 3))

    def exchanged(self, at, chance):
        """Vertices change places with one another."""
        self.vertices[at] = self.vertices[chance.permutation(at)]

    def flung(self, at, chance):
        """Vertices are pushed up to 1e12 times as far out."""
        self.vertices[at] *= 10 ** chance.uniform(0, 12, (len(at), 1))

    def flipped(self, at, chance):
        """A bit of each vertex changes."""
        self.vertices.view("<u4")[at, chance.integers(3, size=len(at))] ^= np.uint32(1) << chance.integers(32, size=len(at), dtype="u4")

    def joined(self, at, chance):
        """Vertices become one point."""
        self.vertices[at] = self.vertices[at[0]]

    def flattened(self, at, chance):
        """Vertices lose their third coordinate."""
        self.vertices[at, 2] = 0

    def rewired(self, at, chance):
        """Corners of faces become random vertices."""
        self.faces[at, chance.integers(3, size=len(at))] = chance.integers(len(self.vertices), size=len(at))

    def beyond(self, at, chance):
        """Corners of faces become numbers that no vertex has."""
        self.faces[at, chance.integers(3, size=len(at))] = chance.choice([-1, 2**31 - 1, 3 * len(self.vertices)], len(at))

    def dropped(self, at, chance):
        """Faces are missing."""
        self.faces = np.delete(self.faces, at, axis=0)

    def turned(self, at, chance):
        """Faces look inwards."""
        self.faces[at] = self.faces[at][:, ::-1]

    def doubled(self, at, chance):
        """Faces are there twice."""
        self.faces = np.concatenate([self.faces, self.faces[at]])


OF_FACES = (Mesh.rewired, Mesh.beyond, Mesh.dropped, Mesh.turned, Mesh.doubled)
WAYS = (Mesh.moved, Mesh.exchanged, Mesh.flung, Mesh.flipped, Mesh.joined, Mesh.flattened, *OF_FACES)


def programs(bin_folder, folder, mesh, whole):
    """The runs of a mesh, by name."""
    out, csv, recipe = ["-o", folder / "out.json"], ["-o", folder / "out.csv"], folder / "varied.json"
    tiny = ["--spheres", 20, "--time-limit", 8]
    runs = {
        "describe": [mesh, "-o", folder / "out.npy"],
        "describe --surface": [mesh, "--surface", *out],
        "compare": [whole, mesh, "--realism", *out],
        "compare, first": [mesh, whole, "--realism", *out],
        "gravity": [mesh, "--density", 2000, *csv],
        "fit_shape --base-only": [mesh, *tiny, "--base-only", *out],
        "fit_shape, relief": [mesh, *tiny, *out],
        "fit_shape, thesis": [mesh, *tiny, "--generations", 1, *out],
        "fit_shape --packing-only": [mesh, *tiny[:2], "--packing-only", *csv],
        "synth --vary": [folder / "ball.json", "--vary", 0.2, "--target", mesh, "--write-recipe", recipe],
    }
    return {name: [bin_folder / name.split()[0].strip(","), *words] for name, words in runs.items()}


def check_tiles_run(bin_folder, folder, number):
    """Garbles one of two tiles of a ball and returns the run of check_tiles."""
    tiles = folder / "tiles"
    if not tiles.exists():
        tiles.mkdir()
        for i in (1, 2):
            Run(bin_folder / "synth", folder / "ball.json", "--resolution", 24, "--tile", f"{i}/2", "-o", tiles / f"{i}.ply",
                "--summary", tiles / f"{i}.json", "--quiet")  # fmt: skip
        (tiles / "2.ply").rename(folder / "whole_tile.ply")
    garble(folder / "whole_tile.ply", number, tiles / "2.ply")
    summary = json.loads((tiles / "2.json").read_text())
    tile = summary["tile"]
    tile["file_sha256"] = hashlib.sha256((tiles / "2.ply").read_bytes()).hexdigest()
    del tile["checksum"]
    tile["checksum"] = hashlib.sha256(json.dumps(tile, separators=(",", ":")).encode()).hexdigest()
    (tiles / "2.json").write_text(json.dumps(summary))
    return [bin_folder / "check_tiles", tiles / "1.json", tiles / "2.json", "--meshes", tiles]


def garble(file, number, output):
    """Writes the garbled mesh of this number and says what was done."""
    chance = np.random.default_rng(number)
    way, share = WAYS[number % len(WAYS)], SHARES[number // len(WAYS) % len(SHARES)]
    mesh = Mesh(file)
    count = len(mesh.faces if way in OF_FACES else mesh.vertices)
    way(mesh, chance.choice(count, max(1, int(share * count)), replace=False), chance)
    mesh.write(output)
    return f"{file.name} {way.__name__} {share:g}"


def keeps_the_limits(program, run, seconds):
    lines = len(run.errors.splitlines())
    if program == "check_tiles":
        said = run.status in (0, 1, 2)
    else:
        said = run.status in (0, 2) and lines == (run.status == 2)
    return said and seconds <= SECONDS and run.bytes <= BYTES


def main():
    given = arguments_of(__doc__, "bin", "shapes_folder", meshes=200, first=0, only={"nargs": "+", "default": []},
                         keep={"type": pathlib.Path, "help": "keep the garbled meshes that break a limit here"})  # fmt: skip
    shapes = sorted(f for f in given.shapes_folder.glob("*.ply") if f.stat().st_size <= LARGEST_FILE)
    runs_of, broken = collections.defaultdict(list), 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "ball.json").write_text(BODY)
        try:
            for number in range(given.first, given.first + given.meshes):
                shape, mesh = shapes[number % len(shapes)], folder / "garbled.ply"
                what = f"{number}: {garble(shape, number, mesh)}"
                runs = programs(given.bin, folder, mesh, shape)
                runs["check_tiles"] = check_tiles_run(given.bin, folder, number)
                for program, command in runs.items():
                    if given.only and program not in given.only:
                        continue
                    run = Run(*command, "--quiet", check=False, most_seconds=int(2 * SECONDS))
                    seconds = min(run.clock, run.seconds)
                    runs_of[program].append((run.status, seconds, run.bytes / 1e6))
                    if keeps_the_limits(program, run, seconds):
                        continue
                    broken += 1
                    print(f"{what}: {program}: status {run.status}, {seconds:.1f} s, {run.bytes / 1e6:.0f} MB, "
                          f"{run.errors.splitlines()[-1:]}", flush=True)
                    if given.keep:
                        given.keep.mkdir(exist_ok=True)
                        garble(shape, number, given.keep / f"{number}.ply")
        except KeyboardInterrupt:
            print("stopped; the table holds the runs so far")
    print(f"\n{'program':26} {'status 0':>8} {'status 2':>8} {'other':>6} {'seconds':>8} {'MB':>6}")
    for program, figures in runs_of.items():
        statuses, seconds, megabytes = zip(*figures)
        good, refused = statuses.count(0), statuses.count(2)
        print(f"{program:26} {good:8} {refused:8} {len(statuses) - good - refused:6} {max(seconds):8.1f} {max(megabytes):6.0f}")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
