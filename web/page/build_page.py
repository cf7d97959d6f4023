#!/usr/bin/env python3
"""Puts the page into one file that needs no other and no network.

    build_page.py --core FOLDER --output page.html

The core is astrolith_core.js and .wasm of FOLDER. Examples are all recipes of synthesis/examples and the bodies of library/.
The core and the data are compressed, so that the wall of bodies is read and shown before them. The recipe that the page opens
first can be put in later: see the element `recipe` of page.html.
"""

import argparse
import base64
import gzip
import html
import json
import pathlib
import re

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
WALL = HERE / "wall"


def base64_text(content):
    return base64.b64encode(content).decode()


def packed(content):
    return base64_text(gzip.compress(content, 9, mtime=0))


def modules(file, seen=None):
    """The files of a module and of what it imports, each after those that it imports."""
    seen = [] if seen is None else seen
    for name in re.findall(r'^import .* from "(\..*)";$', file.read_text(), re.MULTILINE):
        imported = (file.parent / name).resolve()
        if imported not in seen:
            modules(imported, seen)
    if file not in seen:
        seen.append(file)
    return seen


def joined(*files):
    """Modules as one script: their names at the top level differ."""
    text = "\n".join(part.read_text() for file in files for part in modules(file))
    text = re.sub(r"^import .*;\n", "", text, flags=re.MULTILINE)
    return re.sub(r"^export (?=const|function|async function|class)", "", text, flags=re.MULTILINE)


def worker(core):
    """The core's worker is a script of the older kind."""
    parts = [joined(HERE / name) for name in ("mesh_reading.js", "png_reading.js", "core_calls.js", "core_worker.js")]
    return "\n".join([(core / "astrolith_core.js").read_text(), *parts])


def data(core):
    """Recipes by their names: JSON text of examples, compact ones in base 64 of measured and of drawn bodies."""

    def compact(folder):
        return {file.stem: base64_text(file.read_bytes()) for file in sorted(folder.glob("*.astro"))}

    examples = sorted((ROOT / "synthesis/examples").glob("*.json"))
    made = {
        "worker": worker(core),
        "schema": json.loads((ROOT / "recipe/recipe.schema.json").read_text()),
        "knobs": json.loads((ROOT / "recipe/knobs.json").read_text()),
        "examples": {file.stem: file.read_text() for file in examples},
        "library": compact(ROOT / "library"),
        "wall": compact(WALL),
        "population": base64_text((ROOT / "library/populations/asteroids.astro").read_bytes()),
    }
    return json.dumps(made).encode()


def wall():
    rows = []
    for body in json.loads((WALL / "wall.json").read_text()):
        sheet = base64_text((WALL / f"{body['name']}.webp").read_bytes())
        title, words = html.escape(body["title"]), html.escape(body["words"])
        rows.append(
            f'<li><button type="button" data-name="{body["name"]}" onclick="window.earlyChoice=this.dataset.name">'
            f'<span class="sheet-view" style="--sheet:url(data:image/webp;base64,{sheet})"></span>'
            f"<b>{title}</b><small>{words}</small></button></li>"
        )
    return "\n".join(rows)


def meshes():
    return json.dumps({file.name.removesuffix(".mesh.gz"): base64_text(file.read_bytes()) for file in sorted(WALL.glob("*.mesh.gz"))})


def in_script(text):
    """A script must not hold what ends its element or begins a comment of HTML."""
    return text.replace("</script", "<\\/script").replace("<!--", "<\\!--")


def main():
    parser = argparse.ArgumentParser()
    for name in ("core", "output"):
        parser.add_argument("--" + name, type=pathlib.Path, required=True)
    options = parser.parse_args()
    parts = {
        "style": (HERE / "page.css").read_text(),
        "wall": wall(),
        "meshes": meshes(),
        "core": packed((options.core / "astrolith_core.wasm").read_bytes()),
        "data": packed(data(options.core)),
        "scripts": in_script(joined(HERE / "page.js")),
        "recipe": "null",
    }
    page = re.sub(r"@(\w+)@", lambda match: parts[match[1]], (HERE / "page.html").read_text())
    options.output.write_text(page)
    size = len(gzip.compress(page.encode(), 9, mtime=0))
    print(f"{options.output.name}: {len(page.encode())} bytes, {size} compressed")


if __name__ == "__main__":
    main()
