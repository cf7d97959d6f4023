"""Photos to layers of noise."""

from __future__ import annotations

import dataclasses
import os
from typing import Optional, Union

import numpy as np
import numpy.typing as npt

from astrolith import _arrays, _estimation, _options
from astrolith._options import Progress
from astrolith._recipe import PathLike, Recipe, Record, records


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
    file = os.fsdecode(image) if isinstance(image, (str, os.PathLike)) else ""
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
    given = _options.given(
        model=model, max_memory=max_memory, channels=channels, detrend=detrend, detrend_by=detrend_by, lobes=lobes, mm_per_px=mm_per_px, unit=unit,
        height_rms=height_rms, evaluation=evaluation, spectrum_estimate=spectrum_estimate, solver=solver, penalty=penalty,
        gap=gap, seed=seed,
    )  # fmt: skip
    json, figures, power = _estimation.fit_texture(
        file or "image",
        planes,
        kind,
        _options.name_of(output) or "",
        _options.name_of(report) or "",
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
