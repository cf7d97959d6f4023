"""What a detector makes of light: point spread, exposure, noise and bits."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from astrolith import _arrays

_FARTHEST = 4.0  # of the point spread, standard deviations


def _spread(image: npt.NDArray[np.float64], deviation: float) -> npt.NDArray[np.float64]:
    """The image under a Gaussian point spread, which the borders mirror."""
    reach = int(np.ceil(_FARTHEST * deviation))
    if reach == 0:
        return image
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / deviation) ** 2)
    weights /= weights.sum()
    for axis in (0, 1):
        padded = np.pad(image, [(reach, reach) if k == axis else (0, 0) for k in (0, 1)], "symmetric")
        length = image.shape[axis]
        image = sum(w * np.take(padded, np.arange(k, k + length), axis) for k, w in enumerate(weights))
    return image


def expose(
    radiance: npt.ArrayLike,
    *,
    white: float = 1.0,
    spread: float = 0.0,
    full_well: float = 30000.0,
    shot_noise: bool = False,
    read_noise: float = 0.0,
    bits: int = 12,
    seed: int = 1,
) -> npt.NDArray[np.uint16]:
    """Expose a detector to a picture of :meth:`Scene.image`.

    The light spreads, fills the wells with electrons, and is read out and counted in bits. Without noise it is a pure
    function of the picture; with noise also of the seed. Dark current, smear and dead pixels are left to the user.

    Parameters
    ----------
    radiance
        (h, w) I/F.
    white
        The I/F that fills a well: exposure by another name.
    spread
        Standard deviation of the Gaussian point spread, pixels, 0 to 100.
    full_well
        Electrons that a pixel holds; more is lost.
    shot_noise
        Whether electrons arrive at random, by Poisson's law.
    read_noise
        Standard deviation of what reading adds, electrons.
    bits
        Of the result, 1 to 16.
    seed
        Decides the noise.

    Returns
    -------
    ndarray
        (h, w) uint16, 0 to 2^bits - 1.

    Raises
    ------
    ValueError
        An argument is wrong.
    """
    try:
        image = np.asarray(radiance).astype(np.float64, casting="same_kind")
    except (TypeError, ValueError):
        raise ValueError("radiance: must be (h, w) numbers from 0 up; give the radiance of a picture") from None
    if image.ndim != 2 or image.size == 0 or not np.isfinite(image).all() or (image < 0).any():
        raise ValueError("radiance: must be (h, w) numbers from 0 up; give the radiance of a picture")
    white = _arrays.number(white, "white", 1e-9, 1e9)
    spread = _arrays.number(spread, "spread", 0.0, 100.0)
    full_well = _arrays.number(full_well, "full_well", 1.0, 1e9)
    read_noise = _arrays.number(read_noise, "read_noise", 0.0, 1e9)
    largest = 2 ** _arrays.integer(bits, "bits", 1, 16) - 1
    random = np.random.default_rng(_arrays.integer(seed, "seed", 0, 2**63 - 1))
    electrons = np.minimum(_spread(image, spread) / white, 1.0) * full_well
    if _arrays.flag(shot_noise, "shot_noise"):
        electrons = np.minimum(random.poisson(electrons), full_well).astype(np.float64)
    if read_noise > 0.0:
        electrons = electrons + random.normal(0.0, read_noise, image.shape)
    counts: npt.NDArray[np.uint16] = np.clip(np.floor(electrons / full_well * largest + 0.5), 0, largest).astype(np.uint16)
    return counts
