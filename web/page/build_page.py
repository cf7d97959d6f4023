#!/usr/bin/env python3
"""Puts the page into one file that needs no other and no network.

    build_page.py --core FOLDER --three FOLDER --output page.html

The core is astrolith_core.js and .wasm of FOLDER, three.js is Debian's libjs-three. Examples are all recipes of
synthesis/examples and the bodies of library/. The recipe that the page opens first can be put in later: see the element `recipe` of page.html.
"""

import argparse
import base64
import json
import pathlib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
SCRIPTS = [
    "recipe_text.js",
    "edited_recipe.js",
    "drawn_body.js",
    "schema_values.js",
    "schema_form.js",
    "core_client.js",
    "body_view.js",
    "page.js",
]
FIRST = "itokawa_relief.json"


def examples():
    return [{"name": file.name, "text": file.read_text()} for file in sorted((ROOT / "synthesis/examples").glob("*.json"))]


def library():
    """The measured bodies, compact recipes in base 64. The page calls every recipe by the name of its JSON."""
    files = sorted((ROOT / "library").glob("*.astro"))
    return [{"name": file.stem + ".json", "bytes": base64.b64encode(file.read_bytes()).decode()} for file in files]


def population():
    """The measured bodies that new ones are drawn between, a compact recipe in base 64."""
    return base64.b64encode((ROOT / "library/populations/asteroids.astro").read_bytes()).decode()


def constants(core):
    worker = [core / "astrolith_core.js", HERE / "core_calls.js", HERE / "core_worker.js"]
    page = {
        "worker": "\n".join(file.read_text() for file in worker),
        "core": base64.b64encode((core / "astrolith_core.wasm").read_bytes()).decode(),
        "schema": json.loads((ROOT / "recipe/recipe.schema.json").read_text()),
        "examples": examples() + library(),
        "population": population(),
        "first": FIRST,
    }
    return "const PAGE = " + json.dumps(page) + ";"


def in_script(text):
    """A script must not hold what ends its element or begins a comment of HTML."""
    return text.replace("</script", "<\\/script").replace("<!--", "<\\!--")


def main():
    parser = argparse.ArgumentParser()
    for name in ("core", "three", "output"):
        parser.add_argument("--" + name, type=pathlib.Path, required=True)
    options = parser.parse_args()
    three = [options.three / "build/three.min.js", options.three / "examples/js/controls/OrbitControls.js"]
    scripts = [file.read_text() for file in [*three, *(HERE / name for name in SCRIPTS)]]
    scripts.insert(2, constants(options.core))
    page = (HERE / "page.html").read_text()
    for name, text in (("style", (HERE / "page.css").read_text()), ("scripts", in_script("\n".join(scripts)))):
        page = page.replace(f"@{name}@", text)
    options.output.write_text(page.replace("@recipe@", "null"))


if __name__ == "__main__":
    main()
