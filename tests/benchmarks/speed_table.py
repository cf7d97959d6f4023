#!/usr/bin/env python3
"""The figures of docs/performance.md in one run: ratio, ours, and the peer's.

    speed_table.py BUILD [--fastnoise2 SOURCES] [--only noise terrain ...] [--turns 5] [--full]

BUILD is a build folder made with -DASTROLITH_BENCHMARKS=ON. Ours and a peer run in turn, one thread each. A figure is the
median over the turns, and a ratio the median of the ratios of the pairs. All seconds are those of the processor.

Peers come from packages: pip install numpy terraingenpy scikit-learn scipy. A peer that is not installed is left out, with a word.
FastNoise2 is in no package: SOURCES is a folder that holds FastNoise2 and FastSIMD side by side, where it is built the first
time. --full adds meshes of 10 and 30 million triangles (minutes).
"""
import json
import os
import pathlib
import sys
import tempfile
from statistics import median

import peers
import recipes
from measure import HERE, ROOT, Run, arguments_of, head, row


def number(value):
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


class Table:
    def __init__(self, title, unit, peer):
        print(f"\n{title}\n")
        head(unit, "ratio", "ours", peer)

    def row(self, name, ours, theirs, higher_is_better=True):
        """Medians of the turns of both; the ratio says how many times better ours is."""
        if not theirs or None in theirs:
            return row(name, "–", number(median(ours)), "–")
        pairs = zip(ours, theirs) if higher_is_better else zip(theirs, ours)
        row(name, f"{median(a / b for a, b in pairs):.2f}", number(median(ours)), number(median(theirs)))


class Benchmark:
    def __init__(self, build, fastnoise2, turns, folder):
        self.build, self.tools, self.fastnoise2 = build, build / "tests/benchmarks", fastnoise2
        self.turns, self.folder = turns, folder

    def noise(self):
        ours, theirs = [], []
        for _ in range(self.turns):
            ours.append({made["noise"]: made for made in Run(self.tools / "noise_benchmark").rows()})
            if self.fastnoise2:
                made = Run(peers.fastnoise2_rates(self.fastnoise2)).rows()
                theirs.append({peer["noise"]: peer["rows"] for peer in made})
        table = Table("Noise on 256^3 points, Mpoint/s", "noise, order of points", "FastNoise2 1.1.1")
        for name in ours[0]:
            for order in ("rows", "blocks"):
                table.row(f"{name}, {order}", [turn[name][order] for turn in ours], [turn[name] for turn in theirs])

    def gabor(self):
        turns = [Run(self.tools / "noise_benchmark", "--gabor").rows() for _ in range(self.turns)]
        table = Table("Gabor noise, one band, 32 impulses, M/s", "bandwidth", "no peer")
        for i, band in enumerate(turns[0]):
            for kind in ("texture", "surface"):
                table.row(f"{kind}, {band['bandwidth']}", [turn[i][kind] for turn in turns], None)

    def terrain(self, targets):
        like_it = self.folder / "like_it.json"
        like_it.write_text(json.dumps(peers.recipe_like_it()))
        bodies = {"fitted Itokawa with details": ROOT / "synthesis/examples/itokawa_details.json", "a body like it": like_it}
        table = Table("A finished body in a file, seconds (ours PLY, the peer's GLB)", "triangles, our body", "TerrainGen 0.2")
        for triangles in targets:
            seconds, theirs, memory = {name: [] for name in bodies}, [], {}
            for _ in range(self.turns):
                for name, recipe in bodies.items():
                    run, _ = self.mesh(recipe, triangles)
                    seconds[name].append(run.seconds)
                    memory[name] = run.bytes
                if peers.installed():
                    command, _ = peers.peer_command(triangles, self.folder)
                    run = Run(*command)
                    theirs.append(run.seconds)
                    memory["TerrainGen"] = run.bytes
            for name in bodies:
                table.row(f"{triangles / 1e6:g} M, {name}", seconds[name], theirs, higher_is_better=False)
            row(f"{triangles / 1e6:g} M, memory", ", ".join(f"{name} {used / 1e6:.0f} MB" for name, used in memory.items()), "", "")

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
        print(run.errors if run.status else run.output, end="")

    def asteroid(self, kind, targets):
        recipe = self.folder / f"{kind}.json"
        recipe.write_text(json.dumps(recipes.asteroid(kind == "bare")))
        print(f"\nAsteroid, {kind}\n")
        head("triangles", "seconds", "microseconds a triangle", "MB")
        for triangles in targets:
            runs = [self.mesh(recipe, triangles) for _ in range(self.turns if triangles <= 1_000_000 else 1)]
            seconds, made = median(run.seconds for run, _ in runs), runs[0][1]
            row(f"{made['triangles'] / 1e6:.2f} M", f"{seconds:.1f}", f"{1e6 * seconds / made['triangles']:.1f}",
                f"{made['peak_bytes'] / 1e6:.0f}")


SECTIONS = ("noise", "gabor", "terrain", "erosion", "pursuit", "asteroid")


def main():
    given = arguments_of(__doc__, "build", fastnoise2={"type": pathlib.Path, "metavar": "SOURCES"}, turns=5,
                         full={"action": "store_true"}, only={"nargs": "+", "choices": SECTIONS, "default": SECTIONS})
    targets = [1_000_000] + ([10_000_000] if given.full else [])
    with tempfile.TemporaryDirectory() as name:
        benchmark = Benchmark(given.build, given.fastnoise2, given.turns, pathlib.Path(name))
        for section in given.only:
            if section == "asteroid":
                benchmark.asteroid("full", [1_000_000])
                benchmark.asteroid("bare", [300_000, 1_000_000] + ([3_000_000, 10_000_000, 30_000_000] if given.full else []))
            elif section == "erosion":
                benchmark.erosion([100_000, 300_000, *targets])
            elif section == "terrain":
                benchmark.terrain(targets)
            else:
                getattr(benchmark, section)()


if __name__ == "__main__":
    main()
