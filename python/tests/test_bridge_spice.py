"""DSK, PCK and FK: what CSPICE reads, and where its rays meet the plates."""

import astrolith
import numpy as np
import pytest
from astrolith import bridges

spice = pytest.importorskip("spiceypy")

BODY = 2025143


@pytest.fixture(autouse=True)
def nothing_is_loaded():
    yield
    spice.kclear()


def nearest_crossings(corners, sources, directions):
    """The distances along unit rays to the first triangle that faces them; infinity where there is none.

    Moeller and Trumbore 1997. CSPICE does not see plates from behind either.
    """
    a, ab, ac = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    nearest = np.full(len(sources), np.inf)
    for k, (source, direction) in enumerate(zip(sources, directions)):
        p = np.cross(direction, ac)
        with np.errstate(divide="ignore", invalid="ignore"):
            scale = 1 / np.einsum("ij,ij->i", ab, p)
            t = source - a
            u = np.einsum("ij,ij->i", t, p) * scale
            q = np.cross(t, ab)
            v = (q @ direction) * scale
            distance = np.einsum("ij,ij->i", ac, q) * scale
        inside = (u >= -1e-12) & (v >= -1e-12) & (u + v <= 1 + 1e-12) & (distance > 0) & (scale > 0)
        if inside.any():
            nearest[k] = distance[inside].min()
    return nearest


def written_plates(file):
    """The corners of the plates of each segment of a DSK, as CSPICE reads them."""
    handle = spice.dasopr(str(file))
    found, corners = spice.dlabfs(handle), []
    while True:
        segment = found
        vertices_count, plates_count = spice.dskz02(handle, segment)
        vertices = np.array(spice.dskv02(handle, segment, 1, vertices_count))
        plates = np.array(spice.dskp02(handle, segment, 1, plates_count))
        corners.append(vertices[plates - 1])
        try:
            found = spice.dlafns(handle, segment)
        except spice.exceptions.NotFoundError:
            break
    spice.dascls(handle)
    return corners


@pytest.fixture
def site(example):
    """A body in metres, and a patch of it that is twenty times as fine."""
    recipe = astrolith.Recipe.read(example("itokawa_details"))
    body = astrolith.mesh(recipe, resolution=40)
    top = body.vertices[body.vertices[:, 2].argmax()].tolist()
    cell = body.figures.cell
    return body, astrolith.mesh(recipe, resolution=40, patch=(*top, 2 * cell))


def test_rays_of_cspice_meet_the_written_plates_of_two_segments(site, tmp_path):
    body, patch = site
    kernels = bridges.write_kernels([body, patch], tmp_path, "Itokawa", body=BODY, period=12.1324, pole=(90.5, -66.3))
    spice.furnsh([kernels.dsk, kernels.pck, kernels.fk])
    corners = written_plates(kernels.dsk)
    assert [len(c) for c in corners] == [len(body.faces), len(patch.faces)]
    place = np.array(patch.origin) / 1000
    expected = (patch.vertices.astype(float) / 1000 + place)[patch.faces]
    np.testing.assert_allclose(corners[1], expected, rtol=0, atol=1e-15)
    radius = np.abs(corners[0]).max()

    # 150 rays towards the body, and 150 towards the patch from near by.
    random = np.random.default_rng(1)
    ends = random.normal(size=(300, 3))
    ends /= np.linalg.norm(ends, axis=1)[:, None]
    sources, targets = 2 * radius * ends, random.uniform(-0.2, 0.2, (300, 3)) * radius
    targets[150:] = place + random.uniform(-0.4, 0.4, (150, 3)) * np.ptp(corners[1].reshape(-1, 3), axis=0)
    sources[150:] = targets[150:] + 0.3 * radius * (ends[150:] * [1, 1, 0] + [0, 0, 1])
    directions = targets - sources
    directions /= np.linalg.norm(directions, axis=1)[:, None]

    for surfaces, plates in (([], np.concatenate(corners)), ([1], corners[0]), ([2], corners[1])):
        ours = nearest_crossings(plates, sources, directions)
        points, found = spice.dskxv(False, "ITOKAWA", surfaces, 0.0, "ITOKAWA_FIXED", sources, directions)
        found = np.array(found, bool)
        assert (found == np.isfinite(ours)).all() and found.sum() > (120 if surfaces == [2] else 270)
        meets = sources + np.where(found, ours, 0)[:, None] * directions
        assert np.abs(np.array(points) - meets)[found].max() <= 1e-9 * radius


