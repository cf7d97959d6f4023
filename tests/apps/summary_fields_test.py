#!/usr/bin/env python3
"""Holds apps/summary_fields.json to what the programs write: it has every field that some run writes, and no other.

    summary_fields_test.py FOLDER_OF_PROGRAMS
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from made_inputs import write_ball, write_heights, write_photo

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
LAYERS = """[{"type": "craters", "craters": [{"direction": [0, 0, 1], "diameter": 0.4}]},
  {"type": "boulders", "boulders": [{"direction": [1, 0, 0], "axes": [0.3, 0.2, 0.1]}]}]"""
BODY = """{"format_version": 1, "length_unit": "km",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1], [0.7, 0, 0, 0.6]]}, "layers": %s%s}"""


def paths(value, path=""):
    """The paths of all figures in a document, such as "channels[].bands[].photo"."""
    if isinstance(value, dict):
        for name, inner in value.items():
            yield from paths(inner, f"{path}.{name}" if path else name)
    elif isinstance(value, list) and value and isinstance(value[0], dict):
        for inner in value:
            yield from paths(inner, path + "[]")
    else:
        yield path


def patterns(fields):
    """A regular expression for each path of the table, which may end in several names: "features[].x, y, z"."""
    for path in fields:
        stem, _, names = path.rpartition(".")
        for name in names.split(", "):
            whole = f"{stem}.{name}" if stem else name
            yield path, re.compile(re.escape(whole).replace(r"\*", r"[^.\[]+") + "$")


def runs(folder):
    """The program, its inputs and options for each run. They are small, and few write the same fields."""
    body, plain, eroded = folder / "body.json", folder / "plain.json", folder / "eroded.json"
    body.write_text(BODY % (LAYERS, ""))
    plain.write_text(BODY % ("[]", ""))
    eroded.write_text(BODY % (LAYERS, ', "erosion": {"talus_angle": 30}'))
    ball, fine = folder / "ball.obj", folder / "fine.obj"
    write_ball(ball)
    write_ball(fine, 1.4, 24, 40)
    holed = folder / "holed.obj"
    holed.write_text(fine.read_text().rstrip().rpartition("\n")[0] + "\n")
    grey, color = folder / "grey.png", folder / "color.png"
    write_photo(grey, 1)
    write_photo(color, 3)
    write_heights(folder / "heights.asc")
    far = folder / "far.obj"
    far.write_text(re.sub(r"v (\S+)", lambda m: f"v {float(m[1]) + 50}", ball.read_text()))
    tiles = folder / "tiles.asc"
    rows = "\n".join(" ".join(str((x % 32 * 7919 + y % 32 * 104729) * 31 % 1009) for x in range(96)) for y in range(96))
    tiles.write_text(f"ncols 96\nnrows 96\nxllcorner 0\nyllcorner 0\ncellsize 2\n{rows}\n")
    for name, length in (("one", 1.2), ("two", 2.0)):
        (folder / name).mkdir()
        for k in range(3):
            write_ball(folder / name / f"{k}.obj", length + 0.1 * k)
    mesh = ["-o", folder / "mesh.ply", "--resolution", "16"]
    features = ["--feature-list", folder / "features.json"]
    yield ["synth", eroded, *mesh, *features, "--min-component", "0.1", "--gravity", "2000", "5"]
    yield ["synth", body, *mesh, "--even", "--lod", "2"]
    yield ["synth", body, "-o", folder / "mesh.glb", "--resolution", "16", "--uv", "charts", "--bake", "64"]
    yield ["render", folder / "mesh.ply", "-o", folder / "body.png", "--color", "z", "--light-curve", folder / "l.csv"]
    yield ["synth", body, *mesh, "--patch", "0", "0", "1", "0.6", "--height-map", folder / "map.tif", *features]
    for k in (1, 2):
        yield ["synth", body, *mesh[:-1], "32", "--tile", f"{k}/2"]
        shutil.copy(folder / "summary.json", folder / f"tile_{k}.json")
    yield ["check_tiles", folder / "tile_1.json", folder / "tile_2.json"]
    worm = folder / "worm.json"  # a mesh of 256 cells has few triangles
    worm.write_text(json.dumps({"format_version": 1, "length_unit": "km", "body": {
        "type": "metaballs", "spheres": [[0.06 * k, 0, 0, 0.06] for k in range(-7, 8)]}}))  # fmt: skip
    hazards = ["--hazard-map", folder / "hazards.tif", "--footprint", "0.02", "--gravity", "2000", "5"]
    yield ["synth", worm, *mesh, "--patch", "0", "0", "0.06", "0.08", *hazards]
    yield ["synth", body, "--predict", "--resolution", "16"]
    yield ["synth", plain, *mesh, "--vary", "0.3", "--seed", "2"]
    yield ["synth", body, *mesh, "--patch", "0", "0", "1", "0.6", "--aligned"]
    large = folder / "large.json"  # with grains so fine, and boulders so many, that the whole body lacks them
    grains = '[{"type": "gabor", "pixel_size": 1e-6, "height_rms": 1e-6, "lobes": [[1, 0.2, 0.1, 1]]}]'
    large.write_text(BODY % (grains, ""))
    yield ["synth", large, *mesh, "--finish", "ryugu", "--from", "0.1", "--to", "1e-4", "--albedo", "ryugu"]
    family = folder / "family.json"
    family.write_text(BODY % (LAYERS, ', "family": {"fields": [{"field": "body.a", "low": 1, "high": 1.2}]}'))
    members = ["--members", "0:2", "--resolution", "16"]
    yield ["synth", family, *members, "-o", folder / "{member}.ply", "--manifest", folder / "set.jsonl"]
    yield ["synth", family, *members, "--predict"]
    longer = folder / "longer.json"
    longer.write_text(json.dumps({"format_version": 1, "length_unit": "km", "body": {
        "type": "metaballs", "a": 2, "b": 2, "spheres": [[0, 0, 0, 0.8], [0.5, 0, 0.1, 0.7]]}}))  # fmt: skip
    population = folder / "population.json"
    yield ["fit_population", plain, longer, "-o", population]
    yield ["synth", population, *mesh, "--diameter", "2"]
    yield ["fit_gabor", grey, "-o", folder / "grey.json", "--model", "auto"]
    yield ["fit_gabor", color, "-o", folder / "color.json", "--channels", "pca"]
    yield ["fit_gabor", tiles, "-o", folder / "tile.json", "--lobes", "4"]
    yield ["fit_gabor", folder / "heights.asc", "-o", folder / "ground.json", "--model", "phase"]
    heights = ["--texture", "64x64", "--texture-of", "height", "--bits"]
    for bits in ("8", "16"):
        yield ["synth", folder / "color.json", "-o", folder / "heights.png", *heights, bits]
    yield ["synth", folder / "color.json", "-o", folder / "color_texture.png", "--texture", "64x64"]
    material = ["--texture", "64x64", "--texture-of", "material"]
    yield ["synth", folder / "color.json", "-o", folder / "material.png", *material]
    painted = folder / "painted.json"
    yield ["fit_gabor", color, "-o", painted, "--model", "exemplar", "--channels", "pca", "--mm-per-px", "1e4", "--unit", "km"]
    yield ["synth", painted, "--base", plain, *mesh]
    fit = ["--spheres", "2", "--points", "200", "--population", "2", "-o"]
    search = ["--generations", "1", "--variations", "1", "--delta", "1", "--noise-seeds", "0"]
    yield ["fit_shape", ball, *fit, folder / "fit.json", *search]
    yield ["fit_shape", fine, *fit, folder / "relief.json", "--noise-seeds", "1"]
    yield ["fit_shape", far, *fit, folder / "far.json", "--base-only"]
    yield ["fit_shape", ball, "--spheres", "6", "-o", folder / "packing.csv", "--packing-only"]
    yield ["fit_shape", holed, "--spheres", "6", "-o", folder / "packing.csv", "--packing-only"]
    yield ["describe", holed, "-o", folder / "description.npy", "--points", "1000"]
    yield ["compare", holed, holed, "-o", folder / "compared.json", "--points", "1000"]
    yield ["gravity", holed, "--density", "2000"]
    noise, rough = folder / "noise.json", folder / "rough.ply"
    noise.write_text(BODY % ('[{"type": "simplex", "amplitude": 0.03, "frequency": 2, "octaves": 6}]', ""))
    yield ["synth", noise, "-o", rough, "--resolution", "100"]
    yield ["describe", rough, "--surface", "-o", folder / "surface.json", "--places", "500"]
    yield ["describe", ball, "-o", folder / "description.npy", "--points", "1000"]
    impacts, cratered = folder / "impacts.json", folder / "cratered.ply"
    impacts.write_text(BODY % ('[{"type": "craters", "craters": [{"direction": [1, 0, 0], "diameter": 0.6}]},'
                               '{"type": "boulders", "boulders": [{"direction": [0, 0, 1], "axes": [0.5, 0.4, 0.3]}]}]', ""))
    yield ["synth", impacts, "-o", cratered, "--resolution", "64"]
    yield ["describe", cratered, "--craters", folder / "craters.csv", "--boulders", "--craters-picture", folder / "craters.png"]
    realism = ["--realism", "-o", folder / "realism.json", "--points", "500", "--samples", "500", "--places", "500"]
    yield ["compare", fine, fine, "--floor", "--align", *realism]
    yield ["compare", rough, rough, *realism]
    yield ["classify", "train", folder / "one", folder / "two", "-o", folder / "model.json", "--folds", "3", "--points", "500"]
    yield ["classify", "predict", folder / "model.json", ball]
    gravity = ["gravity", ball, "--density", "2000", "--period", "5", "-o", folder / "gravity.csv"]
    yield [*gravity, "--density-of", f"{ball}=2500"]
    yield ["gravity", rough, "--density", "2000", "--sites", "1", "--site-size", "0.4"]


def main():
    programs = pathlib.Path(sys.argv[1])
    table = json.loads((ROOT / "apps/summary_fields.json").read_text())
    unused = {program: set(fields) for program, fields in table.items()}
    unused["every program"].remove("interrupted")  # program_test.cpp presses Ctrl-C
    missing = set()

    def account(document, *sections):
        known = [(section, *pair) for section in sections for pair in patterns(table[section])]
        for path in paths(document):
            hits = [(section, entry) for section, entry, pattern in known if pattern.match(path)]
            if not hits:
                missing.add(f"{sections[0]}: {path}")
            for section, entry in hits:
                unused[section].discard(entry)

    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        summary = folder / "summary.json"
        for program, *options in runs(folder):
            command = [programs / program, *options, "--summary", summary, "--quiet"]
            done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
            if done.returncode != 0:
                print(f"{' '.join(map(str, command))}: status {done.returncode}: {done.stderr.strip()}")
                return 1
            account(json.loads(summary.read_text()), program, "every program", "repair of a mesh", "realism of a surface")
            if "--feature-list" in options:
                account(json.loads((folder / "features.json").read_text()), "synth --feature-list")
    wrong = [f"apps/summary_fields.json has a field that no run writes: {program}: {field}"
             for program, fields in unused.items() for field in sorted(fields)]  # fmt: skip
    wrong += [f"written, and not in apps/summary_fields.json: {field}" for field in sorted(missing)]
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
