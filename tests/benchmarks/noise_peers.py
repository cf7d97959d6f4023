#!/usr/bin/env python3
"""FastNoise2 on a grid of 256^3 points with one thread: Mpoints a second, one line of JSON a noise.

    noise_peers.py SOURCES      SOURCES: a folder that holds FastNoise2 and FastSIMD side by side

FastNoise2 comes in no package, so the script builds it in SOURCES/build the first time (some minutes).
"""
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def rates_program(sources):
    """Path of the compiled fastnoise2_rates.cpp."""
    build = sources / "build"
    if not (build / "build.ninja").exists():
        quietly("cmake", "-S", sources / "FastNoise2", "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                "-DFASTNOISE2_TOOLS=OFF", f"-DCPM_FastSIMD_SOURCE={sources / 'FastSIMD'}")
    quietly("cmake", "--build", build)
    library, = build.rglob("libFastNoise.a")
    program, source = build / "fastnoise2_rates", ROOT / "tests/benchmarks/fastnoise2_rates.cpp"
    if not program.exists() or program.stat().st_mtime < source.stat().st_mtime:
        quietly("c++", "-std=c++20", "-O3", "-DFASTNOISE_STATIC_LIB", f"-I{ROOT}", f"-I{sources / 'FastNoise2/include'}",
                f"-I{sources / 'FastSIMD/include'}", f"-I{build / 'include'}", source, library, "-o", program)
    return program


def quietly(*command):
    subprocess.run([str(c) for c in command], check=True, stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    print(subprocess.run([rates_program(pathlib.Path(sys.argv[1]).resolve())], check=True, text=True,
                         capture_output=True).stdout, end="")
