"""Fits: the bytes of the programs, recovery of what was synthesised, Ctrl-C, wrong arguments."""

import json
import os
import signal
import threading
import time

import astrolith
import numpy as np
import pytest

pytest.importorskip("astrolith._estimation")

FAST = {"spheres": 12, "population": 4, "generations": 2, "seed": 3}
FAST_OPTIONS = ["--spheres", "12", "--population", "4", "--generations", "2", "--seed", "3"]


@pytest.fixture(scope="module")
def peanut():
    body = {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[-0.8, 0, 0, 1.0], [0.8, 0, 0, 0.9]]}
    return astrolith.mesh({"format_version": 1, "length_unit": "km", "body": body}, resolution=28)


@pytest.mark.parametrize("base_only", [True, False])
def test_a_fit_of_a_file_has_the_bytes_of_fit_shape(peanut, program, tmp_path, base_only):
    astrolith.write_mesh(peanut, tmp_path / "peanut.ply")
    base = ["--base-only"] if base_only else []
    program("fit_shape", tmp_path / "peanut.ply", "-o", "program.json", "--device", "auto", *FAST_OPTIONS, *base)
    fit = astrolith.fit_shape(tmp_path / "peanut.ply", base_only=base_only, **FAST)
    fit.recipe.write(tmp_path / "package.json")
    written, wanted = (json.loads((tmp_path / f"{name}.json").read_text()) for name in ("package", "program"))
    wanted["provenance"]["options"].pop("device", None)
    assert written == wanted
    assert 0 < fit.figures.mean_distance < 0.02


def test_arrays_give_the_body_that_their_file_gives(peanut, tmp_path):
    astrolith.write_mesh(peanut, tmp_path / "peanut.ply")
    of_file = astrolith.fit_shape(str(tmp_path / "peanut.ply"), base_only=True, **FAST)
    of_arrays = astrolith.fit_shape(peanut.vertices, peanut.faces, base_only=True, threads=1, **FAST)
    assert of_arrays.recipe.body == of_file.recipe.body
    assert of_arrays.recipe.provenance.get("input_name", "") == ""


def test_ctrl_c_in_a_fit_is_quick_and_leaves_a_checkpoint_that_goes_on(peanut, tmp_path):
    checkpoint = tmp_path / "checkpoint.json"
    options = {**FAST, "generations": 4000}
    pressed = []

    def press():
        while not checkpoint.exists():
            time.sleep(0.01)
        pressed.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=press)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        astrolith.fit_shape(peanut, checkpoint=checkpoint, **options)
    assert time.monotonic() - pressed[0] < 1.0
    thread.join()
    assert "base" in json.loads(checkpoint.read_text())
    calls = []
    fit = astrolith.fit_shape(peanut, checkpoint=checkpoint, progress=lambda d, w: calls.append(w) or False, **options)
    assert fit.figures.stopped_early and calls[0].startswith("details")


def test_a_texture_of_a_photo_has_the_recipe_of_fit_gabor(example, program, tmp_path):
    drawn = astrolith.texture(example("photo_textures"), 64, 64, content="height")
    grey = np.clip(128 + 40 * drawn.values / drawn.height_rms, 0, 255).astype(np.uint8)
    (tmp_path / "rock.png").write_bytes(png(grey))
    program("fit_gabor", "rock.png", "-o", "program.json", "--lobes", "6", "--seed", "2")
    fit = astrolith.fit_texture(tmp_path / "rock.png", lobes=6, seed=2)
    fit.recipe.write(tmp_path / "package.json")
    assert (tmp_path / "package.json").read_text() == (tmp_path / "program.json").read_text()
    of_array = astrolith.fit_texture(grey, lobes=6, seed=2)
    assert of_array.recipe.layers[0].lobes == fit.recipe.layers[0].lobes


def png(grey):
    """The bytes of an 8-bit grey PNG."""
    import struct
    import zlib

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    height, width = grey.shape
    rows = b"".join(b"\0" + row.tobytes() for row in grey)
    header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def test_classes_are_told_apart_as_classify_does(program, tmp_path):
    for name, stretch in (("long", 3.0), ("round", 1.0)):
        (tmp_path / "shapes" / name).mkdir(parents=True)
        for k in range(3):
            spheres = [[stretch * x, 0, 0, 1.0 + 0.05 * k] for x in (-0.4, 0.4)]
            body = {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": spheres}
            mesh = astrolith.mesh({"format_version": 1, "length_unit": "m", "body": body}, resolution=14)
            astrolith.write_mesh(mesh, tmp_path / "shapes" / name / f"{k}.ply")
    program("classify", "train", "shapes", "-o", "program.yml", "--features", "d2", "--points", "200",
            "--trees", "20", "--folds", "0")  # fmt: skip
    astrolith.train_classifier([tmp_path / "shapes"], tmp_path / "package.yml", features="d2", points=200, trees=20)
    assert (tmp_path / "package.yml").read_bytes() == (tmp_path / "program.yml").read_bytes()
    votes = astrolith.classify(tmp_path / "package.yml", tmp_path / "shapes" / "long" / "0.ply")
    assert max(votes, key=votes.get) == "long" and sum(votes.values()) == pytest.approx(1)


@pytest.mark.parametrize(
    "image",
    [np.zeros(64), np.zeros((64, 64, 2)), np.zeros((64, 64), int), np.full((64, 64), np.nan), np.zeros((64, 128)).T,
     np.zeros((0, 64)), np.zeros((64, 64)), np.zeros((16, 16))],
)  # fmt: skip
def test_wrong_images(image):
    with pytest.raises(ValueError, match="^image: ") as raised:
        astrolith.fit_texture(image)
    assert "\n" not in str(raised.value)


def test_wrong_meshes(peanut):
    with pytest.raises(ValueError, match="^mesh: .*open"):
        astrolith.fit_shape(peanut.vertices, peanut.faces[1:], base_only=True)
    with pytest.raises(ValueError, match=r"^mesh\.faces: "):
        astrolith.fit_shape(peanut.vertices, peanut.faces.astype(np.int64) - 1)
    with pytest.raises(ValueError, match="^spheres: "):
        astrolith.fit_shape(peanut, spheres=0)
