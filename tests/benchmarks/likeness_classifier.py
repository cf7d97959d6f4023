#!/usr/bin/env python3
"""Whether a classifier can tell likeness from the measured ground: the area under its curve, .5 where it cannot.

    likeness_classifier.py build/release/bin RECIPE... [--seeds 1 2] [--patches 1500]     needs the Python package and NumPy

Meshes of the recipe and of `--like` are evened at as many facets as the model had. Patches of 16 x 16 heights, a mean edge
apart, are cut in tangent frames turned at random; a plane and curvature are taken off. Features are 400 random small
convolutions: their largest value, the share above a bias, the logarithm of their spread. A ridge classifier learns on three
quarters of 16 regions of the body and is tested on the others, in turn. The control is the recipe's mesh made again with 3 %
fewer triangles. Scatter between draws of patches and convolutions is some .01.
"""
import pathlib
import tempfile

import astrolith
import numpy

from measure import Run, arguments_of, head, row

SIDE, REGIONS, FOLDS, KERNELS = 16, 16, 4, 400
SHAPES = (3, 1), (3, 2), (5, 1), (5, 2), (7, 1)  # of convolutions: pixels along a side, and how far apart


class Ground:
    """The vertices of a mesh in cells of a patch's reach, so that facets near a place are found."""

    def __init__(self, mesh, edge):
        self.corners = mesh.vertices[mesh.faces] / edge
        across = numpy.cross(self.corners[:, 1] - self.corners[:, 0], self.corners[:, 2] - self.corners[:, 0])
        self.areas = numpy.linalg.norm(across, axis=1) / 2
        self.normals = across / numpy.maximum(2 * self.areas, 1e-30)[:, None]
        self.middles = self.corners.mean(axis=1)
        cells = numpy.floor(self.middles / self.REACH).astype(int)
        self.cells = {}
        for facet, cell in enumerate(map(tuple, cells)):
            self.cells.setdefault(cell, []).append(facet)

    REACH = SIDE / 2 * 2**0.5 + 2

    def near(self, place, normal):
        """The facets within reach that face the same side."""
        cell = numpy.floor(place / self.REACH).astype(int)
        found = [self.cells.get(tuple(cell + step - 1), []) for step in numpy.ndindex(3, 3, 3)]
        facets = numpy.concatenate([numpy.array(f, int) for f in found])
        close = numpy.linalg.norm(self.middles[facets] - place, axis=1) < self.REACH
        return facets[close & (self.normals[facets] @ normal > 0)]

    def patch(self, place, normal, angle):
        """Heights over the tangent plane, less the quadric that fits best; None where the plane misses the ground."""
        facets = self.near(place, normal)
        up = self.areas[facets] @ self.normals[facets]
        up /= numpy.linalg.norm(up)
        right = numpy.cross(up, numpy.eye(3)[numpy.argmin(abs(up))])
        right /= numpy.linalg.norm(right)
        ahead = numpy.cross(up, right)
        frame = numpy.array([numpy.cos(angle) * right + numpy.sin(angle) * ahead,
                             numpy.cos(angle) * ahead - numpy.sin(angle) * right, up])  # fmt: skip
        heights = raster((self.corners[facets] - place) @ frame.T + [SIDE / 2 - 0.5, SIDE / 2 - 0.5, 0])
        if not numpy.isfinite(heights).all():
            return None
        return (heights.ravel() - QUADRIC @ (QUADRIC.T @ heights.ravel())).reshape(SIDE, SIDE)


def quadric():
    x, y = (numpy.mgrid[:SIDE, :SIDE] - (SIDE - 1) / 2).reshape(2, -1)
    return numpy.linalg.qr(numpy.stack([x * 0 + 1, x, y, x * x, x * y, y * y], axis=1))[0]


QUADRIC = quadric()


def raster(corners):
    """The greatest height of the facets over each point of the square, -inf where there is none."""
    low, high = corners[:, :, :2].min(axis=1), corners[:, :, :2].max(axis=1)
    kept = (high >= 0).all(axis=1) & (low <= SIDE - 1).all(axis=1)
    first, spans = numpy.ceil(low[kept]), int((high[kept] - numpy.ceil(low[kept])).max(initial=0)) + 1
    a, b, c = corners[kept].transpose(1, 2, 0)
    e, f = b - a, c - a
    whole = e[0] * f[1] - e[1] * f[0]
    whole[whole <= 0] = numpy.nan
    heights = numpy.full((SIDE, SIDE), -numpy.inf)
    for step in numpy.ndindex(spans, spans):
        x, y = (first + step).T
        u = ((x - a[0]) * f[1] - (y - a[1]) * f[0]) / whole
        v = ((y - a[1]) * e[0] - (x - a[0]) * e[1]) / whole
        over = (u >= 0) & (v >= 0) & (u + v <= 1) & (x >= 0) & (y >= 0) & (x < SIDE) & (y < SIDE)
        at = x[over].astype(int), y[over].astype(int)
        numpy.maximum.at(heights, at, (a[2] + u * e[2] + v * f[2])[over])
    return heights


