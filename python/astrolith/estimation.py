"""Fits: shapes to recipes of metaballs and noise, photos to layers of Gabor noise, meshes to classes.

This module's extension links FFTW (GPL-2.0-or-later) and CGAL (GPL-3.0-or-later): whoever passes on a program
together with it does so under the GPL. ``astrolith.synthesis`` alone is free of it.
"""

from __future__ import annotations

import dataclasses
import os
from typing import Any, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from astrolith import _arrays, _estimation, _options
from astrolith._mesh import Mesh, MeshLike, arrays_of, stated_unit, unit_of
from astrolith._options import Progress
from astrolith._packing import Packing, pack_spheres
from astrolith._recipe import PathLike, Recipe, Record, records

__all__ = ["Packing", "ShapeFit", "TextureFit", "classify", "fit_shape", "fit_texture", "pack_spheres", "repair_mesh", "train_classifier"]


@dataclasses.dataclass(eq=False)
class ShapeFit:
    """A fitted shape: its recipe, and the figures of ``fit_shape --summary``.

    Distances in `figures` are fractions of the diagonal of the target's bounding box: mean_distance, p99_distance,
    max_distance. similarity is that of ``compare``; more than similarity_floor cannot be expected.
    """

    recipe: Recipe
    figures: Record

    def __repr__(self) -> str:
        spheres = len(self.recipe.body.spheres) + len(self.recipe.body.get("subtract", []))
        return f"<astrolith.ShapeFit: {spheres} metaballs, mean distance {self.figures.mean_distance:.4g} of the diagonal>"


@dataclasses.dataclass(eq=False)
class TextureFit:
    """A fitted photo: its recipe, and the figures of ``fit_gabor --summary``.

    spectrum_residual is the distance from the photo's spectrum, weak where it is above weak_above; band_overlap is
    the share of the variance in the right octave.

    `spectrum` is there where it was asked for: the power spectrum of the lobes on the grid of the image's DFT, float64
    (height, width), or (layers, height, width) where there are several. It is ``abs(numpy.fft.fft2(image)) ** 2 /
    image.size`` of a texture's expectation, frequency 0 first. Images above 1024 pixels have a grid of at most 1024.
    """

    recipe: Recipe
    figures: Record
    spectrum: Optional[npt.NDArray[np.float64]] = None

    def __repr__(self) -> str:
        return f"<astrolith.TextureFit: {self.figures.model}, layers: {len(self.recipe.layers)}>"


def _given(**arguments: Any) -> list[tuple[str, str]]:
    """The arguments that were given, as a program states its options in the provenance."""
    return sorted(
        (name.replace("_", "-"), "true" if value is True else str(value))
        for name, value in arguments.items()
        if value is not None and value is not False
    )


def _name(file: Optional[PathLike]) -> Optional[str]:
    return None if file is None else os.fspath(file)


def _most_spheres(spheres: Optional[int], size: Optional[int]) -> int:
    """The largest number of metaballs; 0: as many as follow from the size of the recipe."""
    if spheres is not None:
        return _arrays.integer(spheres, "spheres", 1, 10000)
    return 200 if size is None else 0


_KERNELS = ("gaussian", "metaball", "soft_object", "wyvill", "cauchy")
_OPTIMIZERS = ("pso", "crs2", "isres", "esch", "sbplx", "cmaes")


