"""Packages that are loaded when they are needed."""

from __future__ import annotations

import importlib
from typing import Any


def required(module: str, extra: str) -> Any:
    """The module; an ImportError that names the extra to install where it is missing."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        raise ImportError(f"{error.name}: is not installed; pip install astrolith[{extra}]") from None
