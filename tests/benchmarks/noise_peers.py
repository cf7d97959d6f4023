#!/usr/bin/env python3
"""FastNoiseSIMD, the forerunner of FastNoise2, on a grid of 256^3 points with one thread: Mpoints a second.

    noise_peers.py      needs: pip install numpy pyfastnoisesimd (built from source: numpy first, --no-build-isolation)
"""
import json
import time

import numpy as np

np.product = getattr(np, "product", np.prod)  # what the package asks for, and NumPy 2 left out
import pyfastnoisesimd as fns  # noqa: E402

SIDE = 256


def rate(noise_type, octaves=1):
    noise = fns.Noise(seed=1, numWorkers=1)
    noise.noiseType = noise_type
    noise.frequency = 0.02
    if octaves > 1:
        noise.fractal.octaves = octaves
        noise.fractal.lacunarity = 2.0
        noise.fractal.gain = 0.5
    noise.cell.returnType = fns.CellularReturnType.Distance
    noise.cell.distanceFunc = fns.CellularDistanceFunction.Euclidean
    best = float("inf")
    for _ in range(5):
        start = time.process_time()
        noise.genAsGrid([SIDE, SIDE, SIDE])
        best = min(best, time.process_time() - start)
    return round(SIDE**3 / best / 1e6, 1)


def main():
    print(json.dumps({"simd_level": fns.extension.SIMD_LEVEL if hasattr(fns, "extension") else "?",
                      "simplex": rate(fns.NoiseType.Simplex), "perlin": rate(fns.NoiseType.Perlin),
                      "fbm": rate(fns.NoiseType.SimplexFractal, 5),
                      "worley_f1": rate(fns.NoiseType.Cellular)}))


if __name__ == "__main__":
    main()
