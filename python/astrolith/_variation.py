"""Other bodies of the same kind."""

from __future__ import annotations

import dataclasses
import pathlib
import tempfile
from typing import Any, Optional

from astrolith import _arrays, _options, _synthesis
from astrolith._mesh import MeshLike, surface_of
from astrolith._options import Progress
from astrolith._recipe import Recipe, RecipeLike, json_of, records
from astrolith._synth import synth


@dataclasses.dataclass(eq=False)
class Variation:
    """Another body of the same kind, with its measured similarity, strength (0 to 1), noise ("new" or "kept"), and
    mean and largest distance from the recipe's own body as fractions of the diagonal."""

    recipe: Recipe
    similarity: float
    strength: float
    noise: str
    mean_distance: float
    max_distance: float

    def __repr__(self) -> str:
        return f"<astrolith.Variation: similarity {self.similarity:.4f}, mean distance {self.mean_distance:.4f} of the diagonal>"


def vary(
    recipe: RecipeLike,
    delta: float,
    *,
    seed: int = 1,
    target: Optional[MeshLike] = None,
    threads: int = 0,
    progress: Progress = None,
) -> Variation:
    """Find another body of the same kind, as ``synth --vary`` does.

    Parameters
    ----------
    delta
        The similarity is at least 1 - delta, 0.001 to 1.
    seed
        The number of the variation.
    target
        The mesh that the body is to be like; None: the recipe's own body.

    Raises
    ------
    ValueError
        No variation will do; the message states the largest similarity that can be asked for.
    """
    json, name = json_of(recipe)
    if records(json).get("body") is None:
        raise ValueError(f"{name}: body: absent; lay its layers on a body with Recipe.laid_on")
    like = None if target is None else surface_of(target, "target")
    varied, figures = _synthesis.vary(
        json,
        name,
        _arrays.number(delta, "delta", 1e-3, 1.0),
        _options.seed(seed),
        None if like is None else like.vertices,
        None if like is None else like.faces,
        _options.threads(threads),
        progress,
    )
    return Variation(Recipe(records(varied)), **records(figures))


def draw(population: RecipeLike, *, seed: int = 1, threads: int = 0, progress: Progress = None, **conditions: Any) -> Recipe:
    """Draw a body that nobody has seen from a population of measured ones, as ``synth`` does.

    Parameters
    ----------
    population
        A recipe with a population, the name of its file, or ``"asteroids"``, that of the library.
    seed
        The number of the draw.
    conditions
        `diameter`, `axes`, `class_`, `source`, `near` and `details`, as :func:`synth` takes them.

    Returns
    -------
    Recipe
        A recipe with a body of type ``morph``.

    Raises
    ------
    ValueError
        The recipe has no population, or no two of its bodies fulfil the conditions.
    """
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "body.astro"
        synth(population, write_recipe=file, seed=seed, threads=threads, progress=progress, **conditions)
        return Recipe.read(file)
