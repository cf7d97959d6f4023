#!/usr/bin/env python3
"""Whether bodies drawn from a population pass for measured ones, each judged by draws whose donors it is not among.

    population.py build/release/bin SHAPES_FOLDER [--population FILE.json] [--draws 60] [--splits 4] [--only likeness ...]

Needs NumPy and SciPy. SHAPES_FOLDER has closed models as .ply, NAME_*.ply, of which the finest of each name counts.
fit_population makes the population of them (some 15 seconds of the processor for each), unless --population names one.

  likeness     half of the bodies are the donors of the draws that are compared with the other half, and the other way round in
               the next split: an energy test (p by permutation), how often one nearest neighbour tells both apart (.5 where
               it cannot), and how far a draw is from the nearest measured body, over how far these are from each other
  calibration  20 draws with a body's axis ratios (5 %) alone: the share of features within the central 90 % of the draws, and
               the bodies that are not the farthest of the 21 from the other 20, by Mahalanobis distance
  source       the same with the kind of source given too
  surfaces     bodies drawn near one of the library, as large, with the ground that `synth` lays: whether `compare --realism`
               takes their surface for that of the model of the body whose ground it is, and roughness by scale over its own;
               with --like its last step is made
  topology     of all these draws, those in one piece without handles, and how many attempts they took
  cost         seconds of the processor for a body of 20,000 triangles with one thread, and bytes of its recipe

Features are those of shared/reference/new_bodies: 16 numbers of a shape, here of samples of its surface averaged over a tenth
of its radius, so that the number of a model's facets does not matter.
"""
import json
import pathlib
import tempfile

import numpy
from scipy.sparse import csr_matrix
from scipy.spatial import ConvexHull, cKDTree

from measure import Run, arguments_of, head, row

ROWS = "likeness", "calibration", "source", "surfaces", "topology", "cost"
BENDING = [f"{what} of bending at {scale}" for scale in (".25", ".5") for what in ("mean", "spread", "skew", "most")]
NAMES = "b/a", "c/b", "hull", "area", "farthest", "nearest", "tilt", "most tilt", *BENDING
SAMPLES, TESTED, REACH = 24000, 6000, 0.1  # samples of a surface, those that have features, radius of their average
AXES_DEVIATION, TRIANGLES, TIMED = 0.05, 20000, 10
LIBRARY = pathlib.Path(__file__).parents[2] / "library/bodies.json"
LEAST_FACETS = 20000  # of models whose surfaces are compared


def read_ply(path):
    """Corners and facets of a binary .ply of triangles."""
    header, data = path.read_bytes().split(b"end_header\n", 1)
    counts, kinds = {}, []
    for words in map(str.split, header.decode().splitlines()):
        if words[0] == "element":
            counts[element := words[1]] = int(words[2])
        elif words[0] == "property" and element == "vertex":
            kinds.append((words[2], {"float": "<f4", "double": "<f8", "uchar": "u1"}[words[1]]))
    vertices = numpy.frombuffer(data, numpy.dtype(kinds), counts["vertex"])
    facets = numpy.frombuffer(data, [("count", "u1"), ("corners", "<i4", 3)], counts["face"], vertices.nbytes)
    return numpy.stack([vertices[axis].astype(float) for axis in "xyz"], 1), facets["corners"]


def moments(corners):
    """Volume, centre and covariance of the solid within the triangles."""
    volumes = numpy.einsum("ij,ij->i", corners[:, 0], numpy.cross(corners[:, 1], corners[:, 2])) / 6
    volume = volumes.sum()
    centre = volumes @ corners.sum(1) / 4 / volume
    corners = corners - centre
    volumes = numpy.einsum("ij,ij->i", corners[:, 0], numpy.cross(corners[:, 1], corners[:, 2])) / 6
    points = *corners.transpose(1, 0, 2), corners.sum(1)
    return volume, centre, sum((p * volumes[:, None]).T @ p for p in points) / (20 * volume)


