"""Writes the types of the keyword arguments of jobs, for type checkers: job_stubs.py FOLDER_OF_MODULES OUTPUT.pyi

The options of a job are those of the program of the same name, so their table in C++ is the only list of them.
"""

import pathlib
import sys

sys.path.insert(0, sys.argv[1])
import _estimation  # noqa: E402

# pack_spheres() stands for the first two; fit_texture() takes the third as an argument of another type.
LEFT_OUT = {"packing-only", "density", "spectrum"}
lines = ["from collections.abc import Sequence", "from typing import Optional, TypedDict", "", "from astrolith._arrays import PathLike"]
for job, name in (("fit_shape", "FitShapeOptions"), ("fit_gabor", "FitTextureOptions")):
    lines += ["", "", f"class {name}(TypedDict, total=False):"]
    lines += [f"    {option.replace('-', '_')}: Optional[{kind}]" for option, kind, *_ in _estimation.options_of(job) if option not in LEFT_OUT]
pathlib.Path(sys.argv[2]).write_text("\n".join(lines) + "\n")
