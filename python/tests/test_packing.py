"""Packings of spheres: the table of the program, what is inside, wrong arguments."""

import astrolith
import numpy as np
import pytest

pytest.importorskip("astrolith._estimation")


@pytest.fixture(scope="module")
def peanut():
    body = {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[-0.8, 0, 0, 1.0], [0.8, 0, 0, 0.9]]}
    return astrolith.mesh({"format_version": 1, "length_unit": "m", "body": body}, resolution=28)


@pytest.mark.parametrize("density", [None, 1900.0])
def test_a_packing_of_a_file_has_the_table_of_fit_shape(peanut, program, tmp_path, density):
    astrolith.write_mesh(peanut, tmp_path / "peanut.ply")
    words = [] if density is None else ["--density", density]
    program("fit_shape", "peanut.ply", "-o", "program.csv", "--packing-only", "--spheres", 9, "--unit", "m", *words)
    packing = astrolith.pack_spheres(tmp_path / "peanut.ply", spheres=9, unit="m", density=density, output=tmp_path / "p.csv")
    assert (tmp_path / "p.csv").read_bytes() == (tmp_path / "program.csv").read_bytes()
    table = np.genfromtxt(tmp_path / "p.csv", delimiter=",", names=True, comments="#", skip_header=2)
    np.testing.assert_allclose(packing.centers, np.column_stack([table[axis] for axis in "xyz"]), rtol=1e-8)
    np.testing.assert_allclose(packing.radii, table["radius"], rtol=1e-8)
    if density is None:
        assert packing.masses is None
    else:
        np.testing.assert_allclose(packing.masses, table["mass"], rtol=1e-8)


def test_spheres_lie_inside_and_apart_and_weigh_what_the_body_weighs(peanut):
    packing = astrolith.pack_spheres(peanut.vertices, peanut.faces, spheres=20, unit="m", density=2000.0, threads=1)
    assert packing.centers.shape == (20, 3) and packing.radii.shape == packing.masses.shape == (20,)
    assert (np.diff(packing.radii) <= 0).all() and not packing.stopped_early
    gaps = np.linalg.norm(packing.centers[:, None] - packing.centers, axis=2) - packing.radii[:, None] - packing.radii
    assert gaps[~np.eye(20, dtype=bool)].min() > -1e-9
    corners = peanut.vertices.astype(float)[peanut.faces]
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert packing.filling_rate == pytest.approx((4 / 3 * np.pi * packing.radii**3).sum() / volume, rel=1e-6)
    assert packing.masses.sum() == pytest.approx(2000.0 * volume, rel=1e-6)
    to_surface = np.linalg.norm(peanut.vertices[:, None] - packing.centers, axis=2)
    assert (to_surface >= packing.radii - 1e-6).all()


def test_a_packing_has_the_unit_of_the_mesh_and_stops_when_asked(peanut):
    assert astrolith.pack_spheres(peanut, spheres=1).length_unit == "m"
    some = astrolith.pack_spheres(peanut, spheres=5000, progress=lambda done, words: done < 0.01)
    assert some.stopped_early and len(some.radii) < 5000


def test_wrong_packings(peanut, tmp_path):
    for wrong, message in (
        ({"spheres": 0}, "^spheres: must be a number between 1"),
        ({"density": 0.0}, "^density: must be a number above 0"),
        ({"unit": "px"}, "^unit: "),
        ({"output": tmp_path / "p.json"}, "is no .csv file"),
        ({"output": tmp_path / "none" / "p.csv"}, "none"),
    ):
        with pytest.raises(ValueError, match=message):
            astrolith.pack_spheres(peanut, **wrong)
    with pytest.raises(ValueError, match="^mesh: .*open"):
        astrolith.pack_spheres(peanut.vertices, peanut.faces[1:], strict=True)
