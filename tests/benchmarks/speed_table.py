#!/usr/bin/env python3
"""The figures of docs/performance.md in one run: ratio, ours, and the peer's.

    speed_table.py BUILD [--fastnoise2 SOURCES] [--only noise terrain ...] [--turns 5] [--full]

BUILD is a build folder made with -DASTROLITH_BENCHMARKS=ON. Ours and a peer run in turn, one thread each. A figure is the
median over the turns, and a ratio the median of the ratios of the pairs. All seconds are those of the processor.

Peers come from packages: pip install numpy terraingenpy scikit-learn scipy. A peer that is not installed is left out, with a word.
FastNoise2 is in no package: SOURCES is a folder that holds FastNoise2 and FastSIMD side by side, where it is built the first
time. --full adds meshes of 10 and 30 million triangles (minutes).
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
from statistics import median

import asteroid_recipe
import terrain_peers

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent


class Run:
    """A command that has ended: its output, seconds of the processor, and most bytes of memory."""

    def __init__(self, *command, check=True):
        with tempfile.TemporaryFile() as output, tempfile.TemporaryFile() as errors:
            child = subprocess.Popen([str(c) for c in command], stdout=output, stderr=errors)
            _, status, used = os.wait4(child.pid, 0)
            child.returncode = os.waitstatus_to_exitcode(status)
            output.seek(0), errors.seek(0)
            self.output, self.errors = output.read().decode(), errors.read().decode()
        self.failed = child.returncode != 0
        self.seconds, self.bytes = used.ru_utime + used.ru_stime, used.ru_maxrss * 1024
        if self.failed and check:
            sys.exit(f"{' '.join(map(str, command))}: {self.errors.strip()}")

    def rows(self):
        return [json.loads(line) for line in self.output.splitlines()]


def peer_rows(name, *command):
    """The rows that a peer prints; None where it is not installed."""
    run = Run(*command, check=False)
    if not run.failed:
        return run.rows()
    words = run.errors.strip().splitlines()
    print(f"  {name} left out: {words[-1] if words else 'it failed'}", flush=True)
    return None


def number(value):
    return "–" if value is None else f"{value:.0f}" if value >= 100 else f"{value:.3g}"


class Table:
    def __init__(self, title, unit, peer):
        print(f"\n{title}\n\n| {unit} | ratio | ours | {peer} |\n|---|---|---|---|")

    def row(self, name, ours, theirs, higher_is_better=True):
        """Medians of the turns of both; the ratio says how many times better ours is."""
        ratio = None
        if theirs and all(value is not None for value in theirs):
            pairs = zip(ours, theirs) if higher_is_better else zip(theirs, ours)
            ratio = median(a / b for a, b in pairs)
        peer = median(theirs) if ratio is not None else None
        print(f"| {name} | {'–' if ratio is None else f'{ratio:.2f}'} | {number(median(ours))} | {number(peer)} |",
              flush=True)


class Benchmark:
    def __init__(self, build, fastnoise2, turns, folder):
        self.build, self.tools, self.fastnoise2 = build, build / "tests/benchmarks", fastnoise2
        self.turns, self.folder = turns, folder

    def noise(self):
        ours, theirs = [], []
        for _ in range(self.turns):
            ours.append({row["noise"]: row for row in Run(self.tools / "noise_benchmark").rows()})
            if self.fastnoise2 and theirs is not None:
                made = peer_rows("FastNoise2", sys.executable, HERE / "noise_peers.py", self.fastnoise2)
                theirs = None if made is None else theirs + [{row["noise"]: row["rows"] for row in made}]
        table = Table("Noise on 256^3 points, Mpoint/s", "noise, order of points", "FastNoise2 1.1.1")
        for name in ours[0]:
            peers = [turn[name] for turn in theirs] if theirs else None
            for order in ("rows", "blocks"):
                table.row(f"{name}, {order}", [turn[name][order] for turn in ours], peers)

    def gabor(self):
        turns = [Run(self.tools / "gabor_noise_benchmark").rows() for _ in range(self.turns)]
        table = Table("Gabor noise, one band, 32 impulses, M/s", "bandwidth", "no peer")
        for i, row in enumerate(turns[0]):
            for kind in ("texture", "surface"):
                table.row(f"{kind}, {row['bandwidth']}", [turn[i][kind] for turn in turns], None)

    def terrain(self, targets):
        like_it = self.folder / "like_it.json"
        like_it.write_text(json.dumps(terrain_peers.recipe_like_it()))
        recipes = {"fitted Itokawa with details": ROOT / "synthesis/examples/itokawa_details.json", "a body like it": like_it}
        table = Table("A finished body in a file, seconds (ours PLY, the peer's GLB)", "triangles, our body", "TerrainGen 0.2")
        for triangles in targets:
            seconds, peers, memory = {name: [] for name in recipes}, [], {}
            for _ in range(self.turns):
                for name, recipe in recipes.items():
                    run, _ = self.mesh(recipe, triangles)
                    seconds[name].append(run.seconds)
                    memory[name] = run.bytes
                if terrain_peers.installed():
                    command, _ = terrain_peers.peer_command(triangles, self.folder)
                    run = Run(*command)
                    peers.append(run.seconds)
                    memory["TerrainGen"] = run.bytes
            for name in recipes:
                table.row(f"{triangles / 1e6:g} M, {name}", seconds[name], peers, higher_is_better=False)
            print(f"| {triangles / 1e6:g} M, memory | "
                  + ", ".join(f"{name} {used / 1e6:.0f} MB" for name, used in memory.items()) + " | | | |")

    def erosion(self, targets):
        settled = ROOT / "synthesis/examples/talus_slopes.json"
        steps, bare = self.folder / "steps.json", self.folder / "fresh.json"
        recipe = json.loads(settled.read_text())
        recipe["erosion"]["iterations"] = 50
        steps.write_text(json.dumps(recipe))
        del recipe["erosion"]
        bare.write_text(json.dumps(recipe))
        table = Table("Erosion of talus_slopes over its mesh, seconds", "triangles", "no peer")
        for triangles in targets:
            fresh = median(self.mesh(bare, triangles)[0].seconds for _ in range(self.turns))
            for name, file in (("50 steps", steps), ("until settled", settled)):
                runs = [self.mesh(file, triangles) for _ in range(self.turns)]
                table.row(f"{triangles / 1e6:g} M, {name}, {runs[0][1]['erosion']['sweeps']} sweeps",
                          [run.seconds - fresh for run, _ in runs], None)

    def mesh(self, recipe, triangles):
        output, summary = self.folder / "mesh.ply", self.folder / "summary.json"
        run = Run(self.build / "bin/synth", recipe, "-o", output, "--triangles", triangles, "--quiet", "--threads", 1,
                  "--summary", summary)
        output.unlink()
        return run, json.loads(summary.read_text())

    def pursuit(self):
        print("\nGabor pursuit of a photo's 32 x 32 corner, seconds to within 1e-3 and 1e-5 of the least, over ours\n")
        os.environ["OMP_NUM_THREADS"] = os.environ["OPENBLAS_NUM_THREADS"] = "1"
        problems = self.folder / "problems"
        problems.mkdir()
        Run(self.tools / "basis_pursuit_benchmark", ROOT / "data-cache/gravel.png", problems)
        run = Run(sys.executable, HERE / "pursuit_peers.py", problems, check=False)
        print(run.errors if run.failed else run.output, end="")

    def asteroid(self, kind, targets):
        recipe = self.folder / f"{kind}.json"
        recipe.write_text(json.dumps(asteroid_recipe.recipe(kind == "bare")))
        print(f"\nAsteroid, {kind}\n\n| triangles | seconds | microseconds a triangle | MB |\n|---|---|---|---|")
        for triangles in targets:
            runs = [self.mesh(recipe, triangles) for _ in range(self.turns if triangles <= 1_000_000 else 1)]
            seconds, made = median(run.seconds for run, _ in runs), runs[0][1]
            print(f"| {made['triangles'] / 1e6:.2f} M | {seconds:.1f} | {1e6 * seconds / made['triangles']:.1f} | "
                  f"{made['peak_bytes'] / 1e6:.0f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--fastnoise2", type=pathlib.Path, metavar="SOURCES")
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--full", action="store_true")
    sections = ("noise", "gabor", "terrain", "erosion", "pursuit", "asteroid")
    parser.add_argument("--only", nargs="+", choices=sections, default=sections, metavar="SECTION",
                        help="some of: " + ", ".join(sections))
    arguments = parser.parse_args()
    targets = [1_000_000] + ([10_000_000] if arguments.full else [])
    with tempfile.TemporaryDirectory() as name:
        benchmark = Benchmark(arguments.build, arguments.fastnoise2, arguments.turns, pathlib.Path(name))
        for section in arguments.only:
            if section == "asteroid":
                benchmark.asteroid("full", [1_000_000])
                benchmark.asteroid("bare", [300_000, 1_000_000] + (
                    [3_000_000, 10_000_000, 30_000_000] if arguments.full else []))
            elif section == "erosion":
                benchmark.erosion([100_000, 300_000, *targets])
            elif section == "terrain":
                benchmark.terrain(targets)
            else:
                getattr(benchmark, section)()


if __name__ == "__main__":
    main()
