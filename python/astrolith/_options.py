"""What many functions take: a seed, a number of threads, a progress callback."""

from __future__ import annotations

from typing import Any, Callable, Optional

from astrolith import _arrays
from astrolith._recipe import RecipeLike, json_of, records

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
