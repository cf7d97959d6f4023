"""Fits: the bytes of the programs, recovery of what was synthesised, Ctrl-C, wrong arguments."""

import json
import os
import signal
import threading
import time

import astrolith
import numpy as np
import pytest
from conftest import FAST, WORM

pytest.importorskip("astrolith._estimation")

FAST_OPTIONS = ["--spheres", "12", "--population", "4", "--generations", "2", "--noise-seeds", "0", "--seed", "3"]


def test_a_fit_of_a_file_has_the_bytes_of_fit_shape(worm, program, tmp_path):
    astrolith.write_mesh(worm, tmp_path / "worm.ply")
    program("fit_shape", tmp_path / "worm.ply", "-o", "program.json", "--device", "auto", *FAST_OPTIONS)
    fit = astrolith.fit_shape(tmp_path / "worm.ply", **FAST)
    fit.recipe.write(tmp_path / "package.json")
    written, wanted = (json.loads((tmp_path / f"{name}.json").read_text()) for name in ("package", "program"))
    wanted["provenance"]["options"].pop("device", None)
    assert written == wanted
    assert 0 < fit.figures.mean_distance < 0.02


@pytest.mark.parametrize("way", ["details", "auto", "photo"])
def test_details_that_are_not_searched_have_the_bytes_of_fit_shape(worm, fit_of_metres, example, program, tmp_path, way):
    mesh = worm
    if way == "auto":  # learns from what the metaballs leave
        hills = {"type": "simplex", "amplitude": 0.06, "frequency": 3, "octaves": 4}
        body = {**WORM["body"], "spheres": [[-0.8, 0, 0, 1], [0.8, 0, 0, 0.9]]}
        mesh = astrolith.mesh({**WORM, "body": body, "layers": [hills]}, resolution=40)
    astrolith.write_mesh(mesh, tmp_path / "worm.ply")
    options = {
        "details": {"details": example("steins")},
        "auto": {"micro": "auto"},
        "photo": {"micro": example("rubble_pile"), "mm_per_px": 3e7, "micro_height": 6.5e4, "base_only": True},
    }[way]
    words = []
    for name, value in options.items():
        words += [f"--{name.replace('_', '-')}"] + ([] if value is True else [value])
    fast = {"spheres": 12, "population": 4, "noise_seeds": 0, "seed": 3}
    program("fit_shape", tmp_path / "worm.ply", "-o", "program.json", "--spheres", "12", "--population", "4",
            "--noise-seeds", "0", "--seed", "3", "--device", "cpu", *words)  # fmt: skip
    fit = astrolith.fit_shape(tmp_path / "worm.ply", device="cpu", **fast, **options)
    fit.recipe.write(tmp_path / "package.json")
    assert (tmp_path / "package.json").read_text() == (tmp_path / "program.json").read_text()
    assert fit.recipe.layers
    if way == "photo":  # without a search; arrays give the body that their file gives
        assert fit_of_metres.recipe.body == fit.recipe.body
        assert fit_of_metres.recipe.provenance.get("input_name", "") == ""


def test_a_time_limit_returns_the_best_so_far_and_a_report_shows_it(worm, tmp_path):
    # Without the limit the search would take hours.
    fit = astrolith.fit_shape(worm, spheres=12, generations=100000, time_limit=3.0, report=tmp_path / "report")
    assert fit.figures.stopped_early and fit.figures.mean_distance < 0.1
    assert {"index.html", "convergence.png"} <= {file.name for file in (tmp_path / "report").iterdir()}
    with pytest.raises(ValueError, match="^time_limit: reading and checking the mesh"):
        astrolith.fit_shape(worm, spheres=12, time_limit=1e-6)


def test_a_fit_in_few_bytes_has_the_bytes_of_fit_shape(worm, program, tmp_path):
    astrolith.write_mesh((worm.vertices, worm.faces), tmp_path / "worm.ply")
    program("fit_shape", "worm.ply", "-o", "program.astro", "--base-only", "--bytes", 150, "--unit", "m",
            "--population", 4, "--seed", 3)  # fmt: skip
    options = {"base_only": True, "bytes": 150, "unit": "m", "population": 4, "seed": 3}
    fit = astrolith.fit_shape(tmp_path / "worm.ply", **options)
    fit.recipe.write(tmp_path / "package.astro")
    written = (tmp_path / "package.astro").read_bytes()
    assert written == (tmp_path / "program.astro").read_bytes() and len(written) <= 150
    assert fit.recipe.provenance.get("tool", "") == ""
    of_few = astrolith.fit_shape(tmp_path / "worm.ply", spheres=12, **options)
    assert len(of_few.recipe.body.spheres) <= 12 < len(fit.recipe.body.spheres)


