#!/usr/bin/env python3
"""A descent over a recipe whose ground is made for each picture (docs/cameras.md).

    PYTHONPATH=build/release/python python3 tests/benchmarks/descent.py RECIPE.json [--pictures 60] [--from 5000]
        [--to 20] [--detail 2] [--side 1024] [--folder FOLDER]

Prints for each picture the altitude, the finest cells, the triangles, and seconds of the clock and of processors; then
the sums. With --folder, pictures go there as 8-bit PGM, brighter by a gamma of 2.2.
"""

import argparse
import pathlib
import time

import astrolith
import numpy as np


def save(radiance, file):
    most = np.percentile(radiance, 99.5) or 1.0
    grey = (255 * np.clip(radiance / most, 0, 1) ** (1 / 2.2)).astype(np.uint8)
    file.write_bytes(b"P5 %d %d 255\n" % grey.shape[::-1] + grey.tobytes())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("recipe")
    parser.add_argument("--pictures", type=int, default=60)
    parser.add_argument("--from", dest="high", type=float, default=5000.0)
    parser.add_argument("--to", dest="low", type=float, default=20.0)
    parser.add_argument("--detail", type=float, default=2.0)
    parser.add_argument("--side", type=int, default=1024)
    parser.add_argument("--folder", type=pathlib.Path)
    given = parser.parse_args()
    clock, processors = time.perf_counter(), time.process_time()
    scene = astrolith.Scene(given.recipe, detail=given.detail)
    far = 1e3 * given.high
    top = far - scene.ranges((0.0, 0.0, far), [[0.0, 0.0, -1.0]]).range[0]
    place = np.array([0.0, 0.0, top])
    for number, height in enumerate(np.geomspace(given.high, given.low, given.pictures)):
        camera = astrolith.Camera(given.side, given.side, 1.4 * given.side)
        camera = camera.look_at(place + height * np.array([0.3, 0.1, 1.0]), place, up=(0, 1, 0))
        start, used = time.perf_counter(), time.process_time()
        finest = scene.look(camera)
        image = scene.image(camera, (1.0, 0.3, 0.6))
        print(
            f"{height:8.1f}  cells of {finest:.4f}  {time.perf_counter() - start:6.2f} s  {time.process_time() - used:6.2f} s of processors",
            flush=True,
        )
        if given.folder:
            given.folder.mkdir(parents=True, exist_ok=True)
            save(image.radiance, given.folder / f"descent_{number:02}.pgm")
    print(f"{given.pictures} pictures: {time.perf_counter() - clock:.1f} s, {time.process_time() - processors:.1f} s of processors")


if __name__ == "__main__":
    main()
