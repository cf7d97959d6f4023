"""Units of length by their names."""

from __future__ import annotations

from typing import Any

METRES = {"m": 1.0, "km": 1000.0, "cm": 0.01, "mm": 0.001}
"""The metres of each unit whose length is known."""

_LONG_NAMES = {"meters": "m", "kilometers": "km", "centimeters": "cm", "millimeters": "mm"}


def name_of(units: Any) -> str:
    """The unit that trimesh names: "m" for "meters", any other word as it is, "" for no word."""
    return _LONG_NAMES.get(units, units) if isinstance(units, str) else ""
