"""The examples of docs/python.md and docs/python_packages.md, run one after another in one folder."""

import itertools
import pathlib
import re

import astrolith
import numpy as np
import pytest

DOCS = pathlib.Path(__file__).resolve().parents[2] / "docs"
PAGES = [DOCS / "python.md", DOCS / "python_packages.md"]


def blocks():
    """The Python blocks of both pages, but for those of packages that are not installed with the tests."""
    text = "\n".join(page.read_text() for page in PAGES)
    return [code for mark, code in re.findall(r"(<!-- not run.*?-->\n)?```python\n(.*?)```", text, re.DOTALL) if not mark]


def test_examples_of_the_page(tmp_path, monkeypatch, capsys, example):
    for package in ("trimesh", "xarray", "spiceypy"):
        pytest.importorskip(package)
    rasterio = pytest.importorskip("rasterio")
    monkeypatch.chdir(tmp_path)
    shape = astrolith.mesh(example("itokawa_metaballs"), resolution=32)
    astrolith.write_mesh(astrolith.Mesh(shape.vertices * np.float32(1e-3), shape.faces), "itokawa.ply")
    rows, columns = np.indices((64, 64))
    grey = 128 + 40 * np.sin(0.7 * columns + 0.2 * rows) + 30 * np.cos(0.5 * rows) + (rows * 7 + columns * 3) % 23
    with rasterio.open("gravel.png", "w", driver="PNG", width=64, height=64, count=1, dtype="uint8") as file:
        file.write(grey.astype(np.uint8), 1)
    names = {"tqdm": pytest.importorskip("tqdm")}
    for code in blocks():
        # Smaller than on the page.
        for large, small in (("triangles=1e6", "triangles=2e4"), ('unit="km")', 'unit="km", spheres=8, points=1000, base_only=True)'),
                             ("resolution=1024", "resolution=48"), ("views=[(1, 0, 0)])", "views=[(1, 0, 0)], width=64, height=48)")):  # fmt: skip
            code = code.replace(large, small)
        exec(compile(code, "docs/python*.md", "exec"), names)
    said = capsys.readouterr().out
    assert "True" in said and "(2048, 3)" in said and "Itokawa.bds" in said
    assert {"itokawa.json", "itokawa.glb", "site.tif", "Itokawa.tpc"} <= {path.name for path in tmp_path.iterdir()}


def table_of(page, heading):
    """The rows below a heading of a table, as lists of cells."""
    lines = (DOCS / page).read_text().split("\n")
    start = next(i for i, line in enumerate(lines) if line.startswith(heading))
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in itertools.takewhile(lambda s: s.startswith("|"), lines[start + 2:])]


def test_the_page_has_the_formats_of_meshes():
    words = {"unit": "unit", "colors": "colours", "values": "values", "texture_coordinates": "texture coordinates"}
    rows = [
        [f"{row.name}", f"`{row.extension}`", "yes" if row.read else "", "yes" if row.written else "",
         ", ".join(word for key, word in words.items() if row[key])]
        for row in astrolith.mesh_formats()
    ]  # fmt: skip
    assert table_of("python.md", "| format | extension |") == rows
