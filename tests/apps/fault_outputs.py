"""What programs write, as a table for the tests of faults, and the inputs that they read."""

import collections

from made_inputs import write_ball, write_photo

LAYERS = """[{"type": "simplex", "amplitude": 0.05, "frequency": 2, "octaves": 4},
  {"type": "craters", "craters": [{"direction": [0, 0, 1], "diameter": 0.4}]}]"""
BODY = """{"format_version": 1, "length_unit": "km",
  "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1]%s]}, "layers": %s%s}"""
FAMILY = ', "family": {"fields": [{"field": "layers[0].amplitude", "low": 0.01, "high": 0.1}]}'
STAR = '[{"type": "simplex", "amplitude": 0.02, "frequency": 1}]'  # every ray from the centre meets this body once
ROCK = """{"format_version": 1, "length_unit": "m", "layers": [
  {"type": "gabor", "pixel_size": 0.01, "height_rms": 0.01, "exemplar_rms": 0.2,
   "color": {"axis": [0.8, 0.5, 0.3], "mean": [0.4, 0.35, 0.3]}, "lobes": [[4, 0.05, 0.02, 1.0]]}]}"""

MESH = ["body.json", "--resolution", "64", "-o"]
FIT = ["fine.obj", "--spheres", "40", "--threads", "1"]

