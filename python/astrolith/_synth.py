"""The job of the program synth: files of meshes with levels, atlases and maps, of patches and of many members."""

from __future__ import annotations

from typing import Any

from astrolith import _jobs, _synthesis
from astrolith._meshing import call
from astrolith._options import Progress
from astrolith._recipe import Record, RecipeLike

_OPTIONS = _synthesis.options_of_synth()


def synth(recipe: RecipeLike, *, threads: int = 0, progress: Progress = None, **options: Any) -> Record:
    """Write what a recipe makes into files, as the program ``synth`` does; :func:`mesh` keeps a mesh in memory.

    Parameters
    ----------
    recipe
        A recipe, or the name of its file. Images that a recipe in memory names are looked for in the current folder.
    threads
        To use; 0: all.
    progress
        Called with the share done of a stage and a few words. Returning False ends the work.
    {options}

    Returns
    -------
    Record
        The figures of the run, as ``--summary`` has them.

    Raises
    ------
    ValueError
        The recipe or an option is wrong, or options contradict each other.
    RuntimeError
        A file cannot be written, or `progress` returned False.
    """
    return _jobs.figures_of(call(_synthesis.synth, "synth", recipe, options, threads, progress))


_jobs.document(synth, _OPTIONS)
