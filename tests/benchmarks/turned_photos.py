#!/usr/bin/env python3
"""Whether an exemplar's texture keeps the direction of a photo: the correlation of slopes along x and y.

    turned_photos.py PROGRAMS PHOTO... [--seeds 3] [--model exemplar] [--border matched] [--side 384]

PROGRAMS is the folder of fit_gabor and synth, such as build/release/bin. Each photo is turned by 45 degrees, where a
direction along x or y correlates the slopes; the middle that the turned photo fills is cut out, fitted and drawn anew.
Slopes are central differences after a Gaussian blur of one pixel. The ratio is that of the textures' mean correlation to
the photo's; photos whose correlation is below .1 have no direction to keep, and get the difference alone. Needs NumPy,
SciPy and Pillow.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

import numpy as np
from PIL import Image
from scipy import ndimage

LEAST = 0.1


def correlation(image):
    smooth = ndimage.gaussian_filter(np.asarray(image, float), 1.0)[4:-4, 4:-4]
    along_y, along_x = np.gradient(smooth)
    return float((along_x * along_y).mean() / np.sqrt((along_x**2).mean() * (along_y**2).mean()))


def turned(photo, side):
    with Image.open(photo) as opened:
        grey = opened.convert("I;16") if opened.mode.startswith("I") else opened.convert("L")
        values = np.asarray(grey, float)
    whole = min(values.shape)
    values = ndimage.rotate(values[:whole, :whole], 45.0, reshape=False, order=3, mode="mirror")
    cut = min(side, int(whole / 2**0.5) - 4)
    first = (whole - cut) // 2
    part = values[first : first + cut, first : first + cut]
    low, high = part.min(), part.max()
    return np.round((part - low) / (high - low) * 65535).astype(np.uint16)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("photos", nargs="+", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--model", default="exemplar")
    parser.add_argument("--border")
    parser.add_argument("--side", type=int, default=384)
    given = parser.parse_args()
    print(f"{'photo':40s} {'photo':>7s} {'texture':>8s} {'ratio':>6s}  border")
    kept = directed = 0
    for photo in given.photos:
        with tempfile.TemporaryDirectory() as folder:
            pixels = turned(photo, given.side)
            size = pixels.shape[0]
            Image.fromarray(pixels).save(f"{folder}/turned.png")
            border = ["--border", given.border] if given.border else []
            subprocess.run([given.programs / "fit_gabor", f"{folder}/turned.png", "-o", f"{folder}/r.json", "--model",
                            given.model, "--quiet", "--summary", f"{folder}/s.json", *border], check=True)
            textures = []
            for seed in range(given.seeds):
                subprocess.run([given.programs / "synth", f"{folder}/r.json", "--texture", f"{size}x{size}", "--seed",
                                str(seed + 1), "-o", f"{folder}/t.png", "--quiet"], check=True)
                with Image.open(f"{folder}/t.png") as texture:
                    textures.append(correlation(texture))
            summary = json.loads(pathlib.Path(folder, "s.json").read_text())
        own, made = correlation(pixels), float(np.mean(textures))
        ratio = made / own if abs(own) >= LEAST else None
        directed += ratio is not None
        kept += ratio is not None and 0.8 <= ratio <= 1.2
        shown = f"{ratio:6.2f}" if ratio is not None else f"{'-':>6s}"
        print(f"{photo.stem:40s} {own:7.3f} {made:8.3f} {shown}  {summary.get('variant', given.model)}", flush=True)
    print(f"{kept} of {directed} photos with a direction keep it within .8 to 1.2")


if __name__ == "__main__":
    main()
