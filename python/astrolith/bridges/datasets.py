"""Bodies as a dataset for training: a sequence whose items are made when they are asked for."""

from __future__ import annotations

from typing import Any, Callable, Iterable, Iterator, Mapping, Optional, Sequence, Union, overload

import numpy as np
import numpy.typing as npt

from astrolith import _arrays, _options
from astrolith._mesh import Mesh
from astrolith._meshing import mesh
from astrolith._recipe import RecipeLike
from astrolith._variation import vary
from astrolith.bridges._optional import required
from astrolith.bridges.finished_set import FinishedSet


class Bodies:
    """The bodies of some recipes, each with several seeds.

    Item k is a dictionary: ``recipe`` (the recipe's number), ``seed``, ``vertices`` (n, 3) float32, ``faces`` (m, 3)
    int64 and ``normals`` (n, 3) float32; with `points`, ``points`` and ``point_normals`` (points, 3) float32 instead.
    An item is the same whenever and wherever it is made. A slice gives a list of items.

    Parameters
    ----------
    recipes
        Recipes, dictionaries or files.
    seeds
        The seeds of each recipe. They change its noise, craters and boulders.
    resolution
        Cells along the longest side of a body.
    delta
        None: the bodies keep their base. Else each is a variation whose similarity is at least 1 - delta, as
        :func:`astrolith.vary` finds it, which takes some seconds a body.
    points
        Surface points, uniform in area, instead of the mesh; 0: the mesh. All items have the same shape then.
    threads
        Threads of each item; 1 suits a loader with several workers.

    Examples
    --------
    >>> ball = {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[0, 0, 0, 1]]}
    >>> bodies = Bodies([{"format_version": 1, "length_unit": "m", "body": ball}], seeds=range(3), resolution=16, points=64)
    >>> len(bodies), bodies[2]["seed"], bodies[2]["points"].shape
    (3, 2, (64, 3))
    """

    def __init__(
        self,
        recipes: Sequence[RecipeLike],
        *,
        seeds: Sequence[int] = (1,),
        resolution: int = 64,
        delta: Optional[float] = None,
        points: int = 0,
        threads: int = 1,
    ) -> None:
        if _arrays.is_file_name(recipes) or isinstance(recipes, Mapping):
            raise ValueError("recipes: must be a list of recipes; put the one into a list")
        if not isinstance(seeds, Iterable):
            raise ValueError(f"seeds: must be whole numbers, such as range(100), and is {_arrays.shown(seeds)}")
        self._recipes = list(recipes)
        self._seeds = [_options.seed(seed) for seed in seeds]
        self._resolution = _arrays.integer(resolution, "resolution", 4, 8192)
        self._delta = None if delta is None else _arrays.number(delta, "delta", 1e-3, 1.0)
        self._points = _arrays.integer(points, "points", 0, 2**24)
        self._threads = _options.threads(threads)

    def __len__(self) -> int:
        return len(self._recipes) * len(self._seeds)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return (self[k] for k in range(len(self)))

    def __repr__(self) -> str:
        return f"<astrolith.bridges.Bodies: {len(self._recipes)} recipes x {len(self._seeds)} seeds, resolution {self._resolution}>"

    @overload
    def __getitem__(self, index: int) -> dict[str, Any]: ...

    @overload
    def __getitem__(self, index: slice) -> list[dict[str, Any]]: ...

    def __getitem__(self, index: Union[int, slice]) -> Union[dict[str, Any], list[dict[str, Any]]]:
        if isinstance(index, slice):
            return [self[k] for k in range(*index.indices(len(self)))]
        length = len(self)
        k = index.__index__()
        if not -length <= k < length:
            raise IndexError(f"index: must be from {-length} to {length - 1}, and is {k}")
        number, place = divmod(k % length, len(self._seeds))
        seed = self._seeds[place]
        body = self.mesh(number, seed)
        item: dict[str, Any] = {"recipe": number, "seed": seed}
        if self._points:
            item["points"], item["point_normals"] = _sampled(body, self._points, seed)
        else:
            item.update(vertices=body.vertices, faces=body.faces.astype(np.int64), normals=body.normals)
        return item

    def mesh(self, recipe: int, seed: int) -> Mesh:
        """Make the body of the recipe of this number with this seed."""
        chosen = self._recipes[recipe]
        if self._delta is None:
            return mesh(chosen, resolution=self._resolution, seed=seed, threads=self._threads)
        varied = vary(chosen, self._delta, seed=seed, threads=self._threads)
        return mesh(varied.recipe, resolution=self._resolution, threads=self._threads)


def _sampled(body: Mesh, count: int, seed: int) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
    """Points uniform in area with their facets' normals, by numbers that depend on the seed alone."""
    a, b, c = (body.vertices[body.faces[:, k]].astype(np.float64) for k in range(3))
    across = np.cross(b - a, c - a)
    areas = np.linalg.norm(across, axis=1)
    random = np.random.Generator(np.random.PCG64(seed)).random((3, count))
    chosen = np.searchsorted(np.cumsum(areas), random[0] * areas.sum(), side="right").clip(0, len(areas) - 1)
    root = np.sqrt(random[1])[:, None]
    share = random[2][:, None]
    points = a[chosen] * (1 - root) + b[chosen] * (root * (1 - share)) + c[chosen] * (root * share)
    normals = across[chosen] / np.maximum(areas[chosen], 1e-300)[:, None]
    return points.astype(np.float32), normals.astype(np.float32)


def torch_dataset(bodies: Union[Bodies, FinishedSet], transform: Optional[Callable[[dict[str, Any]], Any]] = None) -> Any:
    """Make a ``torch.utils.data.Dataset`` of bodies, or of a finished set, whose arrays are tensors.

    A ``DataLoader`` with workers must start them with ``multiprocessing_context="spawn"``, as :func:`torch_loader` does. With `points` the items of
    a batch have the same shape; meshes need a ``batch_size`` of None or a ``collate_fn``.

    Parameters
    ----------
    transform
        Called with each item; what it returns takes the item's place.

    Raises
    ------
    ImportError
        PyTorch is missing; ``pip install astrolith[torch]``.
    """
    required("torch", "torch")
    from astrolith.bridges._torch import TorchBodies

    return TorchBodies(bodies, transform)


def torch_loader(
    bodies: Union[Bodies, FinishedSet],
    transform: Optional[Callable[[dict[str, Any]], Any]] = None,
    *,
    num_workers: int = 0,
    **options: Any,
) -> Any:
    """Make a ``torch.utils.data.DataLoader`` of :func:`torch_dataset`, whose workers start by ``spawn``.

    A worker that is forked lacks the threads of its parent, and is refused.

    Parameters
    ----------
    num_workers, options
        Of the ``DataLoader``.
    """
    torch = required("torch", "torch")
    if num_workers > 0:
        options.setdefault("multiprocessing_context", "spawn")
    return torch.utils.data.DataLoader(torch_dataset(bodies, transform), num_workers=num_workers, **options)
