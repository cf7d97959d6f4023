#!/usr/bin/env python3
"""An exemplar layer on bodies and in the plane: the scores of windows as large as the photo, against the photo.

    exemplar_windows.py build/release/bin PHOTO... [--body BODY.json ...] [--side 128] [--windows 30]

The layers are made of the square in the middle of each photo: the exemplar, and the image of random phases. A ball is
always measured. A body is as long as twelve squares. A window is a square in the tangent plane of a random vertex of the
bare body; its pixels are projected to the body. The last column is the mean square of the heights over the square's
variance, in the plane that of a plane of 16 x 16 squares. Needs the Python package of the build on PYTHONPATH, NumPy and
rasterio.
"""
import json
import pathlib
import tempfile

import astrolith
import numpy as np

from held_out_textures import Judge, Programs, read_grey
from measure import arguments_of, head, row

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


def print_row(name, place, windows, judge, variance=None):
    """The medians of the scores of windows of heights over the photo's mean."""
    scores = np.median([judge.score(judge.square.mean() + heights) for heights in windows], axis=0)
    square = np.mean([np.mean(heights**2) for heights in windows]) / judge.square.var() if variance is None else variance
    row(name, place, f"{scores[0]:.3f} / {scores[1]:.3f}", f"{square:.2f}")


def main():
    given = arguments_of(__doc__, "programs", "photos", side=128, windows=30,
                         body={"type": pathlib.Path, "action": "append", "default": []})  # fmt: skip
    bodies = {"sphere": BALL, **{file.stem: json.loads(file.read_text()) for file in given.body}}
    head("layer", "place", "values / filters", "variance")
    for photo in given.photos:
        image = read_grey(photo)
        y, x = (np.array(image.shape) - given.side) // 2
        judge = Judge(image[y:y + given.side, x:x + given.side])
        mean, wide = judge.square.mean(), np.zeros(2 * [16 * given.side])
        for model in ("exemplar", "phase"):
            with tempfile.TemporaryDirectory() as work:
                programs, name = Programs(given.programs, work), f"{photo.stem}, {model}"
                recipe, _ = programs.fit(judge.square, model)
                plane = [programs.texture(recipe, judge.square, seed) - mean for seed in range(1, given.windows + 1)]
                variance = np.var([programs.texture(recipe, wide, seed) for seed in (1, 2)])
                print_row(name, "plane", plane, judge, variance / judge.square.var())
                for body, content in bodies.items():
                    made, random = BodyWindows(content, recipe, given.side), np.random.default_rng(7)
                    print_row(name, body, [made.window(random) for _ in range(given.windows)], judge)


if __name__ == "__main__":
    main()
