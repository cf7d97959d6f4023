"""Meshes to classes: a random forest over features of shapes."""

from __future__ import annotations

from typing import Optional, Sequence

from astrolith import _arrays, _estimation, _options
from astrolith._arrays import PathLike
from astrolith._mesh import MeshLike, surface_of
from astrolith._options import Progress

_CLASS_FEATURES = ("ahd", "wahl", "d2", "shapedna")


def train_classifier(
    folders: Sequence[PathLike],
    output: PathLike,
    *,
    features: str = "ahd",
    bins: Optional[int] = None,
    points: int = 5000,
    eigenvalues: int = 20,
    trees: int = 500,
    depth: int = 25,
    components: int = 0,
    seed: int = 1,
    threads: int = 0,
    progress: Progress = None,
) -> None:
    """Learn classes of shapes and write the classifier, as ``classify train --folds 0`` does.

    Parameters
    ----------
    folders
        Folders of meshes, one class each, or folders of such folders.
    output
        The file to write (JSON).
    features
        What the classes are told apart by: "ahd", "wahl", "d2" or "shapedna".
    bins
        Of each axis; default 5, and 64 for "d2".

    Raises
    ------
    ValueError
        A mesh cannot be used, a class has none, or an argument is out of range.
    """
    kind = _arrays.choice(features, "features", _CLASS_FEATURES)
    _estimation.train_classifier(
        [_arrays.file_name(folder, "folders") for folder in _arrays.items(folders, "folders")],
        _arrays.file_name(output, "output"),
        kind,
        (64 if kind == "d2" else 5) if bins is None else _arrays.integer(bins, "bins", 2, 1024),
        _arrays.integer(points, "points", 16, 100000),
        _arrays.integer(eigenvalues, "eigenvalues", 1, 500),
        _arrays.integer(trees, "trees", 1, 10000),
        _arrays.integer(depth, "depth", 1, 60),
        _arrays.integer(components, "components", 0, 100000),
        _options.seed(seed),
        _options.threads(threads),
        progress,
    )


def classify(model: PathLike, mesh: MeshLike, *, threads: int = 0, progress: Progress = None) -> dict[str, float]:
    """Return the share of the votes for each class of a classifier, as ``classify predict`` does.

    Raises
    ------
    ValueError
        The file is no classifier, or the mesh has no area.
    """
    arrays = surface_of(mesh, "mesh")
    classes, votes = _estimation.classify(_arrays.file_name(model, "model"), arrays.vertices, arrays.faces, _options.threads(threads), progress)
    return dict(zip(classes, votes))
