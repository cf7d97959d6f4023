#!/usr/bin/env python3
"""What engines, simulators and clusters get from the programs: small inputs, right values, and what the programs said.

    engine_inputs.py PROGRAMS [NAME ...]

PROGRAMS is the folder of the programs, such as build/release/bin. The Python package must be importable (PYTHONPATH). Each
row has a right value from a closed form, from NumPy or from another program; the last line counts those that hold. Rows
whose package is missing are passed over. Needs NumPy; SciPy, MuJoCo, PyVista, spiceypy, trimesh and usd-core where they are.
"""
import contextlib
import gzip
import io
import json
import pathlib
import subprocess
import sys
import tempfile
import warnings

import numpy as np

BALL = {"format_version": 1, "length_unit": "km", "body": {"type": "metaballs", "spheres": [[0, 0, 0, 1], [0.8, 0, 0.2, 0.7]]}}
ROOT = pathlib.Path(__file__).resolve().parents[2]
ROWS = []


def row(right):
    """A row of the table: a function of (programs, folder) whose result is compared with `right` by its own words."""
    def add(function):
        ROWS.append((function.__name__, right, function))
        return function

    return add


def ran(programs, folder, program, *words, status=0):
    done = subprocess.run([programs / program, *map(str, words)], cwd=folder, capture_output=True, text=True)
    assert done.returncode == status, done.stderr
    return done.stderr


def synth(programs, folder, *words):
    (folder / "r.json").write_text(json.dumps(BALL))
    return ran(programs, folder, "synth", "r.json", "--resolution", 32, *words)


def box_of_ply(programs, folder):
    import astrolith

    synth(programs, folder, "-o", "plain.ply", "--quiet")
    return np.ptp(astrolith.read_mesh(folder / "plain.ply").vertices, axis=0)


def near(found, right, share):
    return bool(np.allclose(found, right, rtol=share)), f"{np.round(np.atleast_1d(found), 4).tolist()}"


@row("positions in metres: 1000 times those of the .ply in km")
def glb_positions(programs, folder):
    synth(programs, folder, "-o", "r.glb", "--quiet")
    data = (folder / "r.glb").read_bytes()
    document = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
    accessor = document["accessors"][document["meshes"][0]["primitives"][0]["attributes"]["POSITION"]]
    return near(np.subtract(accessor["max"], accessor["min"]), 1000 * box_of_ply(programs, folder), 1e-5)


@row("metres in trimesh's geometry, without its scene")
def glb_in_trimesh(programs, folder):
    import trimesh

    synth(programs, folder, "-o", "r.glb", "--quiet")
    (geometry,) = trimesh.load(folder / "r.glb").geometry.values()
    return near(geometry.extents, 1000 * box_of_ply(programs, folder), 1e-5)


@row("metres in VTK's reader, y up")
def glb_in_vtk(programs, folder):
    import pyvista

    synth(programs, folder, "-o", "r.glb", "--quiet")
    points = np.array(pyvista.read(folder / "r.glb").combine().points)
    return near(np.ptp(points, axis=0), 1000 * box_of_ply(programs, folder)[[0, 2, 1]], 1e-5)


@row("gravity of a .glb and of its .ply: equal volumes")
def glb_is_read(programs, folder):
    volumes = []
    for name in ("r.glb", "r.ply"):
        synth(programs, folder, "-o", name, "--uv" if name == "r.glb" else "--quiet", "--quiet")
        ran(programs, folder, "gravity", name, "--density", 2000, "--summary", "s.json", "--quiet")
        volumes.append(json.loads((folder / "s.json").read_text())["body"]["volume_m3"])
    return near(volumes[0], volumes[1], 1e-5)


@row("an .obj in .gz weighs what it does unpacked")
def gz_is_read(programs, folder):
    synth(programs, folder, "-o", "r.obj", "--quiet")
    (folder / "p.obj.gz").write_bytes(gzip.compress((folder / "r.obj").read_bytes()))
    masses = []
    for name in ("r.obj", "p.obj.gz"):
        ran(programs, folder, "gravity", name, "--density", 2000, "--summary", "s.json", "--quiet")
        masses.append(json.loads((folder / "s.json").read_text())["body"]["mass_kg"])
    return near(masses[0], masses[1], 0.0)


@row("a .bds that CSPICE wrote weighs what its mesh does")
def bds_is_read(programs, folder):
    import astrolith
    from astrolith import bridges

    mesh = astrolith.mesh(BALL, resolution=32)
    bridges.write_dsk(mesh, folder / "r.bds", body=2025143, frame="J2000")
    ran(programs, folder, "gravity", "r.bds", "--density", 2000, "--summary", "s.json", "--quiet")
    mass = json.loads((folder / "s.json").read_text())["body"]["mass_kg"]
    return near(mass, astrolith.gravity(mesh, 2000.0).figures.body.mass_kg, 1e-9)


