"""Photos to layers of noise."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Optional, Union, cast

import numpy as np
import numpy.typing as npt

from astrolith import _arrays, _estimation, _jobs, _options
from astrolith._options import Progress
from astrolith._arrays import PathLike
from astrolith._recipe import Recipe, Record, records

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from astrolith._fit_options import FitTextureOptions

_OPTIONS = _estimation.options_of("fit_gabor")


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
    """(planes, height, width) float64, full scale 1. A pixel that is masked is NaN."""
    masked = np.ma.isMaskedArray(image) and np.ma.getmaskarray(image)
    array = np.asarray(image)
    if array.ndim == 3 and array.shape[2] == 4:
        raise ValueError("image: has four channels; numpy.ascontiguousarray(image[..., :3]) leaves out alpha")
    if array.ndim not in (2, 3) or array.ndim == 3 and array.shape[2] != 3:
        raise ValueError(f"image: has the shape {array.shape}; it must be (height, width) or (height, width, 3)")
    if not array.flags.c_contiguous:
        raise ValueError("image: is not C-contiguous; pass numpy.ascontiguousarray(image)")
    if array.dtype in (np.uint8, np.uint16):
        array = array / float(np.iinfo(array.dtype).max)
    elif array.dtype.kind == "i":
        array = array.astype(np.float64)  # heights, as in a file
    elif array.dtype not in (np.float32, np.float64):
        raise ValueError(f"image: has the dtype {array.dtype}; it must be uint8, uint16, signed integers, float32 or float64")
    if masked is not False:
        array = np.where(masked, np.nan, array)
    if array.size == 0:
        raise ValueError("image: is empty; it must have at least 32 x 32 pixels")
    if array.size > 3 * 2**26:
        raise ValueError(f"image: has {array.size} values; it must have at most 2**26 pixels")
    if np.isnan(array).all() or not (np.abs(np.nanmax(array)) <= 1e5 and np.abs(np.nanmin(array)) <= 1e5):
        raise ValueError("image: holds values that are infinite or beyond 1e5, or none at all")
    planes = array[None] if array.ndim == 2 else np.moveaxis(array, 2, 0)
    return np.ascontiguousarray(planes, dtype=np.float64)


def _luma(planes: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    luma: npt.NDArray[np.float64] = 0.2126 * planes[0] + 0.7152 * planes[1] + 0.0722 * planes[2]
    return np.ascontiguousarray(luma[None])


def fit_texture(
    image: Union[PathLike, npt.ArrayLike],
    *,
    spectrum: Union[bool, PathLike] = False,
    threads: int = 0,
    progress: Progress = None,
    **options: Unpack[FitTextureOptions],
) -> TextureFit:
    """Fit layers of noise to a photo of rock or to a height map, as the program ``fit_gabor`` does.

    Parameters
    ----------
    image
        The name of a file that the program reads, or (height, width) or (height, width, 3) uint8, uint16 (full scale
        becomes 1), signed integers or floats, at least 32 x 32. Pixels that are NaN or masked are missing. The recipe of a
        file has the bytes that the program writes.
    spectrum
        Whether the result shall have the power spectrum that ``fit_gabor --spectrum`` writes; or its file.
    threads
        To use; 0: all.
    progress
        Called with the share done of a stage and a few words. Returning False ends the fit with its best so far.
    {options}

    Returns
    -------
    TextureFit

    Raises
    ------
    ValueError
        The image is wrong, too small or constant, or an argument is out of range.
    """
    arguments = _jobs.words("fit_texture", _OPTIONS, options)
    planes = None
    if _arrays.is_file_name(image):
        arguments.append(("image", [_arrays.file_name(image, "image")]))
    else:
        planes = _planes(cast(npt.ArrayLike, image))
        if options.get("channels") == "pca":
            if len(planes) == 1:
                raise ValueError("channels: a grey image has no colours; leave it out")
        elif len(planes) == 3:
            planes = _luma(planes)
    if not isinstance(spectrum, bool):
        arguments.append(("spectrum", [_arrays.file_name(spectrum, "spectrum")]))
    json, figures, power = _estimation.fit_gabor(planes, spectrum is not False, arguments, _options.threads(threads), progress)
    recipe = Recipe(records(json)) if json else Recipe.read(options["output"])  # type: ignore[arg-type]
    return TextureFit(recipe, _jobs.figures_of(figures), power)


_jobs.document(fit_texture, [row for row in _OPTIONS if row[0] != "spectrum"])
