"""The programs of the package, as commands: ``synth ...``, ``gravity ...`` and so on, and ``astrolith NAME ...``.

A program is a function of an extension module of :mod:`astrolith`. This file lies beside that package, so that a
program starts without NumPy and the package's Python files.
"""

from __future__ import annotations

import importlib.util
import os
import sys
from importlib.machinery import PathFinder
from types import ModuleType
from typing import NoReturn

_FITS = ("fit_shape", "fit_gabor", "fit_population", "classify")


def _refuse(line: str) -> NoReturn:
    print(line, file=sys.stderr)
    sys.exit(2)


def _folder() -> str:
    package = importlib.util.find_spec("astrolith")
    if package is None or not package.submodule_search_locations:
        _refuse("astrolith: the package astrolith is not installed; run pip install astrolith")
    return next(iter(package.submodule_search_locations))


def _modules(folder: str) -> list[ModuleType]:
    """The modules that are installed: that of the fits first, whose programs also repair meshes."""
    modules = []
    for name in ("_estimation", "_synthesis"):
        spec = PathFinder.find_spec(name, [folder])
        if spec is not None and spec.loader is not None:
            module = importlib.util.module_from_spec(spec)
            spec.loader.exec_module(module)
            modules.append(module)
    return modules


def _run(words: list[str]) -> NoReturn:
    folder = _folder()
    os.environ.setdefault("ASTROLITH_PAGE", os.path.join(folder, "share", "astrolith", "page.html"))
    names: list[str] = []
    for module in _modules(folder):
        if words and words[0] in module.programs():
            sys.exit(module.run_program(words))
        names += module.programs()
    if words and words[0] in _FITS:
        _refuse(f"{words[0]}: belongs to the fits, which are not installed; run pip install 'astrolith[fit]'")
    usage = f"astrolith PROGRAM ... runs one of the programs {', '.join(sorted(set(names)))}"
    if words in (["--help"], ["-h"]):
        print(usage)
        sys.exit(0)
    _refuse(usage)


def run() -> NoReturn:
    """Run the program by whose name this command was called."""
    _run([os.path.basename(sys.argv[0]), *sys.argv[1:]])


def main() -> NoReturn:
    """Run the program that the first argument names: ``astrolith synth eros -o eros.ply``."""
    _run(sys.argv[1:])