def averages(tree, others, radius, *values, facing=None):
    """Means of the values of the tree's points within a radius of the others, of those alone that face the same side."""
    pairs = others.sparse_distance_matrix(tree, radius, output_type="coo_matrix")
    i, j = pairs.row, pairs.col
    if facing is not None:
        same = numpy.einsum("ij,ij->i", facing[0][i], facing[1][j]) > 0
        i, j = i[same], j[same]
    near = csr_matrix((numpy.ones(len(i)), (i, j)), (others.n, tree.n))
    return [near @ v / near.sum(1).reshape(-1, 1) for v in values]


def shape_of(path):
    """Logarithms of the half axes, and the 16 features, of a closed model."""
    vertices, facets = read_ply(path)
    volume, centre, covariance = moments(vertices[facets])
    radius = abs(3 * volume / 4 / numpy.pi) ** (1 / 3)
    vertices = (vertices - centre) / radius
    corners = vertices[facets]
    across = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) * numpy.sign(volume)
    areas = numpy.linalg.norm(across, axis=1) / 2
    random = numpy.random.default_rng(0)
    facet = random.choice(len(facets), SAMPLES, p=areas / areas.sum())
    places = random.random((SAMPLES, 2))
    places = numpy.where(places.sum(1, keepdims=True) > 1, 1 - places, places)
    points = corners[facet, 0] + numpy.einsum("ik,ikj->ij", places, corners[facet, 1:] - corners[facet, :1])
    normals = across[facet] / (2 * areas[facet, None])
    tested, sides = cKDTree(points[:TESTED]), (normals[:TESTED], normals)
    points, normals = averages(cKDTree(points), tested, REACH, points, normals, facing=sides)
    flat = numpy.linalg.norm(normals, axis=1)
    normals /= flat[:, None]
    far = numpy.linalg.norm(points, axis=1)
    tilt = numpy.einsum("ij,ij->i", points, normals) / far
    axes = numpy.log(numpy.sort(numpy.linalg.eigvalsh(covariance))[::-1]) / 2
    features = [axes[1] - axes[0], axes[2] - axes[1], numpy.log(ConvexHull(vertices).volume * 3 / 4 / numpy.pi),
                numpy.log(areas.sum() * flat.mean() / (4 * numpy.pi)), numpy.log(far.max()), numpy.log(far.min()),
                1 - tilt.mean(), tilt.min()]  # fmt: skip
    some = slice(0, TESTED, 4)
    for reach in (0.25, 0.5):  # how far the mean of the neighbours lies above the tangent plane
        (middles,) = averages(cKDTree(points), cKDTree(points[some]), reach, points)
        bend = numpy.einsum("ij,ij->i", middles - points[some], normals[some]) / reach
        features += [bend.mean(), bend.std(), ((bend - bend.mean()) ** 3).mean() / bend.std() ** 3, numpy.quantile(bend, 0.98)]
    return axes - axes.mean(), numpy.array(features)


def distances(a, b):
    return numpy.linalg.norm(a[:, None] - b[None], axis=2)


def energy_p(measured, drawn, random):
    """The share of permutations whose energy distance is at least that of the two samples."""
    far, count = distances(both := numpy.r_[measured, drawn], both), len(measured)

    def energy(order):
        a, b = order[:count], order[count:]
        return 2 * far[numpy.ix_(a, b)].mean() - far[numpy.ix_(a, a)].mean() - far[numpy.ix_(b, b)].mean()

    found = energy(numpy.arange(len(far)))
    return numpy.mean([energy(random.permutation(len(far))) >= found for _ in range(1000)])


def nearest_neighbour(measured, drawn, random):
    """How often the nearest other shape is of the same kind, with as many of both."""
    kind, right = numpy.arange(2 * len(measured)) < len(measured), []
    for _ in range(500):
        both = numpy.r_[measured, drawn[random.choice(len(drawn), len(measured), replace=False)]]
        numpy.fill_diagonal(far := distances(both, both), numpy.inf)
        right.append((kind[far.argmin(1)] == kind).mean())
    return numpy.mean(right)


def farther(rows):
    """How many of the rows are at least as far as the first from the mean of the others, by Mahalanobis distance.

    Covariances are drawn halfway to their diagonals, since they come from few more rows than they have columns.
    """
    found = []
    for i in range(len(rows)):
        others = numpy.delete(rows, i, 0)
        covariance = numpy.cov(others.T)
        covariance = (covariance + numpy.diag(numpy.diag(covariance))) / 2
        found.append((off := rows[i] - others.mean(0)) @ numpy.linalg.solve(covariance, off))
    return sum(d >= found[0] for d in found[1:])


