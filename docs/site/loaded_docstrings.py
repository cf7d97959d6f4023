"""For mkdocstrings: the docstrings of functions as they are once the package is loaded, with the options of jobs in them."""

import importlib
import inspect

import griffe


class LoadedDocstrings(griffe.Extension):
    """Replaces the text of a docstring by what the loaded function says."""

    def on_function(self, *, func, **_):
        """Called for each function that has been read."""
        if func.docstring and "{options}" in func.docstring.value:
            loaded = getattr(importlib.import_module(func.module.path), func.name)
            func.docstring.value = inspect.getdoc(loaded)
