#!/usr/bin/env python3
"""How like a photo the textures are that a square of it gives: our layers beside their peers.

    held_out_textures.py PROGRAMS PHOTO... [--side 256] [--seeds 3] [--json FILE]

PROGRAMS is the folder of fit_gabor and synth, such as build/release/bin. Four squares stand two by two in the middle of
a photo. Every method sees one of them and makes textures of its size, one for each seed. They are scored against the
square beside it, which no method has seen; each of the four is the seen one once:

    values   Wasserstein-1 distance of the grey values over their standard deviation
    filters  the same, as the mean over 12 filter responses: slopes and Laplacian after blurs of 1, 2, 4, 8 pixels

These are the scores of fit_gabor (estimation/gabor/exemplar/texture_score.h). The methods:

    real          the seen square itself
    random phase  its periodic component (Moisan 2011) with the phases of white noise (Galerne et al. 2011)
    blending      tiling and blending of its periodic component in the plane (Heitz and Neyret 2018)
    gabor, phase, exemplar  fit_gabor --model, then synth --texture
    auto          whichever of them fit_gabor --model auto takes for the seen square

The table has the means over the four. "worse" says by how many standard errors of the difference auto's sum of both scores
exceeds that of random phases, where it does. Nothing is set for a photo by itself. Needs NumPy and rasterio
(python/requirements.txt).
"""
import json
import pathlib
import tempfile
import warnings
from statistics import NormalDist

import numpy as np
import rasterio

from measure import Run, arguments_of, head, row

MODELS = ["gabor", "phase", "exemplar"]
METHODS = ["real", "random phase", "blending", *MODELS, "auto"]
warnings.filterwarnings("ignore", category=rasterio.errors.NotGeoreferencedWarning)


def read_grey(path):
    """The image as doubles, full scale 1 for whole numbers; colours become luma."""
    with rasterio.open(path) as image:
        bands = image.read()
        palette = image.colormap(1) if image.count == 1 and "palette" in str(image.colorinterp[0]) else None
    if palette:
        table = np.array([palette.get(i, (0, 0, 0, 255))[:3] for i in range(256)], dtype=np.uint8)
        bands = table[bands[0]].transpose(2, 0, 1)
    scale = np.iinfo(bands.dtype).max if np.issubdtype(bands.dtype, np.integer) else 1.0
    bands = bands.astype(float) / scale
    return bands[:3].transpose(1, 2, 0) @ [0.2126, 0.7152, 0.0722] if len(bands) >= 3 else bands[0]


def write_grey(path, values):
    """A PNG of 16 bits."""
    data = np.round(np.clip(values, 0, 1) * 65535).astype(np.uint16)
    with rasterio.open(path, "w", driver="PNG", width=data.shape[1], height=data.shape[0], count=1,
                       dtype="uint16") as image:
        image.write(data, 1)


def squares(photo, side):
    """Two by two squares in the middle of a photo, row by row; none where it is too small."""
    height, width = photo.shape
    if min(width, height) < 2 * side:
        return None
    x, y = width // 2 - side, height // 2 - side
    return [photo[v:v + side, u:u + side] for v in (y, y + side) for u in (x, x + side)]


def distance(values, reference):
    at = (np.arange(4096) + 0.5) / 4096
    return np.mean(np.abs(np.quantile(values, at) - np.quantile(reference, at))) / reference.std()


def blurred_inside(image, sigma):
    reach = int(np.ceil(3 * sigma))
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    weights /= weights.sum()
    for _ in range(2):
        count = image.shape[0] - 2 * reach
        image = sum(w * image[i:i + count] for i, w in enumerate(weights)).T
    return image


def filter_responses(image):
    for sigma in (1, 2, 4, 8):
        b = blurred_inside(image, sigma)
        middle, left, right = b[1:-1, 1:-1], b[1:-1, :-2], b[1:-1, 2:]
        up, down = b[:-2, 1:-1], b[2:, 1:-1]
        yield from (right - left, down - up, left + right + up + down - 4 * middle)


class Judge:
    """Scores textures against one square."""

    def __init__(self, square):
        self.square, self.responses = square, list(filter_responses(square))

    def score(self, texture):
        filters = [distance(a.ravel(), b.ravel()) for a, b in zip(filter_responses(texture), self.responses)]
        return np.array([distance(texture.ravel(), self.square.ravel()), np.mean(filters)])


def periodic_component(image):
    """Moisan 2011: the image less the smooth one that has its jumps across the borders."""
    height, width = image.shape
    jumps = np.zeros_like(image)
    jumps[0] += image[0] - image[-1]
    jumps[-1] += image[-1] - image[0]
    jumps[:, 0] += image[:, 0] - image[:, -1]
    jumps[:, -1] += image[:, -1] - image[:, 0]
    y, x = np.meshgrid(np.arange(height), np.arange(width), indexing="ij")
    laplacian = 2 * np.cos(2 * np.pi * x / width) + 2 * np.cos(2 * np.pi * y / height) - 4
    laplacian[0, 0] = 1
    smooth = np.fft.fft2(jumps) / laplacian
    smooth[0, 0] = 0
    return image + np.fft.ifft2(smooth).real


def random_phase(image, seed):
    moduli = np.abs(np.fft.fft2(periodic_component(image)))
    noise = np.fft.fft2(np.random.default_rng(seed).normal(size=image.shape))
    noise *= moduli / np.maximum(np.abs(noise), 1e-300)
    noise[0, 0] = moduli[0, 0] * np.sign(image.mean() or 1)
    return np.fft.ifft2(noise).real


