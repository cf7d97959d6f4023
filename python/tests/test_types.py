"""The package's annotations and stubs, and the examples of its docstrings."""

import doctest
import os
import pathlib
import re
import subprocess
import sys

import astrolith
import pytest
from astrolith import _gravity, _mesh, _packing, _recipe, _scene
from astrolith.bridges import datasets

ROOT = pathlib.Path(__file__).resolve().parents[2]


def mypy(folder, *what):
    """Runs mypy, strictly, on the package or on files that use it."""
    pytest.importorskip("mypy")
    package = pathlib.Path(astrolith.__file__).parent
    environment = dict(os.environ)
    if package.parent.name != "site-packages":  # mypy finds installed packages by itself
        environment["MYPYPATH"] = str(package.parent)
    options = ["--strict", "--cache-dir", str(folder), "--config-file="]
    run = subprocess.run([sys.executable, "-m", "mypy", *options, *what],
                         cwd=folder, env=environment, capture_output=True, text=True)  # fmt: skip
    assert run.returncode == 0, run.stdout + run.stderr


def test_mypy_finds_nothing(tmp_path):
    mypy(tmp_path, "-p", "astrolith")


def test_mypy_finds_nothing_in_the_examples_of_the_page(tmp_path):
    others = "import open3d  # type: ignore\nimport torch  # type: ignore\nimport tqdm  # type: ignore\n"
    pages = "\n".join((ROOT / "docs" / page).read_text() for page in ("python.md", "python_packages.md"))
    code = re.findall(r"```python\n(.*?)```", pages, re.DOTALL)
    (tmp_path / "page.py").write_text(others + "\n".join(code))
    mypy(tmp_path, "--no-warn-unused-ignores", "page.py")


@pytest.mark.parametrize("module", [astrolith, _recipe, _gravity, _mesh, _packing, _scene, datasets])
def test_examples_of_docstrings(module):
    assert doctest.testmod(module, optionflags=doctest.ELLIPSIS).failed == 0


def test_modules_are_loaded_when_they_are_named():
    code = "import astrolith, sys; print('astrolith.bridges' in sys.modules, astrolith.bridges.Bodies.__name__, "\
        "astrolith.estimation.ShapeFit.__name__)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout == "False Bodies ShapeFit\n"


def test_import_is_quick_and_loads_nothing_of_the_fits():
    code = "import astrolith, sys; print([m for m in sys.modules if 'estimation' in m])"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout == "[]\n"