def test_bytes_are_those_of_metaballs_and_heights(worm, example):
    for more, message in (({"details": "thesis"}, "^bytes: .* add base_only or details relief$"), ({"base_only": True, "micro": example("rubble_pile")}, "^bytes excludes micro")):
        with pytest.raises(ValueError, match=message):
            astrolith.fit_shape(worm, bytes=150, **more)
    with pytest.raises(ValueError, match="^bytes: must be a number between 100"):
        astrolith.fit_shape(worm, bytes=99, base_only=True)


def test_a_fit_takes_the_unit_that_a_mesh_states(worm, fit_of_metres):
    assert fit_of_metres.recipe.length_unit == "m"
    in_metres = astrolith.Mesh(worm.vertices, worm.faces, length_unit="m")
    with pytest.warns(UserWarning, match="^unit: mesh states m; it is taken in km, as the argument says"):
        assert astrolith.pack_spheres(in_metres, spheres=2, unit="km").length_unit == "km"
    in_inches = astrolith.Mesh(worm.vertices, worm.faces, length_unit="in")
    with pytest.raises(ValueError, match="^unit: is missing; mesh states in, which is none of km, m; convert"):
        astrolith.fit_shape(in_inches)


def test_ctrl_c_in_a_fit_is_quick_and_leaves_a_checkpoint_that_goes_on(worm, tmp_path):
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
        astrolith.fit_shape(worm.vertices, worm.faces, checkpoint=checkpoint, **options)
    assert time.monotonic() - pressed[0] < 1.0
    thread.join()
    assert "base" in json.loads(checkpoint.read_text())
    calls = []
    fit = astrolith.fit_shape(worm, checkpoint=checkpoint, progress=lambda d, w: calls.append(w) or False, **options)
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


@pytest.mark.parametrize("gap", ["mask", "mask of whole numbers", "NaN"])
def test_masked_pixels_are_missing(gap):
    heights = np.random.default_rng(3).normal(350, 7, (64, 64)).astype(np.float32).round()
    hole = np.zeros(heights.shape, bool)
    hole[10:30, 20:40] = True
    known = heights[~hole].astype(float)
    image = {
        "mask": lambda: np.ma.masked_array(np.where(hole, np.float32(-9999), heights), hole),
        "mask of whole numbers": lambda: np.ma.masked_equal(np.where(hole, -9999, heights).astype(np.int16), -9999),
        "NaN": lambda: np.where(hole, np.float32(np.nan), heights),
    }[gap]()
    figures = astrolith.fit_texture(image, lobes=6).figures
    assert figures.image.missing == pytest.approx(hole.mean())
    assert np.sqrt(figures.channels[0].pixel_variance) == pytest.approx(known.std(), rel=0.05)


def test_a_surface_through_points():
    n = 4000
    z, angle = (2 * np.arange(n) + 1) / n - 1, 2.399963229728653 * np.arange(n)
    points = np.column_stack((1.5 * np.sqrt(1 - z**2) * np.cos(angle), np.sqrt(1 - z**2) * np.sin(angle), z))
    body, figures = astrolith.repair_mesh(points, wrap=True)
    assert figures.points == n and "surface through 4000 points" in figures.words
    a, b, c = (body.vertices[body.faces[:, k]].astype(float) for k in range(3))
    assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6 == pytest.approx(2 * np.pi, rel=0.004)
    with pytest.raises(ValueError, match="^mesh: .*fill_unseen"):
        astrolith.repair_mesh(points[points[:, 0] > 0], wrap=True)


@pytest.mark.parametrize("channels", ["luminance", "pca"])
def test_the_spectrum_of_the_lobes_is_what_fit_gabor_writes(program, tmp_path, channels):
    rows, columns = np.indices((48, 64))
    grey = 128 + 40 * np.sin(0.7 * columns) + 20 * np.cos(1.1 * rows + 0.3 * columns) + (rows * 7 + columns * 3) ** 2 % 97 % 31
    image = np.dstack([grey, 0.8 * grey, 255 - grey * 0.6]).clip(0, 255).astype(np.uint8)
    (tmp_path / "rock.png").write_bytes(png(image))
    program("fit_gabor", "rock.png", "-o", "r.json", "--lobes", "6", "--channels", channels, "--spectrum", "s.npy")
    fit = astrolith.fit_texture(tmp_path / "rock.png", lobes=6, channels=channels, spectrum=True)
    wanted = np.load(tmp_path / "s.npy")
    assert fit.spectrum.dtype == np.float64 and fit.spectrum.shape == wanted.shape
    assert fit.spectrum.tobytes() == wanted.tobytes()
    assert wanted.shape == (48, 64) if channels == "luminance" else wanted.shape[1:] == (48, 64)
    without = astrolith.fit_texture(tmp_path / "rock.png", lobes=6, channels=channels)
    assert without.spectrum is None and without.recipe == fit.recipe
    phase = astrolith.fit_texture(image, model="phase", output=tmp_path / "p.json", spectrum=True, report=tmp_path / "report")
    assert phase.spectrum.shape == (48, 64) and (tmp_path / "report" / "index.html").exists()


