#!/usr/bin/env python3
"""Makes the page's wall: web/page/wall/NAME.webp, 25 views around each body in five rows of five, and NAME.mesh.gz, a mesh of
32 cells that is shown until the core has made one.

    make_wall.py SYNTH [NAME ...]

It needs python3-pil. Drawn bodies also get their recipes, NAME.astro. wall.json says what stands under a picture.
"""

import gzip
import json
import pathlib
import subprocess
import sys
import tempfile

from coarse_mesh import packed
from PIL import Image

WALL = pathlib.Path(__file__).resolve().parent / "wall"
ROOT = WALL.parent.parent.parent
ROWS, SIDE = 5, 128
SPACE = (0, 0, 0)  # page.css lets its own colour show where the sheet is darker
QUALITY = 50
MESH_CELLS = 32

# Bodies that nobody has seen: the options of their draws.
DRAWN = {
    "new_top": ["--seed", "12", "--class", "top", "--diameter", "780"],
    "new_binary": ["--seed", "5", "--class", "contact_binary", "--diameter", "640"],
    "new_shard": ["--seed", "21", "--class", "fragment", "--diameter", "320"],
    "new_long": ["--seed", "9", "--class", "elongated", "--diameter", "2300"],
}


def recipe_of(name, synth):
    if name in DRAWN:
        recipe = WALL / f"{name}.astro"
        subprocess.run([synth, "asteroids", *DRAWN[name], "--details", "relief", "--own-heights", "--albedo", "drawn",
                        "--write-recipe", recipe,
                        "--quiet"], check=True)  # fmt: skip
        return recipe
    measured = ROOT / f"library/{name}.astro"
    return measured if measured.exists() else ROOT / f"synthesis/examples/{name}.json"


def sheet(recipe, synth, folder):
    picture = folder / "sheet.png"
    views = ROWS * ROWS
    cameras = [word for i in range(views) for word in ("--camera", f"lat 12 lon {360 * i / views:g}")]
    subprocess.run([synth, recipe, "--resolution", "200", "-o", folder / "body.ply", "--preview", picture, "--picture-size",
                    f"{2 * ROWS * SIDE}x{2 * ROWS * SIDE}", "--no-marks", "--background", "transparent", "--ambient", "0.02",
                    "--sun", "-0.75", "0.35", "0.5", *cameras, "--quiet"], check=True)  # fmt: skip
    with Image.open(picture) as bodies:
        made = Image.new("RGBA", bodies.size, (*SPACE, 255))
        made.alpha_composite(bodies.convert("RGBA"))
    return made.convert("RGB").resize((ROWS * SIDE, ROWS * SIDE), Image.LANCZOS)


def coarse_mesh(recipe, synth, folder):
    mesh, summary = folder / "coarse.ply", folder / "coarse.json"
    subprocess.run([synth, recipe, "--resolution", str(MESH_CELLS), "-o", mesh, "--summary", summary, "--quiet"], check=True)
    return packed(mesh, json.loads(summary.read_text()))


def main():
    synth, names = sys.argv[1], sys.argv[2:]
    names = names or [body["name"] for body in json.loads((WALL / "wall.json").read_text())]
    for name in names:
        with tempfile.TemporaryDirectory() as folder:
            file, recipe, work = WALL / f"{name}.webp", recipe_of(name, synth), pathlib.Path(folder)
            (WALL / f"{name}.mesh.gz").write_bytes(gzip.compress(coarse_mesh(recipe, synth, work), 9, mtime=0))
            sheet(recipe, synth, work).save(file, quality=QUALITY, method=6)
            print(f"{file.name}: {file.stat().st_size} bytes", flush=True)


if __name__ == "__main__":
    main()