class Draws:
    """Bodies of the population without some of them, and what their manifests say."""

    def __init__(self, bin, folder, population):
        self.bin, self.folder, self.population, self.lines, self.asked = bin, folder, population, [], 0

    def __call__(self, without, count, *conditions):
        """The manifest's lines of the bodies that were made, and what the command took."""
        place = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
        bodies = [{key: value for key, value in body.items() if key != "recipe"}
                  for body in self.population["population"]["bodies"] if body["name"] not in without]  # fmt: skip
        (place / "population.json").write_text(json.dumps({**self.population, "population": {"bodies": bodies}}))
        run = Run(self.bin / "synth", place / "population.json", "--members", f"0:{count}", "-o", place / "{member}.ply",
                  "--write-recipe", place / "{member}.astro", "--manifest", place / "made.jsonl", "--details", "none",
                  "--triangles", TRIANGLES, "--device", "cpu", "--quiet", *conditions, check=False)  # fmt: skip
        if run.errors:
            print(run.errors.strip().splitlines()[-1])
        made = place / "made.jsonl"
        lines = list(map(json.loads, made.read_text().splitlines())) if made.exists() else []
        self.asked, self.lines = self.asked + count, self.lines + lines
        return [place / line["files"][0]["name"] for line in lines], lines, run

    def features(self, *arguments):
        return numpy.array([shape_of(file)[1] for file in self(*arguments)[0]])


