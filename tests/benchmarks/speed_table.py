#!/usr/bin/env python3
"""All figures of docs/performance.md in one run: ours, a peer's beside it, and the ratio.

    speed_table.py BUILD [--full] [--fastnoise2 SOURCES]

BUILD is a build folder made with -DASTROLITH_BENCHMARKS=ON. Peers are left out, with a word, where their packages are not
installed: pip install numpy vtk. FastNoise2 comes in no package: SOURCES is a folder that holds FastNoise2 and FastSIMD side
by side. --full adds meshes of up to 30 million triangles (minutes).
"""
import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time
from statistics import median

HERE = pathlib.Path(__file__).parent


def run(*command):
    """Standard output, seconds on the clock and of the processor, and the most memory of any child so far."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    output = subprocess.run([str(c) for c in command], check=True, capture_output=True, text=True).stdout
    wall, after = time.perf_counter() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return output, wall, cpu


def json_lines(output):
    return [json.loads(line) for line in output.splitlines()]


def peer(script, *arguments):
    try:
        return json.loads(run(sys.executable, HERE / script, *arguments)[0])
    except subprocess.CalledProcessError as error:
        print(f"  {script} left out: {error.stderr.strip().splitlines()[-1]}")
        return None


def noise(tools, sources, turns=5):
    """Runs ours and FastNoise2 in turns; each figure is a median over the turns, the ratio that of a turn's pair."""
    print(f"Noise, Mpoint/s/core on 256^3, medians of {turns} turns: rows, blocks of 9^3, FastNoise2, ratios")
    ours, theirs = [], []
    for _ in range(turns):
        ours.append({row["noise"]: row for row in json_lines(run(tools / "noise_benchmark")[0])})
        if sources:
            theirs.append({row["noise"]: row["rows"]
                           for row in json_lines(run(sys.executable, HERE / "noise_peers.py", sources)[0])})
    for name in ours[0]:
        rows, blocks = ([turn[name][kind] for turn in ours] for kind in ("rows", "blocks"))
        line = f"  {name:10} {median(rows):7.1f} {median(blocks):7.1f}"
        if sources:
            peers = [turn[name] for turn in theirs]
            ratios = [median([mine / peer for mine, peer in zip(of_kind, peers)]) for of_kind in (rows, blocks)]
            line += f" {median(peers):7.1f} {ratios[0]:6.2f} {ratios[1]:6.2f}"
        print(line)


def gabor(tools):
    print("Gabor noise, 32 impulses, M/s/core by bandwidth: texture, Lagae, ratio; surface, Lagae, ratio")
    for row in json_lines(run(tools / "gabor_noise_benchmark")[0]):
        print("  " + " ".join(f"{value:8}" for value in row.values()))


def isosurface(tools, folder):
    print("Precomputed 512^3 field, Mtriangle/s/core: ours, VTK flying edges without and with normals, ratios")
    field = folder / "field.raw"
    ours = json.loads(run(tools / "isosurface_benchmark", 512, field)[0])
    theirs = peer("isosurface_peers.py", field)
    if theirs:
        mine = ours["mtriangles_per_s"]
        plain, normals = (theirs[k]["mtriangles_per_s"] for k in ("flying_edges", "flying_edges_with_normals"))
        print(f"  {mine} {plain} {normals} {mine / plain:.2f} {mine / normals:.2f}")
        if cubes := theirs["marching_cubes"]:
            print(f"  scikit-image's marching cubes: {cubes['mtriangles_per_s']}, ratio {mine / cubes['mtriangles_per_s']:.1f}")


def together(tools, folder):
    print("512^3, field and mesh together, seconds/core: sparse, dense field, flying edges, ratio")
    field = folder / "field.raw"
    run(tools / "asteroid_recipe", folder / "bare.json", "bare")
    ours = json.loads(run(tools / "dense_field_benchmark", folder / "bare.json", 512, field)[0])
    theirs = peer("isosurface_peers.py", field)
    if theirs:
        sparse, dense = ours["seconds_sparse"], ours["seconds_dense_field"]
        edges = theirs["flying_edges_with_normals"]["seconds"]
        print(f"  {sparse} {dense} {edges} {(dense + edges) / sparse:.2f}")


def pursuit(tools, folder, photo):
    print("Gabor pursuit of a photo's 32 x 32 corner, seconds to within 1e-3 and 1e-5 of the least, over ours")
    os.environ["OMP_NUM_THREADS"] = os.environ["OPENBLAS_NUM_THREADS"] = "1"
    run(tools / "basis_pursuit_benchmark", photo, "--side", 32, "--fista-seconds", 0, "--export", folder)
    print(run(sys.executable, HERE / "pursuit_peers.py", folder)[0], end="")


def asteroid(build, folder, kind, targets):
    recipe = folder / f"{kind}.json"
    run(build / "tests/benchmarks/asteroid_recipe", recipe, *(["bare"] if kind == "bare" else []))
    print(f"Asteroid, {kind}: triangles, seconds, processor seconds, us of it a triangle, MB at most")
    for triangles in targets:
        mesh, summary = folder / "mesh.ply", folder / "summary.json"
        _, wall, cpu = run(build / "bin/synth", recipe, "-o", mesh, "--triangles", triangles, "--quiet",
                           "--summary", summary)
        made = json.loads(summary.read_text())
        print(f"  {made['triangles']:9} {wall:7.1f} {cpu:7.1f} {1e6 * cpu / made['triangles']:6.1f} "
              f"{made['peak_bytes'] / 1e6:6.0f}", flush=True)
        os.remove(mesh)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--full", action="store_true")
    parser.add_argument("--fastnoise2", type=pathlib.Path, metavar="SOURCES")
    arguments = parser.parse_args()
    tools = arguments.build / "tests/benchmarks"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        noise(tools, arguments.fastnoise2)
        gabor(tools)
        isosurface(tools, folder)
        together(tools, folder)
        pursuit(tools, folder, HERE.parent.parent / "data-cache/gravel.png")
        asteroid(arguments.build, folder, "full", [1_000_000])
        if arguments.full:
            asteroid(arguments.build, folder, "bare", [300_000, 1_000_000, 3_000_000, 10_000_000, 30_000_000])


if __name__ == "__main__":
    main()
