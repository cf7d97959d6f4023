"""The gravity of bodies."""

from __future__ import annotations

import dataclasses
import os
from typing import Any, Mapping, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from astrolith import _arrays, _options, _synthesis
from astrolith._mesh import MeshLike, surface_of, unit_of
from astrolith._options import Progress
from astrolith._recipe import RecipeLike, Record, json_of, records
from astrolith._units import METRES


@dataclasses.dataclass(eq=False)
class Gravity:
    """The gravity of a body at n places, as :func:`gravity` computes it.

    ``docs/gravity.md`` has the equations. Arrays are columns of `table`, without a copy.

    Attributes
    ----------
    table
        (n, 11) float64, or (n, 9) at points: what ``gravity -o FILE.npy`` writes.
    columns
        The names of the table's columns, with units.
    figures
        What ``gravity --json`` prints: unit, facets, body (mass, moments and axes), harmonics, values (ranges and means),
        achieved_error; sites.
    """

    table: npt.NDArray[np.float64]
    columns: list[str]
    figures: Record

    def __repr__(self) -> str:
        return f"<astrolith.Gravity: {len(self.table)} {self.figures['places']}, columns {', '.join(self.columns)}>"

    def _column(self, name: str) -> npt.NDArray[np.float64]:
        if name not in self.columns:
            raise ValueError(f"{name}: points have no normals, so there is none; ask for facets or vertices")
        return self.table[:, self.columns.index(name)]

    def mean(self, column: str) -> float:
        """Return the mean of a column over the surface, weighted by area, as the program states it.

        ``slope.mean()`` would count a small facet as much as a large one. Of points it is the mean of all.

        Parameters
        ----------
        column
            One of `columns`, such as "slope_deg".
        """
        stated = self.figures["values"].get(column)
        return float(self._column(column).mean() if stated is None else stated["mean"])

    @property
    def points(self) -> npt.NDArray[np.float64]:
        """(n, 3) positions in the body's unit."""
        return self.table[:, :3]

    @property
    def potential(self) -> npt.NDArray[np.float64]:
        """(n) J/kg, negative: minus the potential U of attraction."""
        return self._column("potential_J_kg")

    @property
    def acceleration(self) -> npt.NDArray[np.float64]:
        """(n, 3) m/s2: the attraction alone, without the centrifugal part."""
        return self.table[:, 4:7]

    @property
    def geopotential(self) -> npt.NDArray[np.float64]:
        """(n) J/kg: attraction and rotation together."""
        return self._column("geopotential_J_kg")

    @property
    def effective_gravity(self) -> npt.NDArray[np.float64]:
        """(n) m/s2: the length of attraction and centrifugal acceleration together."""
        return self._column("effective_gravity_m_s2")

    @property
    def slope(self) -> npt.NDArray[np.float64]:
        """(n) degrees from 0 to 180. Raises ValueError for points, which have no normals."""
        return self._column("slope_deg")

    @property
    def elevation(self) -> npt.NDArray[np.float64]:
        """(n) metres above the mean geopotential of the surface. Raises ValueError for points."""
        return self._column("elevation_m")

    @property
    def sites(self) -> list[Record]:
        """The landing sites, best first: center, normal, latitude_deg, longitude_deg, mean_slope_deg, largest_slope_deg,
        roughness_m, cost_deg and patch, the words of ``synth --patch``. Empty where none were asked for."""
        return list(self.figures.get("sites", []))

    @property
    def coefficients(self) -> npt.NDArray[np.float64]:
        """(2, degree + 1, degree + 1): C[l, m] and S[l, m] of the spherical harmonics, 4 pi normalised.

        They are about the centre of mass, without the sign of Condon and Shortley, for the reference radius
        ``figures.harmonics.reference_radius_m``. The array is laid out as those of pyshtools.
        """
        rows = np.array(self.figures["harmonics"]["degree_order_c_s"])
        degree, order = rows[:, 0].astype(int), rows[:, 1].astype(int)
        result = np.zeros((2, degree.max() + 1, degree.max() + 1))
        result[:, degree, order] = rows[:, 2:].T
        return result


def is_recipe(body: Any) -> bool:
    """Whether a body is a recipe: a mapping, or a file or a name of the library that has one."""
    if not _arrays.is_file_name(body):
        return isinstance(body, Mapping)
    file = _synthesis.find_body(_arrays.file_name(body, "body"))
    return os.fsdecode(file).endswith((".json", ".astro"))


def _site_lengths(sites: int, size: Optional[float], distance: Optional[float], at_facets: bool) -> tuple[float, float]:
    """The side of landing sites and their distance; 0 where none are asked for."""
    if not _arrays.integer(sites, "sites", 0, 1000):
        for name, value in (("site_size", size), ("site_distance", distance)):
            if value is not None:
                raise ValueError(f"{name}: is about sites; pass sites=N")
        return 0.0, 0.0
    if size is None:
        raise ValueError("site_size: is missing; pass the side of a site, in the body's unit")
    if not at_facets:
        raise ValueError("sites: need slopes of facets; leave out points and at")
    side = _arrays.positive(size, "site_size", 1e18)
    return side, 2.0 * side if distance is None else _arrays.positive(distance, "site_distance", 1e18)