def gaussianised(image):
    """The deviates of the ranks, and the sorted values."""
    order = np.argsort(image.ravel(), kind="stable")
    deviates = np.empty(image.size)
    normal = NormalDist()
    deviates[order] = [normal.inv_cdf((i + 0.5) / image.size) for i in range(image.size)]
    return deviates.reshape(image.shape), image.ravel()[order]


def blending(image, seed):
    deviates, values = gaussianised(periodic_component(image))
    side = image.shape[0]
    random = np.random.default_rng(seed)
    offsets = random.integers(0, side, size=(64, 64, 2))
    y, x = np.meshgrid(np.arange(side) + 0.5, np.arange(side) + 0.5, indexing="ij")
    # Coordinates on the skewed lattice of triangles, with the scale 2 sqrt(3) of the paper's program.
    scale = 2 * np.sqrt(3) / side
    a, b = scale * (x - y / np.sqrt(3)), scale * y * 2 / np.sqrt(3)
    a0, b0 = np.floor(a).astype(int), np.floor(b).astype(int)
    fa, fb = a - a0, b - b0
    upper = fa + fb > 1
    corners = [(np.where(upper, 1 - fb, fa), a0 + 1, b0), (np.where(upper, 1 - fa, fb), a0, b0 + 1),
               (np.abs(1 - fa - fb), a0 + upper, b0 + upper)]
    total, squares_sum = np.zeros(image.shape), np.zeros(image.shape)
    row, column = y.astype(int), x.astype(int)
    for weight, i, j in corners:
        offset = offsets[j % 64, i % 64]
        total += weight * deviates[(row + offset[..., 0]) % side, (column + offset[..., 1]) % side]
        squares_sum += weight ** 2
    ranks = np.searchsorted(np.sort(deviates.ravel()), total / np.sqrt(squares_sum))
    return values[np.clip(ranks, 0, values.size - 1)]


class Programs:
    def __init__(self, folder, work):
        self.folder, self.work = folder, pathlib.Path(work)

    def fit(self, square, model):
        """The recipe of a model, and the model that was taken."""
        photo, recipe, summary = self.work / "photo.png", self.work / f"{model}.json", self.work / "summary.json"
        write_grey(photo, square)
        Run(self.folder / "fit_gabor", photo, "-o", recipe, "--model", model, "--summary", summary, "--quiet")
        return recipe, json.loads(summary.read_text())["model"]

    def texture(self, recipe, square, seed):
        output, size = self.work / "texture.tif", f"{square.shape[1]}x{square.shape[0]}"
        Run(self.folder / "synth", recipe, "--texture", size, "-o", output, "--seed", seed, "--quiet")
        return read_grey(output) + square.mean()


def measure_square(seen, unseen, seeds, programs):
    """The scores of all methods, and the model that auto takes."""
    judge = Judge(unseen)

    def mean_score(texture_of):
        return np.mean([judge.score(texture_of(seed)) for seed in range(1, seeds + 1)], axis=0)

    scores = {"real": judge.score(seen), "random phase": mean_score(lambda seed: random_phase(seen, seed)),
              "blending": mean_score(lambda seed: blending(seen, seed))}
    for model in MODELS:
        recipe = programs.fit(seen, model)[0]
        scores[model] = mean_score(lambda seed, r=recipe: programs.texture(r, seen, seed))
    taken = programs.fit(seen, "auto")[1]
    return {**scores, "auto": scores[taken]}, taken


def measure(path, four, seeds, programs):
    measured = [measure_square(four[k], four[k ^ 1], seeds, programs) for k in range(4)]
    scores = {m: np.array([s[m] for s, _ in measured]) for m in METHODS}
    worse = scores["auto"].sum(axis=1) - scores["random phase"].sum(axis=1)
    error = worse.std(ddof=1) / 2
    return {"photo": path.name, "auto takes": [taken for _, taken in measured],
            "worse": round(float(worse.mean() / error), 1) if error > 0 else 0.0,
            **{m: [round(float(s), 4) for s in scores[m].mean(axis=0)] for m in METHODS}}


def main():
    given = arguments_of(__doc__, "programs", "photos", side=256, seeds=3,
                         json={"type": pathlib.Path, "help": "rows are added to this file, and photos in it are left out"})
    rows = [json.loads(line) for line in given.json.read_text().splitlines()] if given.json and given.json.exists() else []
    with tempfile.TemporaryDirectory() as work:
        for path in given.photos:
            if any(known["photo"] == path.name for known in rows):
                continue
            four = squares(read_grey(path), given.side)
            if four is None:
                print(f"{path.name}: has no room for four squares of {given.side} pixels, left out", flush=True)
                continue
            rows.append(measure(path, four, given.seeds, Programs(given.programs, work)))
            print(json.dumps(rows[-1]), flush=True)
            if given.json:
                with given.json.open("a") as file:
                    file.write(json.dumps(rows[-1]) + "\n")
    head("photo", *METHODS, "worse")
    medians = {m: np.median([known[m] for known in rows], axis=0) for m in METHODS}
    for line in [*rows, {"photo": f"**median of {len(rows)}**", **medians}]:
        row(line["photo"], *("{:.3f} / {:.3f}".format(*line[m]) for m in METHODS), max(0.0, line["worse"]) if "worse" in line else "")


if __name__ == "__main__":
    main()