def likeness(draws, shapes, count, splits):
    head("judged", "donors", "energy p", "nearest neighbour", "nearest measured: drawn", "measured", "ratio")
    names, every = sorted(shapes), numpy.array([shapes[name][1] for name in sorted(shapes)])
    deviation, found, gaps = every.std(0), [], []
    numpy.fill_diagonal(among := distances(every / deviation, every / deviation), numpy.inf)
    for split in splits:
        random = numpy.random.default_rng(split // 2)
        order, half = random.permutation(len(names)), (len(names) + 1) // 2
        judged = order[:half] if split % 2 else order[half:]
        drawn = draws.features({names[i] for i in judged}, count)
        measured, drawn = every[judged] / deviation, drawn / deviation
        gap, usual = numpy.median(distances(drawn, every / deviation).min(1)), numpy.median(among.min(1))
        found.append((energy_p(measured, drawn, random), nearest_neighbour(measured, drawn, random), gap, usual, gap / usual))
        gaps.append(numpy.median(drawn, 0) - numpy.median(measured, 0))
        row(f"{len(judged)}, split {split}", len(names) - len(judged), *(f"{number:.2f}" for number in found[-1]))
    row("median", "", *(f"{number:.2f}" for number in numpy.median(found, 0)))
    gap = numpy.mean(gaps, 0)
    print("Medians of the draws that differ most, in deviations of the measured bodies:",
          ", ".join(f"{NAMES[k]} {gap[k]:+.2f}" for k in numpy.argsort(-abs(gap))[:5]))  # fmt: skip


def calibration(draws, shapes, judged, with_source):
    head("body", "draws", "features within 90 %", "draws as far", "outside")
    sources = {b["name"]: b.get("source", "") for b in draws.population["population"]["bodies"]}
    within, jointly = [], 0
    for name in judged:
        axes, truth = shapes[name]
        ratios = ":".join(f"{number:.4f}" for number in numpy.exp(axes - axes[2]))
        conditions = ["--axes", f"{ratios}+-{AXES_DEVIATION}"]
        if with_source and sources[name]:
            conditions += ["--source", sources[name]]
        drawn = draws.features({name}, 20, *conditions)
        if len(drawn) < 20:
            row(name, len(drawn), "", "", "not judged")
            continue
        low, high = numpy.quantile(drawn, [0.05, 0.95], axis=0)
        within.append((low <= truth) & (truth <= high))
        as_far = farther(numpy.r_[truth[None], drawn])
        jointly += as_far > 0
        out = [NAMES[k] + ("-" if truth[k] < low[k] else "+") for k in numpy.flatnonzero(~within[-1])]
        row(name, len(drawn), f"{within[-1].mean():.2f}", as_far, ", ".join(out))
    row("all", "", f"{numpy.mean(within):.2f}", f"{jointly} of {len(judged)} bodies within", "")


def surfaces(bin, folder, models, ground):
    head("near", "donors", "ground", "passes", "largest distance", "p", "roughness by scale, over the model's")
    passed, bands = [], []
    for seed, measured in enumerate(json.loads(LIBRARY.read_text())["bodies"]):
        name, metres = measured["name"], 1000 * measured["mean_diameter_km"]
        facets = name in models and len(read_ply(models[name])[1])
        if not facets or facets < LEAST_FACETS:
            continue
        drawn, said = folder / f"near_{name}.ply", folder / f"near_{name}.json"
        Run(bin / "synth", "asteroids", "--near", name, "--diameter", f"{metres:.6g}", "--seed", seed, "--triangles", facets,
            "--even", "-o", drawn, "--summary", said, "--quiet", *ground)  # fmt: skip
        body = json.loads(said.read_text())["drawn_body"]
        found = Run(bin / "compare", models[body["ground"]], drawn, "--realism", "--json", "--quiet").json()["realism"]
        donors = ", ".join(f"{donor['name']} {donor['share']:.0%}" for donor in body["donors"])
        ratios = [band["ratio"] for band in found["bands"]]
        row(name, donors, body["ground"], found["passes"], f"{found['largest_distance']:.3f}", f"{found['p']:.3f}",
            " ".join(f"{ratio:.2f}" for ratio in ratios))  # fmt: skip
        passed.append(found["passes"])
        bands.append(ratios)
    most = max(map(len, bands))
    medians = [numpy.median([ratios[k] for ratios in bands if k < len(ratios)]) for k in range(most)]
    row("all", "", "", f"{sum(passed)} of {len(passed)}", "", "", " ".join(f"{m:.2f}" for m in medians))


def main():
    arguments = arguments_of(__doc__, "bin", "folder", like={"action": "store_true"}, population="", draws=60, splits=4, judged=16,
                             only={"nargs": "+", "choices": ROWS, "default": ROWS})  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        files = sorted(arguments.folder.glob("*.ply"), key=lambda file: file.stat().st_size)
        models = {file.stem.split("_")[0]: file for file in files if "DEFECT" not in file.stem}
        if "surfaces" in arguments.only:
            print("surfaces")
            surfaces(arguments.bin, pathlib.Path(folder), models, ["--like"] if arguments.like else [])
        if arguments.only == ["surfaces"]:
            return
        made = pathlib.Path(arguments.population or folder + "/population.json")
        if not arguments.population:
            Run(arguments.bin / "fit_population", *models.values(), "-o", made)
        population = json.loads(made.read_text())
        names = [b["name"] for b in population["population"]["bodies"]]
        shapes = {name: shape_of(models[name.split("_")[0]]) for name in names}
        draws = Draws(arguments.bin, folder, population)
        if "likeness" in arguments.only:
            likeness(draws, shapes, arguments.draws, range(arguments.splits))
        judged = sorted(numpy.random.default_rng(0).permutation(names)[: arguments.judged])
        for kind in ("calibration", "source"):
            if kind in arguments.only:
                print(f"\n{kind}")
                calibration(draws, shapes, judged, kind == "source")
        if "topology" in arguments.only:
            draws.asked or draws(set(), arguments.draws)
            whole = sum(line["components"] == 1 and line["genus"] == 0 for line in draws.lines)
            attempts = [line["drawn_body"]["attempts"] for line in draws.lines]
            print(f"\nOne piece, genus 0: {whole} of {draws.asked} draws, {attempts.count(1)} of them at once, "
                  f"others in up to {max(attempts)} attempts")  # fmt: skip
        if "cost" in arguments.only:
            _, lines, run = draws(set(), TIMED, "--threads", 1)
            sizes, seconds = [line["files"][1]["bytes"] for line in lines], run.seconds / TIMED
            print(f"\nA body: {seconds:.2f} s of the processor, {numpy.mean(sizes):.0f} bytes, at most {max(sizes)}")


if __name__ == "__main__":
    main()
