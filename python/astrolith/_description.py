"""Descriptions of shapes, and comparisons of two."""

from __future__ import annotations

import dataclasses

import numpy as np
import numpy.typing as npt

from astrolith import _arrays, _options, _synthesis
from astrolith._mesh import MeshLike, surface_of, pair_of
from astrolith._options import Progress
from astrolith._recipe import Record, records


@dataclasses.dataclass(eq=False)
class Description:
    """The histogram of a shape, which moving, turning and scaling do not change.

    Attributes
    ----------
    histogram
        float64 frequencies with one axis a feature, (bins, ...): what ``describe`` writes.
    points, pairs
        Number of samples and of pairs of them.
    max_distance
        The largest distance of two samples, in the unit of the vertices.
    remarks
        What was left out, one line each.
    """

    histogram: npt.NDArray[np.float64]
    points: int
    pairs: int
    max_distance: float
    vertices_left_out: int
    undefined_curvatures: int
    remarks: list[str]

    def __repr__(self) -> str:
        return f"<astrolith.Description: {self.points} points, histogram {self.histogram.shape}>"


_FEATURES = ("ahd", "wahl")


def describe(
    mesh: MeshLike,
    *,
    features: str = "ahd",
    bins: int = 5,
    points: int = 10000,
    seed: int = 1,
    threads: int = 0,
    progress: Progress = None,
) -> Description:
    """Describe a shape by the features of pairs of its surface points.

    Parameters
    ----------
    mesh
        A mesh; vertices with normals and without faces will do.
    features
        "wahl": the four features of a pair; "ahd": also curvature and normal perturbation.
    bins
        Bins of each axis, 2 to 10.
    points
        Samples of the surface, 2 to 2**24; the time grows with their square.

    Raises
    ------
    ValueError
        The mesh has no area, or an argument is out of range.
    """
    arrays = surface_of(mesh, "mesh", points=True)
    bins = _arrays.integer(bins, "bins", 2, 10)
    made = _synthesis.describe(
        arrays.name,
        arrays.vertices,
        arrays.faces,
        arrays.normals,
        _arrays.choice(features, "features", _FEATURES),
        bins,
        _arrays.integer(points, "points", 2, 2**24),
        _options.seed(seed),
        _options.threads(threads),
        progress,
    )
    histogram = made.pop("frequencies").reshape((bins,) * made.pop("axes"))
    return Description(histogram, **made)


def compare(
    a: MeshLike,
    b: MeshLike,
    *,
    features: str = "ahd",
    bins: int = 5,
    points: int = 10000,
    samples: int = 100000,
    align: bool = False,
    unit: str = "",
    seed: int = 1,
    threads: int = 0,
    progress: Progress = None,
) -> Record:
    """Measure how alike two meshes are, and how far apart their surfaces lie where they are, `b` in the unit of `a`.

    Where both state m, km, cm or mm, `b` is scaled to the unit of `a`.

    Parameters
    ----------
    samples
        Points of each surface for the distances between the surfaces, 100 to 10**7.
    align
        Whether `b` is moved and turned onto `a` before the distances are measured; `alignment` holds the motion p -> R p +
        shift. Sizes stay.
    unit
        "m" or "km": the unit of both meshes; "": what they state.

    Returns
    -------
    Record
        The figures of ``compare``: similarity, similarity_floor of two samplings of each, l2, chi_square, jensen_shannon, earth_movers; mean_distance,
        p99_distance and max_distance as fractions of the diagonal of a's box; in_units_of_the_files; length_unit.

    Raises
    ------
    ValueError
        A mesh has no area, or an argument is out of range.
    """
    of_a, of_b, unit = pair_of(a, b, unit)
    figures: Record = records(
        _synthesis.compare(
            of_a.name,
            of_a.vertices,
            of_a.faces,
            of_b.name,
            of_b.vertices,
            of_b.faces,
            _arrays.choice(features, "features", _FEATURES),
            _arrays.integer(bins, "bins", 2, 10),
            _arrays.integer(points, "points", 2, 2**24),
            _arrays.integer(samples, "samples", 100, 10**7),
            _arrays.flag(align, "align"),
            _options.seed(seed),
            _options.threads(threads),
            progress,
        )
    )
    if unit:
        figures["length_unit"] = unit
    return figures