def test_what_cspice_wrote_is_read(site, tmp_path):
    body, patch = site
    bridges.write_dsk([body, patch], tmp_path / "two.bds", body=BODY, frame="J2000")
    read = astrolith.read_mesh(tmp_path / "two.bds")
    assert read.length_unit == "km" and len(read.faces) == len(body.faces) + len(patch.faces)
    expected = np.concatenate([body.vertices.astype(float), patch.vertices + np.array(patch.origin)]) / 1000
    np.testing.assert_allclose(read.vertices, expected, rtol=0, atol=1e-15)


@pytest.mark.parametrize("codes", [(920065803, 120065803), (920000022, 120000022), (920001862, 120001862), (120065803, 120000022)])
def test_pairs_of_the_new_numbering_have_frames_of_their_own(site, tmp_path, codes):
    body, _ = site
    frames = set()
    for code in codes:
        kernels = bridges.write_kernels(body, tmp_path, f"Body{code}", body=code, period=10.0)
        spice.furnsh(kernels.fk)
        frames.add(spice.namfrm(f"BODY{code}_FIXED"))
        assert spice.cidfrm(code)[1] == f"BODY{code}_FIXED"
    assert len(frames) == 2 and all(1_400_000 <= frame <= 2_000_000 for frame in frames)


def test_a_given_unit_wins_over_what_a_file_states(site, tmp_path):
    body, file = site[0], tmp_path / "body.ply"
    astrolith.write_mesh(body, file)
    bridges.write_dsk(file, tmp_path / "m.bds", body=BODY, frame="J2000")
    with pytest.warns(UserWarning, match=r"^unit: .*body\.ply states m; it is taken in km"):
        bridges.write_dsk(file, tmp_path / "km.bds", body=BODY, frame="J2000", unit="km")
    (in_metres,), (in_kilometres,) = (written_plates(tmp_path / name) for name in ("m.bds", "km.bds"))
    np.testing.assert_allclose(in_kilometres, 1000 * in_metres, rtol=1e-12)


def test_the_frame_turns_and_the_radii_are_half_the_box(site, tmp_path):
    body, _ = site
    kernels = bridges.write_kernels(body, tmp_path, "Itokawa", body=BODY, period=12.0, pole=(90.0, 45.0), meridian=30.0)
    spice.furnsh([kernels.dsk, kernels.pck, kernels.fk])
    assert spice.bodn2c("ITOKAWA") == BODY and spice.cidfrm(BODY)[1] == "ITOKAWA_FIXED"
    _, radii = spice.bodvcd(BODY, "RADII", 3)
    np.testing.assert_allclose(radii, np.ptp(body.vertices.astype(float), axis=0) / 2000, rtol=1e-12)
    now, later = (np.array(spice.pxform("ITOKAWA_FIXED", "J2000", t)) for t in (0.0, 3 * 3600.0))
    np.testing.assert_allclose(now[:, 2], [0, np.sqrt(0.5), np.sqrt(0.5)], atol=1e-12)
    np.testing.assert_allclose(now.T @ later, [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-12)
    assert spice.dskobj(kernels.dsk)[0] == BODY


@pytest.mark.parametrize("first", [0, 1])
def test_both_bodies_of_a_pair_keep_their_spins(site, tmp_path, first):
    body, _ = site
    pair = [("Didymos", 920065803, 2.26), ("Dimorphos", 120065803, 11.4)]
    for name, code, period in (pair[first], pair[1 - first]):
        kernels = bridges.write_kernels(body, tmp_path, name, body=code, period=period)
        spice.furnsh([kernels.pck, kernels.fk])
    for name, code, period in pair:
        turn = np.array(spice.pxform("J2000", f"{name.upper()}_FIXED", period * 900.0))  # a quarter of a turn
        at_start = np.array(spice.pxform("J2000", f"{name.upper()}_FIXED", 0.0))
        np.testing.assert_allclose((turn @ at_start.T), [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], atol=1e-9)


def test_wrong_kernels_leave_no_file(site, tmp_path):
    body, _ = site
    for name, call in (
        ("surfaces", lambda: bridges.write_dsk(body, tmp_path / "a.bds", body=BODY, frame="J2000", surfaces=[1, 2])),
        ("meshes", lambda: bridges.write_dsk([], tmp_path / "a.bds", body=BODY, frame="J2000")),
        ("meshes", lambda: bridges.write_dsk(body.vertices, tmp_path / "a.bds", body=BODY, frame="J2000")),
        ("name", lambda: bridges.write_kernels(body, tmp_path, "25143", body=BODY, period=1.0)),
        ("period", lambda: bridges.write_kernels(body, tmp_path, "Itokawa", body=BODY, period=0.0)),
    ):
        with pytest.raises(ValueError, match=f"^{name}: "):
            call()
    with pytest.raises(spice.exceptions.SpiceyError):
        bridges.write_dsk(body, tmp_path / "a.bds", body=BODY, frame="NO_SUCH_FRAME")
    assert not list(tmp_path.iterdir())
