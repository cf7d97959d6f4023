"""Statistics of surfaces: the program's figures, and NumPy in double precision as an independent reference."""

import json
import re

import astrolith
import numpy as np
import pytest
from conftest import ROOT, WORM

REGIONS = 40


def sphere(n=40, noise=0.0, seed=0):
    """A closed ball of meridians and parallels with random heights."""
    rng = np.random.default_rng(seed)
    theta, phi = np.meshgrid(np.pi * np.arange(1, n) / n, np.pi * np.arange(2 * n) / n, indexing="ij")
    ring = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1).reshape(-1, 3)
    points = np.concatenate([[[0, 0, 1]], ring, [[0, 0, -1]]]) * (1 + noise * rng.standard_normal((len(ring) + 2, 1)))
    at = lambda i, k: 1 + (i - 1) * 2 * n + k % (2 * n)
    faces = []
    for k in range(2 * n):
        faces.append((0, at(1, k), at(1, k + 1)))
        faces.append((len(points) - 1, at(n - 1, k + 1), at(n - 1, k)))
        for i in range(1, n - 1):
            faces += [(at(i, k), at(i + 1, k), at(i + 1, k + 1)), (at(i, k), at(i + 1, k + 1), at(i, k + 1))]
    return points, np.array(faces, dtype=np.uint32)


def test_figures_are_those_of_the_values():
    made = astrolith.describe_surface(sphere(noise=0.01), places=500)
    assert made.places.shape == (500, 3) and made.regions.max() < REGIONS
    fine = made.values["roughness_3"]
    described = made.figures.radii[0].roughness
    assert described.mean == pytest.approx(fine.mean()) and described.deviation == pytest.approx(fine.std())
    assert described.quantiles == pytest.approx(np.quantile(fine, [0.05, 0.25, 0.5, 0.75, 0.95], method="nearest"), abs=0.05)
    means = np.array([fine[made.regions == r].mean() for r in range(REGIONS) if (made.regions == r).any()])
    assert made.figures.regions.variance == pytest.approx(fine.var())
    assert made.figures.regions.variance_between == pytest.approx(means.var())
    apart = np.linalg.norm(made.places[:, None] - made.places[None], axis=-1) / made.figures.edge
    products = np.outer(fine - fine.mean(), fine - fine.mean())
    near = (apart >= 6) & (apart < 10) & (made.regions[:, None] == made.regions[None])
    assert made.figures.regions.correlations[0].correlation == pytest.approx(products[near].mean() / fine.var())
    slope = made.values["slope"]
    assert slope.min() >= 0 and made.figures.slopes.mean == pytest.approx(slope.mean())


def test_a_body_that_was_moved_is_brought_back():
    worm = astrolith.mesh(WORM, resolution=32)
    moved = (worm.vertices[:, [1, 2, 0]] + np.float32(5.0), worm.faces)
    made = astrolith.compare(worm, moved, align=True, points=200, samples=500)
    assert made.mean_distance < 1e-4 < 0.1 < astrolith.compare(worm, moved, points=200, samples=500).mean_distance
    np.testing.assert_allclose(np.linalg.det(np.array(made.alignment.rotation)), 1.0, atol=1e-9)


def test_the_verdict_has_the_bytes_of_compare(program, tmp_path):
    a, b = sphere(noise=0.01, seed=1), sphere(noise=0.004, seed=2)
    for name, (vertices, faces) in (("a.ply", a), ("b.ply", b)):
        astrolith.write_mesh(astrolith.Mesh(vertices, faces), tmp_path / name)
    a, b = astrolith.read_mesh(tmp_path / "a.ply"), astrolith.read_mesh(tmp_path / "b.ply")
    said = json.loads(program("compare", "a.ply", "b.ply", "--points", "300", "--samples", "500", "--realism", "--json",
                              "--unit", "km", "--places", "400", "--floor"))["realism"]  # fmt: skip
    verdict = astrolith.realism(a, b, unit="km", places=400, floor=True)
    assert verdict == said
    assert not verdict.passes and verdict.words[0].startswith("too smooth between")
    assert verdict.floor.p > 0.05


def test_distances_are_those_of_kolmogorov_and_smirnov():
    a, b = sphere(noise=0.01, seed=1), sphere(noise=0.007, seed=2)
    verdict = astrolith.realism(a, b, places=400, seed=5)
    of_a = astrolith.describe_surface(a, places=400, seed=5).values["roughness_3"]
    of_b = astrolith.describe_surface(b, places=400, seed=6).values["roughness_3"]
    every = np.sort(np.concatenate([of_a, of_b]))
    share = lambda values: np.searchsorted(np.sort(values), every, side="right") / len(values)
    fine = verdict.statistics[0]
    assert fine.statistic == "roughness" and fine.edges == 3
    assert fine.distance == pytest.approx(np.abs(share(of_a) - share(of_b)).max(), abs=1e-12)


def test_what_cannot_be_measured_is_refused():
    for refused in (lambda: astrolith.describe_surface(sphere(8)), lambda: astrolith.describe_surface(sphere(), points=10),
                    lambda: astrolith.realism(sphere(), sphere(), unit="mile")):  # fmt: skip
        with pytest.raises(ValueError):
            refused()


def test_the_document_explains_every_statistic():
    made = astrolith.describe_surface(sphere(noise=0.01), places=200)
    names = list(dict.fromkeys(name.split("_")[0] for name in made.values))
    page = (ROOT / "docs" / "surfaces.md").read_text()
    explained = re.findall(r"^\| ([a-z ]+) \|", page.split("| statistic | equation |")[1], re.MULTILINE)
    assert explained[: len(names)] == names


def test_a_crater_is_found():
    points, faces = sphere(60)
    t = np.linalg.norm(points - [1, 0, 0], axis=1) / 0.3
    rim = 0.018 * np.clip((2.5 - t) / 1.5, 0, 1) ** 3
    found = astrolith.find_craters((points * (1 + np.where(t < 1, 0.078 * t**2 - 0.06, rim))[:, None], faces))
    assert found.figures.likely == 1 and len(found.columns["x"]) == found.figures.listed
    assert found.columns["diameter"][0] == pytest.approx(0.6, rel=0.1)
    assert found.columns["x"][0] == pytest.approx(0.94, abs=0.02)
    with pytest.raises(ValueError, match="1000 triangles"):
        astrolith.find_craters(sphere(8))
    # The same turned outwards, and narrower, is a boulder.
    t = np.linalg.norm(points - [-1, 0, 0], axis=1) / 0.2
    both = astrolith.find_craters((points * (1 + 0.08 * np.clip(1 - t**2, 0, None))[:, None], faces), boulders=True)
    assert not found.columns["boulder"].any() and both.columns["boulder"].sum() == both.figures.boulders.listed >= 1
    assert both.columns["x"][both.columns["boulder"] > 0][0] == pytest.approx(-1.08, abs=0.05)
