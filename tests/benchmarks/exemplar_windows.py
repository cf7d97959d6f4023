#!/usr/bin/env python3
"""An exemplar layer on bodies and in the plane: the scores of windows as large as the photo, against the photo.

    exemplar_windows.py build/release/bin PHOTO... [--body BODY.json ...] [--side 128] [--windows 30]

The layers are made of the square in the middle of each photo: the exemplar, and the image of random phases. A ball is
always measured. A body is as long as twelve squares. A window is a square in the tangent plane of a random vertex of the
bare body; its pixels are projected to the body. The last column is the mean square of the heights over the square's
variance, in the plane that of a plane of 16 x 16 squares. Needs the Python package of the build on PYTHONPATH, NumPy and
rasterio.
"""
import argparse
import json
import pathlib
import tempfile

import astrolith
import numpy as np

from held_out_textures import Judge, Programs, read_grey

BALL = {"format_version": 1, "length_unit": "m", "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1]]}}


class BodyWindows:
    """A body under the layer of a recipe. Heights are those of the layer alone, in grey values."""

    def __init__(self, body, recipe, side):
        bare = {key: value for key, value in body.items() if key != "layers"}
        self.bare = astrolith.Field(bare)
        self.vertices = np.asarray(astrolith.mesh(bare, resolution=64).vertices)
        pixel = np.ptp(self.vertices, axis=0).max() / (12 * side)
        laid = json.loads(recipe.read_text())
        layer = laid["layers"][0]
        self.grey = pixel / layer["height_rms"]  # a deviation of one pixel changes no surface by much
        layer["pixel_size"] = layer["height_rms"] = pixel
        file = recipe.with_name("laid.json")
        file.write_text(json.dumps({**laid, "length_unit": bare["length_unit"], "body": bare["body"], "layers": [layer]}))
        self.field = astrolith.Field(file)
        at = pixel * (np.arange(side) + 0.5 - 0.5 * side)
        self.plane = np.stack(np.meshgrid(at, at), axis=-1).reshape(-1, 2)

    def window(self, random):
        middle = self.vertices[random.integers(len(self.vertices))]
        normal = self.bare.gradient(middle[None])[0]
        normal /= np.linalg.norm(normal)
        east = np.cross(normal, [0, 0, 1] if abs(normal[2]) < 0.99 else [0, 1, 0])
        east /= np.linalg.norm(east)
        points = middle + self.plane @ np.stack([east, np.cross(normal, east)])
        for _ in range(3):
            gradient = self.bare.gradient(points)
            points -= (self.bare.value(points) / np.sum(gradient**2, axis=1))[:, None] * gradient
        side = int(len(points) ** 0.5)
        return ((self.field.value(points) - self.bare.value(points)) / self.grey).reshape(side, side)


def row(name, place, windows, judge, variance=None):
    """The medians of the scores of windows of heights over the photo's mean."""
    mean = judge.square.mean()
    scores = np.median([judge.score(mean + heights) for heights in windows], axis=0)
    square = np.mean([np.mean(heights**2) for heights in windows]) / judge.square.var() if variance is None else variance
    print(f"| {name} | {place} | {scores[0]:.3f} / {scores[1]:.3f} | {square:.2f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("photos", type=pathlib.Path, nargs="+")
    parser.add_argument("--body", type=pathlib.Path, action="append", default=[])
    parser.add_argument("--side", type=int, default=128)
    parser.add_argument("--windows", type=int, default=30)
    options = parser.parse_args()
    bodies = {"sphere": BALL, **{file.stem: json.loads(file.read_text()) for file in options.body}}
    print("| layer | place | values / filters | variance |\n|---|---|---|---|")
    for photo in options.photos:
        image = read_grey(photo)
        y, x = (np.array(image.shape) - options.side) // 2
        judge = Judge(image[y:y + options.side, x:x + options.side])
        for model in ("exemplar", "phase"):
            with tempfile.TemporaryDirectory() as work:
                programs = Programs(options.programs, pathlib.Path(work))
                recipe, _ = programs.fit(judge.square, model)
                name = f"{photo.stem}, {model}"
                mean = judge.square.mean()
                plane = [programs.texture(recipe, judge.square, seed) - mean for seed in range(1, options.windows + 1)]
                wide = np.concatenate([programs.texture(recipe, np.zeros(2 * [16 * options.side]), seed).ravel() for seed in (1, 2)])
                row(name, "plane", plane, judge, wide.var() / judge.square.var())
                for body, content in bodies.items():
                    made, random = BodyWindows(content, recipe, options.side), np.random.default_rng(7)
                    row(name, body, [made.window(random) for _ in range(options.windows)], judge)


if __name__ == "__main__":
    main()
