"""The textures of a recipe."""

from __future__ import annotations

import dataclasses
from typing import Optional

import numpy as np
import numpy.typing as npt

from astrolith import _arrays, _options, _synthesis
from astrolith._options import Progress
from astrolith._recipe import RecipeLike, records


@dataclasses.dataclass(eq=False)
class Texture:
    """A texture of :func:`texture`.

    Attributes
    ----------
    values
        (height, width) float32 heights, or (height, width, 3) float32 colours, full scale 1, not clamped.
    content
        "height" or "color".
    height_unit
        The unit of heights: the recipe's, or "standard deviations" where the layer states no height.
    height_rms
        The standard deviation of the heights.
    """

    values: npt.NDArray[np.float32]
    content: str
    height_unit: str = ""
    height_rms: float = 0.0

    def __repr__(self) -> str:
        scale = f", rms {self.height_rms:.4g} {self.height_unit}" if self.content == "height" else ""
        return f"<astrolith.Texture: {self.content} {self.values.shape}{scale}>"


def texture(
    recipe: RecipeLike,
    width: int,
    height: int,
    *,
    content: Optional[str] = None,
    tileable: bool = False,
    seed: Optional[int] = None,
    threads: int = 0,
    progress: Progress = None,
) -> Texture:
    """Draw the Gabor or exemplar layers of a recipe on a plane, as ``synth --texture`` does into a .tif.

    Parameters
    ----------
    width, height
        Pixels, 1 to 16384.
    content
        "height": the heights of the first Gabor or exemplar layer; "color": the colours of the first layer that has
        some, with those of all other Gabor layers if it is one. None: colours where layers have them.
    tileable
        Whether the texture repeats in both directions without a seam.

    Raises
    ------
    ValueError
        The recipe has no such layer, or the texture is too small to repeat.
    """
    json, name = _options.seeded(recipe, seed)
    word = "" if content is None else _arrays.choice(content, "content", ("height", "color"))
    values, rms, has_height = _synthesis.texture(
        json,
        name,
        _arrays.integer(width, "width", 1, 16384),
        _arrays.integer(height, "height", 1, 16384),
        word,
        _arrays.flag(tileable, "tileable"),
        _options.threads(threads),
        progress,
    )
    if values.ndim == 3:
        return Texture(values, "color")
    unit = records(json).get("length_unit", "km") if has_height else "standard deviations"
    return Texture(values, "height", unit, rms)
