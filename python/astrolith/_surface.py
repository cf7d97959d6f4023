"""What surfaces are like from place to place, and whether one passes for another."""

from __future__ import annotations

import dataclasses

import numpy as np
import numpy.typing as npt

from astrolith import _arrays, _options, _synthesis
from astrolith._mesh import MeshLike, surface_of, pair_of
from astrolith._options import Progress
from astrolith._recipe import Record, records


@dataclasses.dataclass(eq=False)
class SurfaceDescription:
    """The statistics of a surface.

    Attributes
    ----------
    figures
        What ``describe --surface`` writes as JSON.
    places
        float64 points on the surface, (n, 3).
    values
        What was measured at the places, float64 (n,) each, by its name in ``docs/surfaces.md``: "roughness_3" within
        3 mean edges, then those of 6, 12 and 24 edges, and "bend" and "slope", which have no radius.
    regions
        The region of each place, uint8 below 40.
    remarks
        What could not be measured, one line each.
    """

    figures: Record
    places: npt.NDArray[np.float64]
    values: dict[str, npt.NDArray[np.float64]]
    regions: npt.NDArray[np.uint8]
    remarks: list[str]

    def __repr__(self) -> str:
        return f"<astrolith.SurfaceDescription: {len(self.places)} places, {len(self.values)} statistics>"


def _points(points: int) -> int:
    points = _arrays.integer(points, "points", 0, 60000)
    if 0 < points < 500:
        raise ValueError(f"points: {points} is outside 500 to 60000; 0 stands for the mesh's own")
    return points


def describe_surface(
    mesh: MeshLike,
    *,
    points: int = 0,
    places: int = 3000,
    period: float = 0.0,
    density: float = 2000.0,
    seed: int = 1,
    threads: int = 0,
    progress: Progress = None,
) -> SurfaceDescription:
    """Measure what a surface is like from place to place.

    Parameters
    ----------
    mesh
        A mesh of at least 1,000 triangles. An open one has no slopes.
    points
        Evenly spread points that stand for the surface; they decide the edge in which radii count. 0: as many as the
        mesh has vertices, up to 60,000.
    places
        Of these points, at which the surface is measured, 100 to 20,000.
    period, density
        Hours of rotation about +z, 0 at rest, and kg/m3, for slopes.

    Raises
    ------
    ValueError
        The mesh has too few triangles or no area, or an argument is out of range.
    """
    arrays = surface_of(mesh, "mesh")
    made = _synthesis.surface(
        arrays.name,
        arrays.vertices,
        arrays.faces,
        _points(points),
        _arrays.integer(places, "places", 100, 20000),
        _arrays.number(period, "period", 0.0, 1e18),
        _arrays.positive(density, "density", 1e18),
        _options.seed(seed),
        _options.threads(threads),
        progress,
    )
    made["figures"] = records(made["figures"])
    return SurfaceDescription(**made)


@dataclasses.dataclass(eq=False)
class Craters:
    """The craters, and boulders where they were asked for, that were found on a surface, the surest first.

    Attributes
    ----------
    figures
        The member ``craters`` of the summary of ``describe --craters``: counts, sizes, depth over diameter; with
        boulders their figures, too, as the member ``boulders``.
    columns
        The columns of its table, float64 (n,) each, by their names: "x", "y" and "z" of the floor, "diameter",
        "depth", "rim_height", "freshness", "completeness", "confidence", ...; "boulder" is 1 of boulders, whose depth is
        their height, and 0 of craters.
    """

    figures: Record
    columns: dict[str, npt.NDArray[np.float64]]

    def __repr__(self) -> str:
        return f"<astrolith.Craters: {len(self.columns['x'])}>"


def find_craters(
    mesh: MeshLike, *, boulders: bool = False, points: int = 0, seed: int = 1, threads: int = 0, progress: Progress = None
) -> Craters:
    """Find the craters of a surface.

    Parameters
    ----------
    mesh
        A mesh of at least 1,000 triangles.
    boulders
        Whether large boulders are found, too.
    points
        Evenly spread points that stand for the surface: craters of 6 of their mean edges and more are found. 0: as
        many as the mesh has vertices, up to 60,000; else 500 to 1,000,000.

    Raises
    ------
    ValueError
        The mesh has too few triangles or no area, or an argument is out of range.
    """
    arrays = surface_of(mesh, "mesh")
    made = _synthesis.craters(
        arrays.name,
        arrays.vertices,
        arrays.faces,
        _arrays.flag(boulders, "boulders"),
        _arrays.integer(points, "points", 0, 1000000),
        _options.seed(seed),
        _options.threads(threads),
        progress,
    )
    made["figures"] = records(made["figures"])
    return Craters(**made)


def realism(
    a: MeshLike,
    b: MeshLike,
    *,
    points: int = 0,
    places: int = 3000,
    period: float = 0.0,
    density: float = 2000.0,
    floor: bool = False,
    unit: str = "",
    seed: int = 1,
    threads: int = 0,
    progress: Progress = None,
) -> Record:
    """Judge whether the surface of `b` passes for that of `a`, by what both are like from place to place.

    Parameters
    ----------
    points, places, period, density
        As of :func:`describe_surface`; `points` 0: as many as the coarser mesh has vertices.
    floor
        Whether `a` is also judged against itself, sampled again: `b` cannot do better.
    unit
        "m" or "km": the unit of both meshes, for the lengths in `words`; "": what they state.

    Returns
    -------
    Record
        The member ``realism`` of what ``compare --realism --json`` writes: passes, words, p, largest_distance,
        statistics, and beside the verdict bands and coupling_ratio.

    Raises
    ------
    ValueError
        A mesh has too few triangles or no area, or an argument is out of range.
    """
    of_a, of_b, unit = pair_of(a, b, unit)
    figures: Record = records(
        _synthesis.realism(
            of_a.name,
            of_a.vertices,
            of_a.faces,
            of_b.name,
            of_b.vertices,
            of_b.faces,
            _points(points),
            _arrays.integer(places, "places", 100, 20000),
            _arrays.number(period, "period", 0.0, 1e18),
            _arrays.positive(density, "density", 1e18),
            _arrays.flag(floor, "floor"),
            unit,
            _options.seed(seed),
            _options.threads(threads),
            progress,
        )
    )
    return figures