@pytest.mark.parametrize("model", ["exemplar", "phase", "auto"])
def test_an_exemplar_of_a_photo_has_the_bytes_of_fit_gabor(program, tmp_path, model):
    rows, columns = np.indices((64, 64))
    grey = (120 + 90 * ((rows // 8 + columns // 8) % 2) + (rows * 7 + columns * 3) ** 2 % 97 % 41).astype(np.uint8)
    (tmp_path / "tiles.png").write_bytes(png(grey))
    (tmp_path / "package").mkdir()
    options = {"model": model, "mm_per_px": 2.0, "height_rms": 0.01, "seed": 2}
    program("fit_gabor", "tiles.png", "-o", "tile.json", "--model", model, "--mm-per-px", "2.0", "--height-rms",
            "0.01", "--seed", "2")  # fmt: skip
    fit = astrolith.fit_texture(tmp_path / "tiles.png", output=tmp_path / "package" / "tile.json", **options)
    for name in ("tile.json", "tile_exemplar.png"):
        wanted, written = tmp_path / name, tmp_path / "package" / name
        assert wanted.exists() == written.exists()
        assert not wanted.exists() or written.read_bytes() == wanted.read_bytes()
    assert fit.figures.model == ("exemplar" if model == "auto" else model)
    assert model == "phase" or set(fit.figures.variants) == {"periodic", "matched", "mirrored"}
    if model == "auto":
        assert set(fit.figures.choice.models) == {"gabor", "phase", "exemplar"}
    assert astrolith.texture(fit.recipe, 16, 16, content="height").values.shape == (16, 16)


def test_a_photo_beyond_the_memory_is_refused(tmp_path):
    grey = (np.arange(64 * 64).reshape(64, 64) * 37 % 251).astype(np.uint8)
    with pytest.raises(ValueError, match="^image: fitting 64 x 64 pixels needs .* raise max_memory$"):
        astrolith.fit_texture(grey, max_memory=1e-6)
    with pytest.raises(ValueError, match="^lobes: is about lobes, which model phase has none of"):
        astrolith.fit_texture(grey, model="phase", lobes=4, output=tmp_path / "rock.json")
    with pytest.raises(ValueError, match="^output: is missing"):
        astrolith.fit_texture(grey, model="auto")
    fit = astrolith.fit_texture(grey, lobes=4, report=tmp_path / "report", output=tmp_path / "rock.json")
    assert {"index.html", "report.png"} <= {file.name for file in (tmp_path / "report").iterdir()}
    assert astrolith.Recipe.read(tmp_path / "rock.json") == fit.recipe
    assert 0.5 < fit.figures.variance_ratio_synthesized < 1.5


def png(pixels):
    """The bytes of an 8-bit PNG, grey or RGB."""
    import struct
    import zlib

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    height, width = pixels.shape[:2]
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    header = struct.pack(">IIBBBBB", width, height, 8, 0 if pixels.ndim == 2 else 2, 0, 0, 0)
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


def test_wrong_meshes(worm):
    with pytest.raises(ValueError, match="^mesh: .*open"):
        astrolith.fit_shape(worm.vertices, worm.faces[1:], base_only=True, strict=True)
    with pytest.raises(ValueError, match="^mesh: .*wrap"):
        astrolith.fit_shape(worm.vertices, worm.faces[: len(worm.faces) // 2], base_only=True)
    with pytest.raises(ValueError, match=r"^mesh\.faces: "):
        astrolith.fit_shape(worm.vertices, worm.faces.astype(np.int64) - 1)
    with pytest.raises(ValueError, match="^spheres: "):
        astrolith.fit_shape(worm, spheres=0)


def test_damaged_meshes_are_repaired(worm):
    closed, figures = astrolith.repair_mesh(worm.vertices, worm.faces[1:])
    assert figures.holes == 1 and figures.words.startswith("filled 1 hole")
    assert len(closed.faces) == len(worm.faces)
    same, figures = astrolith.repair_mesh(worm)
    assert figures.words == "" and (same.faces == worm.faces).all()
    packing = astrolith.pack_spheres(worm.vertices, worm.faces[1:], spheres=4)
    assert len(packing.radii) == 4
    mass = astrolith.gravity(closed, density=2000).figures.body.mass_kg
    assert abs(mass / astrolith.gravity(worm, density=2000).figures.body.mass_kg - 1) < 1e-3


def test_options_of_another_search_for_details_are_refused(worm):
    with pytest.raises(ValueError, match="generations"):
        astrolith.fit_shape(worm, details="relief", generations=3)
    with pytest.raises(ValueError, match="base_only"):
        astrolith.fit_shape(worm, details="relief", base_only=True)