def gravity(
    body: Union[MeshLike, RecipeLike],
    density: float,
    *,
    period: Optional[float] = None,
    axis: Sequence[float] = (0, 0, 1),
    unit: Optional[str] = None,
    at: str = "facets",
    points: Optional[npt.ArrayLike] = None,
    tolerance: float = 1e-7,
    exact: bool = False,
    sample: int = 100,
    degree: int = 4,
    radius: float = 0.0,
    resolution: int = 128,
    sites: int = 0,
    site_size: Optional[float] = None,
    site_distance: Optional[float] = None,
    seed: int = 1,
    threads: int = 0,
    progress: Progress = None,
) -> Gravity:
    """Compute the gravity of a body of uniform density that turns, as the program ``gravity`` does.

    Parameters
    ----------
    body
        A closed mesh with faces counter-clockwise seen from outside, or a recipe with a body.
    density
        kg/m3, above 0.
    period
        The period of rotation in hours; None: the body is at rest.
    axis
        The axis of rotation, which passes through the centre of mass.
    unit
        The unit of a mesh's coordinates: "m", "km", "cm" or "mm". None: what the mesh or its file states, else km. A
        recipe states its own.
    at
        "facets": at their centres; "vertices": at these.
    points
        (n, 3) positions in the body's unit, inside or outside, that take the place of `at`.
    tolerance
        A bound of the relative error of each acceleration, 1e-12 to 0.1.
    exact
        Whether to sum over all facets exactly; 50,000 facets take minutes. Places beyond some 15 radii take multipoles
        to order 10, which are more exact there.
    sample
        Places that are also computed exactly, to state the error achieved, all if there are no more; 0 to 100,000.
    degree
        The degree of the spherical harmonics, 0 to 50.
    radius
        Their reference radius in the body's unit; 0: the distance of the farthest vertex.
    resolution
        Cells along the longest side of a recipe's body, 8 to 4096.
    sites
        How many places to land to find by the slopes of the facets, 0 to 1000: level, smooth, and apart from one another.
    site_size
        The side of a site's square in the body's unit: at least 4 mean edges of the mesh, at most a quarter of the body.
    site_distance
        Between the centres of two sites at least, in the body's unit; None: two sides.
    seed
        Chooses the sample.

    Returns
    -------
    Gravity
        Columns of numbers and figures of the whole body.

    Raises
    ------
    ValueError
        The mesh is open or has faces of opposite senses, which ``astrolith.repair_mesh`` mends; the recipe has no body,
        or an argument is out of range.
    RuntimeError
        `progress` returned False.

    Examples
    --------
    >>> ball = {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[0, 0, 0, 1]]}
    >>> body = {"format_version": 1, "length_unit": "km", "body": ball}
    >>> made = gravity(body, 2000.0, period=5.0, resolution=24)
    >>> bool(abs(made.effective_gravity.mean() / (4 / 3 * np.pi * 6.6743e-11 * 2000 * 1000) - 1) < 0.2)
    True
    """
    towards = _arrays.vector(axis, "axis")
    if not any(towards):
        raise ValueError("axis: 0 0 0 is no direction; give another")
    _arrays.choice(at, "at", ("facets", "vertices"))
    side, apart = _site_lengths(sites, site_size, site_distance, at == "facets" and points is None)
    name, json, arrays, length_unit = "body", "", None, ""
    if is_recipe(body):
        json, name = json_of(body, "body")
        if unit is not None:
            raise ValueError("unit: a recipe states its own; leave the argument out")
    else:
        arrays = surface_of(body, "body")
        name, length_unit = arrays.name, unit_of(body, unit, tuple(METRES), "body")
    table, columns, figures = _synthesis.gravity(
        name,
        None if arrays is None else arrays.vertices,
        None if arrays is None else arrays.faces,
        length_unit,
        json,
        _arrays.integer(resolution, "resolution", 8, 4096),
        at,
        None if points is None else _arrays.rows(points, "points"),
        _arrays.positive(density, "density", 1e18),
        0.0 if period is None else _arrays.positive(period, "period", 1e18),
        towards,
        _arrays.number(tolerance, "tolerance", 1e-12, 0.1),
        _arrays.flag(exact, "exact"),
        _arrays.integer(sample, "sample", 0, 100000),
        _arrays.integer(degree, "degree", 0, 50),
        _arrays.number(radius, "radius", 0.0, 1e18),
        _arrays.integer(sites, "sites", 0, 1000),
        side,
        apart,
        _options.seed(seed),
        _options.threads(threads),
        progress,
    )
    return Gravity(table, columns, records(figures))