@row("an .obj with maps has its .mtl, whose images are there")
def obj_has_material(programs, folder):
    synth(programs, folder, "-o", "r.obj", "--uv", "charts", "--bake", 128, "--quiet")
    images = {line.split(" ", 1)[1] for line in (folder / "r.mtl").read_text().splitlines() if line.startswith(("map_", "norm"))}
    said = "mtllib r.mtl" in (folder / "r.obj").read_text()
    return said and images == {"r_normal.png", "r_occlusion.png"} and all((folder / i).is_file() for i in images), str(images)


def hull_row(most):
    def hull_encloses(programs, folder):
        import astrolith
        from astrolith import bridges
        from scipy.spatial import ConvexHull

        mesh = astrolith.mesh("itokawa", resolution=48)
        made = bridges.hull(mesh, most)
        planes = ConvexHull(made.vertices).equations
        beyond = (planes[:, :3] @ mesh.vertices.T.astype(float) + planes[:, 3:]).max() / np.ptp(mesh.vertices)
        return beyond <= 0 and len(made.vertices) <= most, f"{len(made.vertices)} vertices, {beyond:.1e} of the length outside"

    hull_encloses.__name__ = f"hull_of_{most}"
    return hull_encloses


for limit in (16, 64, 255):
    row(f"a hull of at most {limit} vertices around Itokawa")(hull_row(limit))


@row("Itokawa at rest on its hull in MuJoCo: 0 to .5 % of its length above the floor")
def rests_on_its_hull(programs, folder):
    import astrolith
    import mujoco
    from astrolith import bridges

    mesh = astrolith.mesh("itokawa", resolution=48)
    small = astrolith.Mesh(mesh.vertices.astype(float) * 10, mesh.faces, length_unit="m")  # 5.6 m long
    model, *_ = bridges.write_model(folder / "rock.xml", small, 2000.0)
    scene = mujoco.MjSpec.from_file(model)
    scene.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[50, 50, 1], pos=[0, 0, -3])
    loaded = scene.compile()
    state = mujoco.MjData(loaded)
    while state.time < 15.0:
        mujoco.mj_step(loaded, state)
    body = state.body("rock")
    gap = (small.vertices @ body.xmat.reshape(3, 3).T + body.xpos)[:, 2].min() + 3.0
    share = gap / np.ptp(small.vertices, axis=0).max()
    return 0.0 <= share <= 0.005, f"{100 * share:.3f} % of its length"


@row("the mass of the rigid body in a .usdz: that of gravity")
def usdz_is_a_rigid_body(programs, folder):
    import astrolith
    from astrolith import bridges
    from pxr import Usd, UsdPhysics

    synth(programs, folder, "-o", "r.glb", "--quiet")
    (file,) = bridges.write_usd(folder / "r.glb", folder / "r.usdz", density=2000.0)
    stage = Usd.Stage.Open(file)
    mass = UsdPhysics.MassAPI(stage.GetDefaultPrim()).GetMassAttr().Get()
    return near(mass, astrolith.gravity(astrolith.mesh(BALL, resolution=32), 2000.0).figures.body.mass_kg, 1e-5)


@row("values of facets in a .vtp: PyVista's are those of the .csv")
def vtp_has_values(programs, folder):
    import pyvista

    synth(programs, folder, "-o", "r.ply", "--quiet")
    for name in ("v.vtp", "v.csv"):
        ran(programs, folder, "gravity", "r.ply", "--density", 2000, "--sample", 0, "-o", name, "--quiet")
    table = np.genfromtxt(folder / "v.csv", delimiter=",", names=True)
    values = pyvista.read(folder / "v.vtp").cell_data["slope_deg"]
    return bool((np.array(values) == table["slope_deg"]).all()), f"{len(values)} facets"


@row("ValueError of from_pyvista for a grid")
def grids_are_value_errors(programs, folder):
    import pyvista
    from astrolith import bridges

    try:
        bridges.from_pyvista(pyvista.ImageData(dimensions=(3, 3, 3)))
    except ValueError as error:
        return True, str(error)
    return False, "nothing"


@row("a longer step passes over a fine layer: the gradient of the bare body")
def gradient_by_step(programs, folder):
    import astrolith

    rough = {**BALL, "layers": [{"type": "simplex", "amplitude": 0.002, "frequency": 100.0, "octaves": 1}]}
    points = astrolith.mesh(BALL, resolution=12).vertices.astype(float)
    bare = astrolith.Field(BALL).gradient(points)
    field = astrolith.Field(rough)
    fine, coarse = (np.abs(field.gradient(points, step=step) - bare).mean() for step in (0.002, 0.1))
    return coarse < 0.3 * fine, f"{fine:.3f} from it at .002, {coarse:.3f} at .1"


def photo(folder):
    from PIL import Image

    rng = np.random.default_rng(3)
    f, g = np.fft.fftfreq(256)[:, None], np.fft.fftfreq(256)[None, :]
    k = np.hypot((f + g) / 2**0.5 * 10, (f - g) / 2**0.5)
    k[0, 0] = 1
    s = np.fft.ifft2(np.fft.fft2(rng.normal(size=(256, 256))) * k**-1.5 * (k > 2 / 256)).real
    values = s / s.std() + np.linspace(-1.5, 1.5, 256)[None, :]  # light from one side
    Image.fromarray(np.round(np.interp(values, [values.min(), values.max()], [0, 255])).astype(np.uint8)).save(folder / "p.png")
    return values