def fit_shape(
    mesh: Union[MeshLike, npt.ArrayLike],
    faces: Optional[npt.ArrayLike] = None,
    *,
    spheres: Optional[int] = None,
    bytes: Optional[int] = None,
    kernel: Optional[str] = None,
    subtract: Optional[float] = None,
    points: Optional[int] = None,
    tolerance: Optional[float] = None,
    optimizer: Optional[str] = None,
    population: Optional[int] = None,
    generations: Optional[int] = None,
    base_only: bool = False,
    details: Optional[PathLike] = None,
    micro: Optional[PathLike] = None,
    mm_per_px: Optional[float] = None,
    micro_height: Optional[float] = None,
    device: Optional[str] = None,
    time_limit: Optional[float] = None,
    unit: Optional[str] = None,
    seed: Optional[int] = None,
    checkpoint: Optional[PathLike] = None,
    report: Optional[PathLike] = None,
    strict: bool = False,
    wrap: bool = False,
    all_parts: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> ShapeFit:
    """Fit metaballs and details to the mesh of a body, as the program ``fit_shape`` does.

    Parameters
    ----------
    mesh
        The name of a file, a mesh, or (n, 3) float vertices; then `faces` are (m, 3) indices. The recipe of a file
        states the file's name and hash, and has the bytes that the program writes.
    spheres
        Largest number of metaballs, 1 to 10000; default 200, or what follows from `bytes`.
    bytes
        Round the numbers of the metaballs so that ``recipe.write("name.astro")`` takes at most so many bytes, 100 to
        1000000, for the least error. The recipe then states no provenance. Needs `base_only`, and takes no `micro`.
    kernel
        "gaussian" (default), "metaball", "soft_object", "wyvill" or "cauchy".
    subtract
        Largest share of the metaballs that may be subtractive, 0 to 0.9; default 0.5, and 0 for other kernels.
    points
        Samples of the surface that the refinement sees; default 120 a metaball.
    tolerance
        No more metaballs once the mean distance is below this fraction of the diagonal.
    optimizer
        "pso" (default), "crs2", "isres", "esch", "sbplx" or "cmaes".
    population, generations
        Of the search for details: default 20 and 100.
    base_only
        Metaballs alone, without details.
    details
        "relief" (default): the measured surface itself, as heights over the metaballs. "thesis" (default with
        `generations`): the search for the 34 parameters of three noises. Or the layers of this recipe's file, scaled by
        the ratio of the two bodies' sizes.
    micro
        The finest detail: the file of a recipe of ``fit_gabor``, whose layers are added; or "auto": instead of the
        search, a Gabor layer learnt from what the metaballs leave of the mesh.
    mm_per_px, micro_height
        Size of a pixel of the photo of `micro`, and root mean square height of its first layer, both in mm.
    device
        What computes the search: "auto" (default; the GPU where there is one), "cpu" or "cuda".
    time_limit
        Seconds after which the best so far is returned, measured figures included; default 0, none. The result then
        depends on the machine.
    unit
        The unit of the vertices, "km" or "m"; default: what a Mesh or a file states, else "km".
    seed
        0 to 2**53 - 1; default 1.
    checkpoint
        Keep the progress in this file; where it exists, go on from there.
    report
        A folder for a page, index.html, with target and fit to turn, and pictures of both.
    strict, wrap, all_parts
        As of the program: refuse a mesh that is not closed; wrap one that a repair cannot close; take all bodies of a
        mesh that holds several. figures.repair and figures.remarks say what was done.
    progress
        Called with the share done of a stage and a few words. Returning False ends the fit with its best so far.

    Returns
    -------
    ShapeFit

    Raises
    ------
    ValueError
        The mesh is flat, or open, not manifold or crossing beyond repair; an argument is out of range; the checkpoint
        belongs to another fit.
    KeyboardInterrupt
        Ctrl-C was pressed. It is raised within a second; the checkpoint is whole then.
    """
    file = os.fspath(mesh) if isinstance(mesh, (str, os.PathLike)) else ""
    arrays = None
    if not file:
        arrays = arrays_of(mesh if faces is None else (mesh, faces), "mesh")
    given = _given(
        spheres=spheres, bytes=bytes, kernel=kernel, subtract=subtract, points=points, tolerance=tolerance, optimizer=optimizer,
        population=population, generations=generations, base_only=base_only, unit=unit, seed=seed,
        details=_name(details), micro=_name(micro), mm_per_px=mm_per_px, micro_height=micro_height, device=device,
        time_limit=time_limit, strict=strict, wrap=wrap, all_parts=all_parts,
    )  # fmt: skip
    if details is not None and base_only:
        raise ValueError("details: base_only leaves them out; leave out one of both")
    if details not in (None, "thesis") and generations is not None:
        raise ValueError("generations: are those of details=\"thesis\"; leave out one of both")
    if bytes is not None and (not base_only or micro is not None):
        raise ValueError("bytes: are those of a bare body; pass base_only=True and leave out micro")
    if micro is None and (mm_per_px is not None or micro_height is not None):
        raise ValueError("micro: is missing; mm_per_px and micro_height are of its layers")
    if kernel not in (None, "gaussian") and subtract:
        raise ValueError("subtract: only Gaussian metaballs may be subtractive; leave it out, or kernel")
    json, figures = _estimation.fit_shape(
        file or "mesh",
        None if arrays is None else arrays.vertices,
        None if arrays is None else arrays.faces,
        _arrays.choice(kernel or "gaussian", "kernel", _KERNELS),
        _most_spheres(spheres, bytes),
        0 if bytes is None else _arrays.integer(bytes, "bytes", 100, 1000000),
        0.5 if subtract is None else _arrays.number(subtract, "subtract", 0.0, 0.9),
        0 if points is None else _arrays.integer(points, "points", 0, 10**7),
        0.0 if tolerance is None else _arrays.number(tolerance, "tolerance", 0.0, 1e18),
        _arrays.choice(optimizer or "pso", "optimizer", _OPTIMIZERS),
        20 if population is None else _arrays.integer(population, "population", 1, 10000),
        100 if generations is None else _arrays.integer(generations, "generations", 1, 100000),
        bool(base_only),
        _name(details) or ("relief" if generations is None else "thesis"),
        _name(micro) or "",
        0.0 if mm_per_px is None else _arrays.number(mm_per_px, "mm_per_px", 1e-12, 1e12),
        0.0 if micro_height is None else _arrays.number(micro_height, "micro_height", 1e-12, 1e12),
        _arrays.choice(device or "auto", "device", ("auto", "cpu", "cuda")),
        0.0 if time_limit is None else _arrays.number(time_limit, "time_limit", 0.0, 1e9),
        unit_of(mesh, unit, ("km", "m")),
        _name(checkpoint) or "",
        _name(report) or "",
        bool(strict),
        bool(wrap),
        bool(all_parts),
        given,
        1 if seed is None else _options.seed(seed),
        _options.threads(threads),
        progress,
    )
    return ShapeFit(Recipe(records(json)), records(figures))


def repair_mesh(
    mesh: Union[MeshLike, npt.ArrayLike],
    faces: Optional[npt.ArrayLike] = None,
    *,
    wrap: bool = False,
    all_parts: bool = False,
    progress: Progress = None,
) -> tuple[Mesh, Record]:
    """Close a mesh that is open, not manifold or wound both ways, as ``gravity`` and ``fit_shape`` do.

    A mesh that is closed, of one body, comes back as it is.

    Parameters
    ----------
    mesh
        The name of a file, a mesh, or (n, 3) float vertices; then `faces` are (m, 3) indices.
    wrap
        Where a repair moves the surface by more than 1 % of the diagonal, fills more than 5 % of it, or fails: wrap the
        mesh at 1/200 of the diagonal.
    all_parts
        Keep all bodies of a mesh that holds several; otherwise the largest.

    Returns
    -------
    The mesh, and the fields repair.* of ``fit_shape --summary`` with a sentence, `words`.

    Raises
    ------
    ValueError
        The mesh cannot be repaired.

    Examples
    --------
    >>> import astrolith
    >>> ball = {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[0, 0, 0, 1]]}
    >>> body = astrolith.mesh({"format_version": 1, "length_unit": "km", "body": ball}, resolution=24)
    >>> closed, figures = astrolith.repair_mesh(body.vertices, body.faces[5:])
    >>> figures.holes >= 1, len(closed.faces) == len(body.faces)
    (True, True)
    """
    arrays = arrays_of(mesh if faces is None else (mesh, faces), "mesh")
    unit = stated_unit(mesh)
    vertices, triangles, figures = _estimation.repair_mesh(
        arrays.name, arrays.vertices, arrays.faces, bool(wrap), bool(all_parts), unit, progress
    )
    return Mesh(vertices, triangles, length_unit=unit), records(figures)


def _planes(image: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """(planes, height, width) float64, full scale 1."""
    array = np.asarray(image)
    if array.ndim == 3 and array.shape[2] == 4:
        raise ValueError("image: has four channels; numpy.ascontiguousarray(image[..., :3]) leaves out alpha")
    if array.ndim not in (2, 3) or array.ndim == 3 and array.shape[2] != 3:
        raise ValueError(f"image: has the shape {array.shape}; it must be (height, width) or (height, width, 3)")
    if not array.flags.c_contiguous:
        raise ValueError("image: is not C-contiguous; pass numpy.ascontiguousarray(image)")
    if array.dtype in (np.uint8, np.uint16):
        array = array / float(np.iinfo(array.dtype).max)
    elif array.dtype not in (np.float32, np.float64):
        raise ValueError(f"image: has the dtype {array.dtype}; it must be uint8, uint16, float32 or float64")
    if array.size == 0:
        raise ValueError("image: is empty; it must have at least 32 x 32 pixels")
    if array.size > 3 * 2**26:
        raise ValueError(f"image: has {array.size} values; it must have at most 2**26 pixels")
    if not (np.abs(array.max()) <= 1e5 and np.abs(array.min()) <= 1e5):
        raise ValueError("image: holds values that are not finite or beyond 1e5")
    planes = array[None] if array.ndim == 2 else np.moveaxis(array, 2, 0)
    return np.ascontiguousarray(planes, dtype=np.float64)


def _luma(planes: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    luma: npt.NDArray[np.float64] = 0.2126 * planes[0] + 0.7152 * planes[1] + 0.0722 * planes[2]
    return np.ascontiguousarray(luma[None])


def fit_texture(
    image: Union[PathLike, npt.ArrayLike],
    *,
    model: Optional[str] = None,
    output: Optional[PathLike] = None,
    channels: Optional[str] = None,
    detrend: Optional[int] = None,
    detrend_by: Optional[str] = None,
    lobes: Optional[int] = None,
    mm_per_px: Optional[float] = None,
    unit: Optional[str] = None,
    height_rms: Optional[float] = None,
    evaluation: Optional[str] = None,
    spectrum_estimate: Optional[str] = None,
    solver: Optional[str] = None,
    penalty: Optional[float] = None,
    gap: Optional[float] = None,
    max_memory: Optional[float] = None,
    spectrum: bool = False,
    report: Optional[PathLike] = None,
    seed: Optional[int] = None,
    threads: int = 0,
    progress: Progress = None,
) -> TextureFit:
    """Fit layers of noise to a photo of rock or to a height map, as the program ``fit_gabor`` does.

    Parameters
    ----------
    image
        The name of a PNG, JPEG or TIFF file, or (height, width) or (height, width, 3) uint8, uint16 (full scale
        becomes 1) or floats, at least 32 x 32. The recipe of a file has the bytes that the program writes.
    model
        "gabor" (default: noise with the photo's spectrum in lobes), "phase" (an image of noise with the whole spectrum),
        "exemplar" (the photo itself, tiled and blended) or "auto" (the simplest of those whose textures are nearest to
        squares of the photo that the model has not seen). figures.model says which one it became, figures.choice the
        scores of all.
    output
        Write the recipe to this file. Models other than "gabor" need it, since their layer names an image,
        which becomes RECIPE_exemplar.png beside it.
    channels
        "luminance" (default; one layer) or "pca" (a layer for each principal axis of the colours; an exemplar keeps
        the colours of its image).
    detrend, detrend_by
        Degree of a polynomial that is taken out first (0 to 6; default 0), by "subtraction" (default) or "division".
    lobes
        At most this many lobes in a layer, 1 to 1000; default 80.
    mm_per_px, unit
        Size of a pixel on the ground in millimetres, and the recipe's unit then: "m" (default) or "km".
    height_rms
        Standard deviation of the height in the recipe's unit; default: the image's own contrast.
    evaluation
        How a Gabor layer's lobes become heights on a surface: "impulses" (default; exact) or "tiles" (wide lobes as
        random-phase tiles, many times faster). ``figures.channels[].tiles_distance`` says what tiles cost.
    spectrum_estimate
        "smoothed" (default) or "periodogram".
    solver
        "working-set" (default) or "fista".
    penalty, gap
        Sparsity penalty over the largest useful one (default 0.03), and the certified gap (default 1e-4).
    max_memory
        Refuse fits that are predicted to need more gigabytes; default: three quarters of the machine's.
    spectrum
        Whether the result shall have the power spectrum that ``fit_gabor --spectrum`` writes.
    report
        A folder for a page, index.html, and pictures of photo and texture and of their spectra.

    Returns
    -------
    TextureFit

    Raises
    ------
    ValueError
        The image is wrong, too small or constant, or an argument is out of range.
    """
    colors = _arrays.choice(channels or "luminance", "channels", ("luminance", "pca")) == "pca"
    file = os.fspath(image) if isinstance(image, (str, os.PathLike)) else ""
    planes = None
    if not isinstance(image, (str, os.PathLike)):
        planes = _planes(image)
        if colors and len(planes) == 1:
            raise ValueError("channels: a grey image has no colours; leave it out")
        if not colors and len(planes) == 3:
            planes = _luma(planes)
    kind = _arrays.choice(model or "gabor", "model", ("gabor", "phase", "exemplar", "auto"))
    about_lobes = {"lobes": lobes, "penalty": penalty, "gap": gap, "solver": solver, "evaluation": evaluation, "spectrum_estimate": spectrum_estimate}  # fmt: skip
    for name, value in about_lobes.items():
        if kind in ("phase", "exemplar") and value is not None:
            raise ValueError(f'{name}: is about lobes, which model "{kind}" has none of; leave it out')
    if kind != "gabor" and output is None:
        raise ValueError("output: is missing; a layer with an image names a file beside its recipe")
    if max_memory is None:
        most_bytes = 0.75 * os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    else:
        most_bytes = 1e9 * _arrays.number(max_memory, "max_memory", 1e-9, 1e9)
    given = _given(
        model=model, max_memory=max_memory, channels=channels, detrend=detrend, detrend_by=detrend_by, lobes=lobes, mm_per_px=mm_per_px, unit=unit,
        height_rms=height_rms, evaluation=evaluation, spectrum_estimate=spectrum_estimate, solver=solver, penalty=penalty,
        gap=gap, seed=seed,
    )  # fmt: skip
    json, figures, power = _estimation.fit_texture(
        file or "image",
        planes,
        kind,
        _name(output) or "",
        _name(report) or "",
        most_bytes,
        bool(spectrum),
        colors,
        0 if detrend is None else _arrays.integer(detrend, "detrend", 0, 6),
        _arrays.choice(detrend_by or "subtraction", "detrend_by", ("subtraction", "division")) == "division",
        80 if lobes is None else _arrays.integer(lobes, "lobes", 1, 1000),
        0.0 if mm_per_px is None else _arrays.number(mm_per_px, "mm_per_px", 1e-12, 1e12),
        _arrays.choice(unit or "m", "unit", ("m", "km")),
        -1.0 if height_rms is None else _arrays.number(height_rms, "height_rms", 0.0, 1e12),
        _arrays.choice(evaluation or "impulses", "evaluation", ("impulses", "tiles")) == "tiles",
        _arrays.choice(spectrum_estimate or "smoothed", "spectrum_estimate", ("smoothed", "periodogram")) != "smoothed",
        _arrays.choice(solver or "working-set", "solver", ("working-set", "fista")) == "fista",
        0.03 if penalty is None else _arrays.number(penalty, "penalty", 1e-4, 0.99),
        1e-4 if gap is None else _arrays.number(gap, "gap", 1e-8, 0.5),
        given,
        1 if seed is None else _options.seed(seed),
        _options.threads(threads),
        progress,
    )
    if not json and output is not None:
        return TextureFit(Recipe.read(output), records(figures), power)
    return TextureFit(Recipe(records(json)), records(figures), power)


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
        [os.fspath(folder) for folder in folders],
        os.fspath(output),
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
    arrays = arrays_of(mesh, "mesh")
    classes, votes = _estimation.classify(os.fspath(model), arrays.vertices, arrays.faces, _options.threads(threads), progress)
    return dict(zip(classes, votes))
