"""Checks of what users pass in: a wrong argument is an error of one line that names it.

A wrong value is a ValueError. A text or the name of a file that is none is a TypeError.
"""

from __future__ import annotations

import errno
import operator
import os
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

PathLike = Union[str, bytes, "os.PathLike[str]", "os.PathLike[bytes]"]

# The largest coordinate, as mesh files and recipes have it.
_LARGEST = 1e18


class MissingFileError(ValueError, FileNotFoundError):
    """A file that is to be read does not exist."""

    def __init__(self, message: str) -> None:
        super().__init__(message)
        self.errno = errno.ENOENT


def is_file_name(value: Any) -> bool:
    """Whether the argument names a file: a text, bytes or a path."""
    return isinstance(value, (str, bytes, os.PathLike))


def file_name(value: Any, name: str) -> str:
    """The name of a file, whose bytes that are no UTF-8 are surrogates, as Python has them."""
    if not is_file_name(value):
        raise TypeError(f"{name}: must be the name of a file, and is {type(value).__name__}")
    file = os.fsdecode(value)
    if not file:
        raise ValueError(f"{name}: is empty; give the name of a file")
    try:
        encoded = os.fsencode(file)
    except UnicodeEncodeError:
        encoded = b"\0"
    if b"\0" in encoded:
        raise ValueError(f"{name}: {file!r} holds a character that no file's name has")
    return file


def shown(value: Any) -> str:
    """The value in a message: on one line, and not longer than a line."""
    words = " ".join(repr(value).split())
    return words if len(words) <= 100 else words[:97] + "..."


def text(value: Any, name: str) -> str:
    """A text."""
    if not isinstance(value, str):
        raise TypeError(f"{name}: must be a text, and is {type(value).__name__}")
    try:
        value.encode()
    except UnicodeEncodeError:
        raise ValueError(f"{name}: holds half of a surrogate pair, which is no character") from None
    return value


def _array(value: Any, name: str) -> npt.NDArray[Any]:
    if isinstance(value, np.ndarray):
        array = value
    else:
        try:
            array = np.asarray(value)
        except (TypeError, ValueError) as error:
            raise ValueError(f"{name}: is no array of numbers ({type(value).__name__}); pass a NumPy array") from error
    return array.astype(array.dtype.newbyteorder("="), order="C", copy=False)


def _require_rows(array: npt.NDArray[Any], name: str, columns: int, empty: bool) -> None:
    if array.ndim != 2 or array.shape[1] != columns:
        raise ValueError(f"{name}: has the shape {array.shape}; it must be (n, {columns})")
    if not empty and len(array) == 0:
        raise ValueError(f"{name}: is empty; it must have at least one row")


def rows(value: Any, name: str, *, length: Optional[int] = None, empty: bool = False) -> npt.NDArray[np.float64]:
    """(n, 3) finite numbers as float64. float64 passes without a copy."""
    array = _array(value, name)
    if isinstance(value, (list, tuple)) and array.dtype.kind in "iu":
        array = array.astype(np.float64)
    if array.dtype.kind != "f" or array.dtype.itemsize not in (4, 8):
        raise ValueError(f"{name}: has the dtype {array.dtype}; it must be float64 or float32")
    _require_rows(array, name, 3, empty)
    if length is not None and len(array) != length:
        raise ValueError(f"{name}: has {len(array)} rows; it must have {length}, one for each vertex")
    # One pass without a temporary: the extremes are not finite where any number is not.
    if array.size and not (np.abs(array.max()) <= _LARGEST and np.abs(array.min()) <= _LARGEST):
        bad = int(np.argmax(~(np.abs(array) <= _LARGEST).all(axis=1)))
        raise ValueError(f"{name}: row {bad} is {array[bad].tolist()}; numbers must be finite and at most 1e18")
    return array.astype(np.float64, copy=False)


def faces_of(value: Any, name: str, vertices: int, *, empty: bool = False) -> npt.NDArray[np.uint32]:
    """(m, 3) indices of vertices as uint32. uint32 passes without a copy."""
    array = _array(value, name)
    if empty and array.size == 0:
        return np.zeros((0, 3), np.uint32)
    if array.dtype.kind not in "iu":
        raise ValueError(f"{name}: has the dtype {array.dtype}; it must be an integer type, such as uint32")
    _require_rows(array, name, 3, empty)
    least, most = int(array.min()), int(array.max())
    if least < 0:
        raise ValueError(f"{name}: has the negative index {least}; indices must be 0 to {vertices - 1}")
    if most >= vertices:
        raise ValueError(f"{name}: has the index {most}; with {vertices} vertices it must be 0 to {vertices - 1}")
    return array.astype(np.uint32, copy=False)


def column(value: Any, name: str, dtype: Any, length: int) -> npt.NDArray[Any]:
    """(n) numbers of this type, one for each vertex."""
    array = _array(value, name)
    if array.shape != (length,):
        raise ValueError(f"{name}: has the shape {array.shape}; it must be ({length},), one for each vertex")
    if array.dtype != np.dtype(dtype):
        raise ValueError(f"{name}: has the dtype {array.dtype}; it must be {np.dtype(dtype)}")
    return array


def colors(value: Any, name: str, length: int) -> npt.NDArray[np.uint8]:
    """(n, 3) uint8, one colour for each vertex."""
    array = _array(value, name)
    if array.shape != (length, 3) or array.dtype != np.uint8:
        raise ValueError(f"{name}: has the shape {array.shape} of {array.dtype}; it must be ({length}, 3) of uint8")
    return array


def vector(value: Any, name: str, length: int = 3) -> tuple[float, ...]:
    """`length` finite numbers."""
    try:
        numbers = tuple(float(x) for x in value)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name}: must be {length} numbers, and is {shown(value)}") from error
    if len(numbers) != length or not all(np.isfinite(numbers)):
        raise ValueError(f"{name}: must be {length} finite numbers, and is {shown(value)}")
    return numbers


def integer(value: Any, name: str, least: int, most: int) -> int:
    """A whole number in [least, most]."""
    try:
        number = operator.index(value)
    except TypeError:
        raise ValueError(f"{name}: must be a whole number from {least} to {most}, and is {shown(value)}") from None
    if not least <= number <= most:
        raise ValueError(f"{name}: must be from {least} to {most}, and is {number}")
    return number


def number(value: Any, name: str, least: float, most: float) -> float:
    """A number in [least, most]."""
    try:
        result = float(value)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: must be a number from {least:g} to {most:g}, and is {shown(value)}") from None
    if not least <= result <= most:
        raise ValueError(f"{name}: must be from {least:g} to {most:g}, and is {result:g}")
    return result


def positive(value: Any, name: str, most: float) -> float:
    """A number in (0, most]."""
    result = number(value, name, 0.0, most)
    if result == 0.0:
        raise ValueError(f"{name}: must be above 0, and is {result:g}")
    return result


def flag(value: Any, name: str) -> bool:
    """Whether the value is true."""
    try:
        return bool(value)
    except ValueError:
        raise ValueError(f"{name}: must be True or False, and is {shown(value)}") from None


def items(value: Any, name: str) -> list[Any]:
    """The members of a list, or of what can be made one."""
    try:
        return list(value)
    except TypeError:
        raise TypeError(f"{name}: must be a list, and is {type(value).__name__}") from None


def choice(value: Any, name: str, words: tuple[str, ...]) -> str:
    """One of the words."""
    if not isinstance(value, str) or value not in words:
        raise ValueError(f"{name}: must be one of {', '.join(words)}, and is {shown(value)}")
    return str(value)