def patches_of(ground, count, random):
    """Patches at places spread evenly over the area, and the places."""
    patches, places = [], []
    for facet in random.choice(len(ground.areas), 2 * count, p=ground.areas / ground.areas.sum()):
        patch = ground.patch(ground.middles[facet], ground.normals[facet], random.uniform(0, 2 * numpy.pi))
        if patch is not None and len(patches) < count:
            patches.append(patch), places.append(ground.middles[facet])
    return numpy.array(patches, numpy.float32), numpy.array(places)


def features_of(patches, random):
    """(n x 3 KERNELS) of convolutions of 3 x 3 to 7 x 7 pixels; biases are values of the patches."""
    features = []
    for side, step in SHAPES:
        kernels = random.normal(size=(KERNELS // len(SHAPES), side, side)).astype(numpy.float32)
        kernels = (kernels - kernels.mean(axis=(1, 2), keepdims=True)).reshape(len(kernels), -1).T
        reach = step * (side - 1) + 1
        windows = numpy.lib.stride_tricks.sliding_window_view(patches, (reach, reach), axis=(1, 2))[..., ::step, ::step]
        values = windows.reshape(len(patches), -1, side * side) @ kernels
        bias = values[random.integers(len(values), size=kernels.shape[1]), 0, numpy.arange(kernels.shape[1])]
        features += [values.max(axis=1), (values > bias).mean(axis=1), numpy.log(values.std(axis=1) + 1e-6)]
    return numpy.concatenate(features, axis=1).astype(float)


def regions_of(places, random):
    """The number of each place's region: that of the nearest of centres far from each other."""
    centres = [places[random.integers(len(places))]]
    distances = numpy.linalg.norm(places - centres[0], axis=1)
    while len(centres) < REGIONS:
        centres.append(places[numpy.argmax(distances)])
        distances = numpy.minimum(distances, numpy.linalg.norm(places - centres[-1], axis=1))
    return numpy.argmin(numpy.linalg.norm(places[:, None] - numpy.array(centres), axis=2), axis=1)


def scores(features, labels, tested):
    """What a ridge classifier that learns from the others says of those tested; leave-one-out chooses the penalty."""
    learnt = features[~tested]
    mean, spread = learnt.mean(axis=0), learnt.std(axis=0) + 1e-12
    x, y = (learnt - mean) / spread, labels[~tested] - labels[~tested].mean()
    u, s, vt = numpy.linalg.svd(x, full_matrices=False)
    best = None
    for penalty in 10.0 ** numpy.arange(0, 7):
        shrink = s**2 / (s**2 + penalty)
        left = (y - u @ (shrink * (u.T @ y))) / (1 - (u**2 @ shrink))
        if best is None or (left**2).sum() < best[0]:
            best = (left**2).sum(), vt.T @ (shrink / s * (u.T @ y))
    return (features[tested] - mean) / spread @ best[1]


def area_under_curve(values, labels):
    ranks = numpy.argsort(numpy.argsort(values))
    ones = labels > 0
    return (ranks[ones].mean() - (ones.sum() - 1) / 2) / (~ones).sum()


def told_apart(one, other, count, seed):
    """The mean area under the curve over the folds."""
    random = numpy.random.default_rng(seed)
    (a, at), (b, bt) = patches_of(one, count, random), patches_of(other, count, random)
    features = features_of(numpy.concatenate([a, b]), random)
    labels = numpy.repeat([0.0, 1.0], [len(a), len(b)])
    folds = regions_of(numpy.concatenate([at, bt]), random) % FOLDS
    return numpy.mean([area_under_curve(scores(features, labels, folds == k), labels[folds == k]) for k in range(FOLDS)])


def row_of(programs, recipe, given, folder):
    edge = next(layer for layer in astrolith.Recipe.read(recipe)["layers"] if layer["type"] == "relief")["edge"]
    area = astrolith.mesh(astrolith.Recipe.read(recipe), resolution=128).area

    def ground(name, facets, *options):
        mesh = folder / f"{name}.ply"
        Run(programs / "synth", recipe, *options, "--triangles", int(facets), "--even", "-o", mesh, "--quiet")
        return Ground(astrolith.read_mesh(mesh), edge)

    facets = area / (3**0.5 / 4 * edge**2)
    measured = ground("measured", facets)
    others = [ground("again", 0.97 * facets), *(ground("like", facets, "--like", "--seed", s) for s in given.seeds)]
    return (recipe.stem, *(f"{told_apart(measured, other, given.patches, 1):.2f}" for other in others))


if __name__ == "__main__":
    given = arguments_of(__doc__, "programs", "recipes", patches=1500, seeds={"type": int, "nargs": "+", "default": [1, 2]})
    head("body", "made again", *(f"like, seed {seed}" for seed in given.seeds))
    with tempfile.TemporaryDirectory() as folder:
        for recipe in given.recipes:
            row(*row_of(given.programs, recipe, given, pathlib.Path(folder)))
