"""Calls of the jobs that programs do, too: keyword arguments become the words of a program's options."""

from __future__ import annotations

import difflib
import keyword
import re
from collections.abc import Iterable, Mapping
from typing import Any, Optional, Union

import numpy.typing as npt

from astrolith import _arrays
from astrolith._mesh import MeshLike, _warn, arrays_of, unit_of
from astrolith._recipe import Record, records

GivenOptions = list[tuple[str, list[str]]]
Descriptions = list[tuple[str, str, str, str]]


def words(job: str, options: Descriptions, given: Mapping[str, Any]) -> GivenOptions:
    """The options of a job as a command line has them. None and False stand for options that are not given."""
    names = [_python_name(name) for name, *_ in options]
    result = []
    for name, value in given.items():
        if name not in names:
            near = difflib.get_close_matches(name, names, 1)
            hint = f"; did you mean {near[0]}?" if near else ""
            raise TypeError(f"{job}() got an unexpected keyword argument '{name}'{hint}")
        if value is not None and value is not False:
            result.append((name.rstrip("_").replace("_", "-"), _texts(value, name)))
    return result


def _texts(value: Any, name: str) -> list[str]:
    if value is True:
        return ["true"]
    if _arrays.is_file_name(value):
        return [_arrays.file_name(value, name) if value else ""]
    if isinstance(value, Mapping):
        raise TypeError(f"{name}: must be a number, a text or a sequence of them, and is {_arrays.shown(value)}")
    if isinstance(value, Iterable):
        return [text for item in value for text in _texts(item, name)]
    if hasattr(value, "__index__"):
        return [str(value.__index__())]
    try:
        return [repr(float(value))]
    except (TypeError, ValueError):
        raise TypeError(f"{name}: must be a number or a text, and is {_arrays.shown(value)}") from None


def given_mesh(mesh: Union[MeshLike, npt.ArrayLike], faces: Optional[npt.ArrayLike], unit: Optional[str]) -> Optional[tuple[Any, Any, str]]:
    """The arrays of a mesh in memory with its unit; None for the name of a file."""
    if _arrays.is_file_name(mesh):
        return None
    arrays = arrays_of(mesh if faces is None else (mesh, faces), "mesh")
    return arrays.vertices, arrays.faces, unit_of(mesh, unit, ("km", "m"), "mesh")


def figures_of(text: str) -> Record:
    """The figures of a job. Its notes, which ask whether an argument is right, become warnings."""
    figures: Record = records(text)
    for line in figures["remarks"]:
        if line.startswith("note: "):
            _warn(line[6:])
    return figures


def document(function: Any, options: Descriptions) -> None:
    """Puts the job's options in place of the line ``{options}`` of a docstring."""
    text = "\n    ".join(f"{_python_name(name)} : {kind}\n        {_in_python(meaning)}{_value(value)}" for name, kind, meaning, value in options)
    function.__doc__ = (function.__doc__ or "").replace("{options}", text)


def _value(value: str) -> str:
    default = re.search(r"\(default .*\)", value)
    return "" if default is None else " " + default.group()


def _python_name(name: str) -> str:
    """A word of the language, such as class, gets an underscore: class_."""
    return name.replace("-", "_") + "_" * keyword.iskeyword(name)


def _in_python(meaning: str) -> str:
    return re.sub(r"--([a-z][a-z0-9-]*)", lambda found: _python_name(found.group(1)), meaning)

