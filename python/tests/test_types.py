"""The package's annotations and stubs, and the examples of its docstrings."""

import doctest
import os
import pathlib
import subprocess
import sys

import astrolith
import pytest
from astrolith import _gravity, _recipe
from astrolith.bridges import datasets


def test_mypy_finds_nothing(tmp_path):
    pytest.importorskip("mypy")
    package = pathlib.Path(astrolith.__file__).parent
    environment = dict(os.environ)
    if package.parent.name != "site-packages":  # mypy finds installed packages by itself
        environment["MYPYPATH"] = str(package.parent)
    options = ["--strict", "--cache-dir", str(tmp_path), "--config-file="]
    run = subprocess.run([sys.executable, "-m", "mypy", *options, "-p", "astrolith"],
                         cwd=tmp_path, env=environment, capture_output=True, text=True)  # fmt: skip
    assert run.returncode == 0, run.stdout + run.stderr


@pytest.mark.parametrize("module", [astrolith, _recipe, _gravity, datasets])
def test_examples_of_docstrings(module):
    assert doctest.testmod(module, optionflags=doctest.ELLIPSIS).failed == 0


def test_import_is_quick_and_loads_nothing_of_the_fits():
    code = "import astrolith, sys; print([m for m in sys.modules if 'estimation' in m])"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout == "[]\n"
