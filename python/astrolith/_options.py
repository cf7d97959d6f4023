"""What many functions take: a seed, a number of threads, a progress callback, names of files."""

from __future__ import annotations

import os
from typing import Any, Callable, Optional

from astrolith import _arrays
from astrolith._recipe import PathLike, RecipeLike, json_of, records

Progress = Optional[Callable[[float, str], Any]]
"""Called from the calling thread with the share done in [0, 1] and a few words. Returning False stops the work."""

_LARGEST_SEED = 2**53 - 1


def seed(value: Any) -> int:
    """The seed of everything random."""
    return _arrays.integer(value, "seed", 0, _LARGEST_SEED)


def threads(value: Any) -> int:
    """How many threads to use; 0: all."""
    return _arrays.integer(value, "threads", 0, 1024)


def seeded(recipe: RecipeLike, number: Optional[int]) -> tuple[str, str]:
    """The recipe's text, with another seed where one is given, and its name in messages."""
    json, name = json_of(recipe)
    if number is None:
        return json, name
    fields = records(json)
    fields["seed"] = seed(number)
    return json_of(fields)[0], name


def given(**arguments: Any) -> list[tuple[str, str]]:
    """The arguments that were given, as a program states its options in the provenance."""
    return sorted(
        (name.replace("_", "-"), "true" if value is True else str(value))
        for name, value in arguments.items()
        if value is not None and value is not False
    )


def name_of(file: Optional[PathLike]) -> Optional[str]:
    """The name of a file; None where there is none."""
    return None if file is None else os.fsdecode(file)