@row("ridges at 45 degrees keep the correlation of their slopes within a fifth; the light is named")
def direction_is_kept(programs, folder):
    from PIL import Image

    def correlation(image):
        y, x = np.gradient(np.asarray(image, float))
        return (x * y).mean() / np.sqrt((x * x).mean() * (y * y).mean())

    own = correlation(photo(folder))
    said = ran(programs, folder, "fit_gabor", "p.png", "-o", "p.json", "--model", "exemplar")
    made = []
    for seed in range(1, 6):
        ran(programs, folder, "synth", "p.json", "--texture", "256x256", "--seed", seed, "-o", "t.png", "--quiet")
        made.append(correlation(Image.open(folder / "t.png")))
    ratio = np.mean(made) / own
    return 0.8 <= ratio <= 1.2 and "gradient of light" in said, f"{own:.2f}, ratio {ratio:.2f}"


@row("Didymos and Dimorphos turn by their own periods, both loaded, in either order")
def pairs_keep_their_spins(programs, folder):
    import astrolith
    import spiceypy as spice
    from astrolith import bridges

    mesh, worst = astrolith.mesh(BALL, resolution=12), 0.0
    pairs = [(("Didymos", 920065803, 2.26), ("Dimorphos", 120065803, 11.9)), (("Kalliope", 920000022, 4.1), ("Linus", 120000022, 86.2))]
    for pair in [order for pair in pairs for order in (pair, pair[::-1])]:
        for name, code, period in pair:
            kernels = bridges.write_kernels(mesh, folder, name, body=code, period=period)
            spice.furnsh([kernels.pck, kernels.fk])
        for name, code, period in pair:
            now, later = (np.array(spice.pxform(f"{name.upper()}_FIXED", "J2000", t)) for t in (0.0, 900.0 * period))
            worst = max(worst, np.abs(now.T @ later - [[0, -1, 0], [1, 0, 0], [0, 0, 1]]).max())
        spice.kclear()
    return worst < 1e-9, f"a quarter of a turn to {worst:.0e}"


@row("a recipe written through a link finds its image")
def recipes_through_links(programs, folder):
    photo(folder)
    ran(programs, folder, "fit_gabor", "p.png", "-o", "p.json", "--model", "exemplar", "--mm-per-px", 100, "--quiet")
    (folder / "deep/deeper").mkdir(parents=True)
    (folder / "link").symlink_to("deep/deeper")
    (folder / "base.json").write_text(json.dumps({**BALL, "length_unit": "m", "body": {"type": "metaballs", "spheres": [[0, 0, 0, 100]]}}))
    ran(programs, folder, "synth", "p.json", "--base", "base.json", "--write-recipe", "link/w.json", "--quiet")
    ran(programs, folder, "synth", "link/w.json", "-o", "w.ply", "--resolution", 16, "--quiet")
    image = [layer for layer in json.loads((folder / "link/w.json").read_text())["layers"]][0]["image"]
    return (folder / "link" / image).is_file(), image


@row("a set whose manifest lies behind a link is finished; a deleted body is missed; not of mode 600")
def sets_through_links(programs, folder):
    (folder / "r.json").write_text(json.dumps(BALL))
    (folder / "deep/deeper").mkdir(parents=True)
    (folder / "link").symlink_to("deep/deeper")
    line = ["r.json", "--members", "0:3", "-o", "bodies/{member}.ply", "--manifest", "link/m.jsonl", "--resolution", 12]
    ran(programs, folder, "synth", *line)
    again = ran(programs, folder, "synth", *line)
    merge = [sys.executable, ROOT / "workflows/merge_manifests.py", "3", "link", "-o", "all.jsonl"]
    joined = subprocess.run(merge, cwd=folder, capture_output=True, text=True)
    mode = oct((folder / "all.jsonl").stat().st_mode & 0o777)
    (folder / "bodies/0000001.ply").unlink()
    missed = subprocess.run(merge, cwd=folder, capture_output=True, text=True)
    right = "0 made, 3 already there" in again and joined.returncode == 0 and missed.returncode == 1
    return right and mode != "0o600", f"{joined.stdout.split(',')[0]}; {missed.stderr.strip()[:60]}; {mode}"


def main():
    programs, names = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]
    held = tried = 0
    warnings.simplefilter("ignore")
    for name, right, function in ROWS:
        if names and name not in names:
            continue
        with tempfile.TemporaryDirectory() as folder:
            try:
                with contextlib.redirect_stdout(io.StringIO()):
                    holds, said = function(programs, pathlib.Path(folder))
            except ImportError as missing:
                print(f"-      {name}: {missing.name} is missing", flush=True)
                continue
            except Exception as error:  # a row that fails is a row that does not hold
                holds, said = False, f"{type(error).__name__}: {error}"
        tried, held = tried + 1, held + holds
        print(f"{'right' if holds else 'WRONG'}  {name}: {right}\n       {said}", flush=True)
    print(f"{held} of {tried} rows are right")


if __name__ == "__main__":
    main()
