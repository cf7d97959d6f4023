"""The mesh of a recipe: the job of the program synth with arrays in place of a file."""

from __future__ import annotations

import os
import sys
import tempfile
from typing import Any, Union, overload

from astrolith import _arrays, _jobs, _options, _synthesis
from astrolith._mesh import Mesh
from astrolith._options import Progress
from astrolith._recipe import Record, RecipeLike, json_of, records

_OPTIONS = _synthesis.options_of_synth()
_FORMATS = tuple(row["extension"] for row in _synthesis.mesh_formats() if row["written"])


def call(work: Any, name: str, recipe: RecipeLike, options: dict[str, Any], threads: int, progress: Progress) -> Any:
    """What the job of synth gives for a recipe's file, or for a recipe in memory. Messages have the caller's name."""
    tile = options.get("tile")
    if tile is not None and not isinstance(tile, str):
        options["tile"] = "/".join(str(part) for part in _arrays.items(tile, "tile"))
    given, text = _jobs.words(name, _OPTIONS, options), ""
    if _arrays.is_file_name(recipe):
        given.append(("recipe", [_arrays.file_name(recipe, "recipe")]))
    else:
        text = json_of(recipe)[0]
    return work(given, text, [os.path.dirname(__file__), sys.prefix, "/usr/local", "/usr"], _options.threads(threads), progress)


def _made(fields: dict[str, Any]) -> Mesh:
    figures: Record = records(fields.pop("figures"))
    if "map_plane" in fields:
        figures["map_plane"] = fields.pop("map_plane")
    return Mesh(fields.pop("vertices"), fields.pop("faces"), figures=figures, **fields)


@overload
def mesh(recipe: RecipeLike, *, members: str, threads: int = ..., progress: Progress = ..., **options: Any) -> list[Mesh]: ...
@overload
def mesh(recipe: RecipeLike, *, threads: int = ..., progress: Progress = ..., **options: Any) -> Mesh: ...
def mesh(recipe: RecipeLike, *, threads: int = 0, progress: Progress = None, **options: Any) -> Union[Mesh, list[Mesh]]:
    """Mesh the surface of a recipe's body: closed and 2-manifold, but for the cuts of patches and tiles.

    The options are those of :func:`synth`; without `output` no file of the mesh is written. `tile` may be a pair (I, N).

    Parameters
    ----------
    recipe
        A recipe with a body, a dictionary or a file.
    threads
        Threads to use; 0: all. They do not change the result.
    progress
        Called with the share done and a few words.
    {options}

    Returns
    -------
    Mesh
        float32 vertices and normals, uint32 faces, and uint8 colors where a layer of the recipe paints. With `members` a
        list of them in the order of their numbers.

    Raises
    ------
    ValueError
        The recipe or an option is wrong, or there is no surface in the region.
    RuntimeError
        The mesh is no closed manifold, or `progress` returned False.
    KeyboardInterrupt
        Ctrl-C was pressed; it is raised within a second.
    """
    figures, made = call(_synthesis.meshes, "mesh", recipe, options, threads, progress)
    said = _jobs.figures_of(figures)
    if not made or said.get("members", {}).get("failed"):
        failures = sorted(line for line in said.remarks if line.startswith("member "))  # members fail in any order
        raise ValueError(f"mesh: {[*failures, *said.remarks, 'these options make none; call synth'][0]}")
    if "members" not in said:
        return _made(made[0])
    return [_made(fields) for fields in made]


def predict(recipe: RecipeLike, *, format: str = ".ply", threads: int = 0, **options: Any) -> Record:
    """Predict what the program ``synth`` takes for a mesh, as ``synth --predict`` does.

    Parameters
    ----------
    recipe, options
        As `mesh` has them.
    format
        The extension of the file: one that is written, of :func:`mesh_formats`.
    threads
        Threads that make the mesh; 0: all.

    Returns
    -------
    Record
        resolution, triangles, file_bytes, peak_bytes (of this process, with what it holds already), seconds (on the
        clock, on cores that do nothing else) and processor_seconds (of all threads together). Most are within 30 %.

    Raises
    ------
    ValueError
        The recipe or an option is wrong, or there is no surface in the region.
    """
    _arrays.choice(format, "format", _FORMATS)
    file = os.path.join(tempfile.gettempdir(), "mesh" + format)  # is not written
    asked = {**options, "predict": True, "output": file}
    figures = _jobs.figures_of(call(_synthesis.synth, "predict", recipe, asked, threads, None))
    return Record({"resolution": figures.resolution, **figures.predicted})


_jobs.document(mesh, _OPTIONS)
