"""The field of a recipe at points."""

from __future__ import annotations

from typing import Optional

import numpy as np
import numpy.typing as npt

from astrolith import _arrays, _options, _synthesis
from astrolith._options import Progress
from astrolith._recipe import RecipeLike, json_of, records


class Field:
    """The field F of a recipe: positive inside, about a distance near the surface, whose F = 0 is the surface.

    Parameters
    ----------
    recipe
        A recipe with a body.

    Raises
    ------
    ValueError
        The recipe breaks a rule, or has no body.

    Notes
    -----
    Layers too fine for float coordinates of the body's frame are left out (:attr:`left_out`); a ``patch`` of
    :func:`mesh` has them.
    """

    def __init__(self, recipe: RecipeLike) -> None:
        json, name = json_of(recipe)
        self._field = _synthesis.Field(json, name)
        self._origin = np.asarray(records(json).get("origin", (0.0, 0.0, 0.0)), np.float64)
        self._name = name

    def __repr__(self) -> str:
        (x, y, z), (right, far, up) = self.bounds
        return f"<astrolith.Field of {self._name}: within ({x:.4g}, {y:.4g}, {z:.4g}) and ({right:.4g}, {far:.4g}, {up:.4g})>"

    def value(self, points: npt.ArrayLike, *, threads: int = 0, progress: Progress = None) -> npt.NDArray[np.float64]:
        """Evaluate F, in length units.

        Parameters
        ----------
        points
            (n, 3) float64 or float32 positions in the body-fixed frame. float64 is read in place.
        threads
            Threads to use; 0: all. They do not change the result.

        Returns
        -------
        ndarray
            (n) float64.

        Raises
        ------
        ValueError
            `points` has another shape or type, or a number that is not finite.
        """
        return self._field.value(self._local(points), _options.threads(threads), progress)

    def gradient(
        self,
        points: npt.ArrayLike,
        *,
        step: Optional[float] = None,
        threads: int = 0,
        progress: Progress = None,
    ) -> npt.NDArray[np.float64]:
        """Evaluate the gradient of F, (n, 3) float64 without a unit; it points inwards. As :meth:`value` otherwise.

        Parameters
        ----------
        step
            The step of central differences along each axis, length units: a longer one passes over finer layers. None:
            that of :attr:`gradient_step`, and the analytic gradient of a bare body.
        """
        if step is None:
            return self._field.gradient(self._local(points), _options.threads(threads), progress)
        length = _arrays.positive(step, "step", 1e30)
        rows = self._local(points)
        found = np.empty(rows.shape, np.float64)
        for axis, shift in enumerate(length * np.eye(3)):
            ahead, behind = (self._field.value(np.ascontiguousarray(rows + side * shift), _options.threads(threads), progress)
                             for side in (1.0, -1.0))  # fmt: skip
            found[:, axis] = (ahead - behind) / (2.0 * length)
        return found

    def inside(self, points: npt.ArrayLike, *, threads: int = 0, progress: Progress = None) -> npt.NDArray[np.bool_]:
        """Return (n) bool: whether F > 0. As :meth:`value` otherwise."""
        return self._field.inside(self._local(points), _options.threads(threads), progress)

    def _local(self, points: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """The points relative to the recipe's origin."""
        rows = _arrays.rows(points, "points", empty=True)
        return rows - self._origin if self._origin.any() else rows

    @property
    def bounds(self) -> npt.NDArray[np.float64]:
        """(2, 3) float64: the lower and the upper corner of a box that holds the whole surface, length units."""
        return np.array(self._field.bounds()) + self._origin

    @property
    def gradient_step(self) -> float:
        """The step of the central differences of :meth:`gradient`, length units."""
        return self._field.gradient_step()

    @property
    def left_out(self) -> list[tuple[int, float, float]]:
        """What float coordinates cannot resolve: layer (-1: the body's warp), share of variance, finest length."""
        return self._field.left_out()