# program, arguments, and the files that the program writes.
# keeps_best: after Ctrl-C the files hold the best so far.
# quick: the short selection has this output.
# kills: how many times as many moments SIGKILL gets, for outputs of several files that are quick to make; at most four
# times as many commands are started again.
# span: work that is too long to be let end is stopped within so many seconds of its beginning.
Output = collections.namedtuple("Output", "program arguments files keeps_best quick kills span", defaults=(False, False, 1, 0))
MEMBERS = 12
OUTPUTS = {
    "mesh.ply": Output("synth", MESH + ["out.ply"], ["out.ply"]),
    "mesh.ply.zst": Output("synth", MESH + ["out.ply.zst"], ["out.ply.zst"]),
    "mesh.obj": Output("synth", MESH + ["out.obj"], ["out.obj"]),
    "mesh.stl": Output("synth", MESH + ["out.stl"], ["out.stl"]),
    "mesh.glb": Output("synth", MESH + ["out.glb", "--uv"], ["out.glb"]),
    "mesh.icq": Output("synth", ["star.json", *MESH[1:], "out.icq"], ["out.icq"]),
    "mesh.tab": Output("synth", MESH + ["out.tab"], ["out.tab"]),
    "labels": Output("synth", MESH + ["out.ply", "--labels"], ["out.ply"]),
    "points": Output("synth", MESH + ["out.ply", "--points"], ["out.ply"]),
    "tile": Output("synth", MESH + ["out.ply", "--tile", "1/2"], ["out.ply"]),
    "mesh with its list and recipe": Output(
        "synth",
        ["body.json", "--resolution", "200", "-o", "out.ply", "--feature-list", "out.csv", "--write-recipe", "out.json"],
        ["out.ply", "out.csv", "out.json"], quick=True, kills=30),
    "pictures of a mesh": Output(
        "synth", MESH + ["out.ply", "--preview", "out.png", "--preview-maps", "out.npz", "--view", "1", "0", "0"],
        ["out.ply", "out.png", "out.npz"]),
    "height map": Output(
        "synth", MESH + ["out.ply", "--patch", "0", "0", "1", "0.6", "--height-map", "out.tif"],
        ["out.ply", "out.tif", "out.json"]),
    "texture": Output("synth", ["rock.json", "--texture", "512x512", "-o", "out.png"], ["out.png"]),
    "material": Output(
        "synth", ["rock.json", "--texture", "256x256", "--texture-of", "material", "-o", "out.png"],
        [f"out_{part}" for part in ("height.tif", "color.png", "normal.png", "occlusion.png")]),
    "members": Output(
        "synth",
        ["family.json", "--members", f"0:{MEMBERS}", "--resolution", "32", "-o", "out{member}.ply", "--write-recipe",
         "out{member}.json", "--manifest", "out.jsonl"],
        ["out.jsonl", *(f"out{k:07}.{kind}" for k in range(MEMBERS) for kind in ("ply", "json"))], quick=True, kills=4),
    "histogram": Output("describe", ["fine.obj", "-o", "out.npy", "--points", "3000"], ["out.npy"], quick=True),
    "surface": Output("describe", ["fine.obj", "--surface", "-o", "out.json"], ["out.json"]),
    "comparison": Output("compare", ["fine.obj", "ball.obj", "--points", "4000", "-o", "out.json"], ["out.json"]),
    "comparison on stdout": Output("compare", ["fine.obj", "ball.obj", "--points", "2000"], [], quick=True),
    "gravity.csv": Output("gravity", ["fine.obj", "--density", "2000", "-o", "out.csv"], ["out.csv"], quick=True),
    "gravity.npy": Output("gravity", ["fine.obj", "--density", "2000", "-o", "out.npy"], ["out.npy"]),
    "gravity.ply": Output(
        "gravity", ["fine.obj", "--density", "2000", "--at", "vertices", "-o", "out.ply", "--preview", "out.png"],
        ["out.ply", "out.png"]),
    "classifier": Output(
        "classify", ["train", "one", "two", "-o", "out.yml", "--points", "700", "--trees", "100"], ["out.yml"], quick=True),
    "fit": Output("fit_shape", [*FIT, "--base-only", "-o", "out.json"], ["out.json"], True),
    "compact fit": Output("fit_shape", [*FIT, "--base-only", "-o", "out.astro"], ["out.astro"], True),
    "fit with details": Output(
        "fit_shape", ["ball.obj", "--spheres", "6", "--population", "4", "--generations", "2", "-o", "out.json"],
        ["out.json"], True),
    "packing": Output("fit_shape", [*FIT, "--packing-only", "-o", "out.csv"], ["out.csv"], True, True),
    "texture fit": Output(
        "fit_gabor", ["small.png", "-o", "out.json", "--spectrum", "out.npy"], ["out.json", "out.npy"], True, True),
    "exemplar": Output(
        "fit_gabor", ["small.png", "--model", "exemplar", "-o", "out.json"], ["out.json", "out_exemplar.png"], True),
    "long mesh": Output("synth", ["body.json", "-o", "out.ply", "--resolution", "2000"], ["out.ply"], False, True, span=4),
    "long fit": Output("fit_shape", ["fine.obj", "-o", "out.json", "--spheres", "300"], ["out.json"], True, True, span=8),
    "long texture fit": Output("fit_gabor", ["large.png", "-o", "out.json"], ["out.json"], True, True, span=2),
    "long histogram": Output("describe", ["fine.obj", "-o", "out.npy", "--points", "60000"], ["out.npy"], False, True, span=4),
    "long comparison": Output("compare", ["fine.obj", "fine.obj", "--points", "60000"], [], False, True, span=4),
    "long gravity": Output(
        "gravity", ["body.json", "--density", "2000", "--resolution", "256", "--exact", "-o", "out.csv"], ["out.csv"],
        False, True, span=4),
    "long training": Output(
        "classify", ["train", "one", "two", "-o", "out.yml", "--points", "20000"], ["out.yml"], False, True, span=4),
}  # fmt: skip


def write_inputs(folder):
    (folder / "body.json").write_text(BODY % (", [1, 0, 0, 0.75]", LAYERS, ""))
    (folder / "family.json").write_text(BODY % (", [1, 0, 0, 0.75]", LAYERS, FAMILY))
    (folder / "star.json").write_text(BODY % ("", STAR, ""))
    (folder / "rock.json").write_text(ROCK)
    write_ball(folder / "ball.obj")
    write_ball(folder / "fine.obj", 1.4, 40, 60)
    write_photo(folder / "small.png", 3)
    write_photo(folder / "large.png", 1, 384)
    for name, length in (("one", 1.2), ("two", 2.0)):
        (folder / name).mkdir()
        for k in range(3):
            write_ball(folder / name / f"{k}.obj", length + 0.1 * k)
