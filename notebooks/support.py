"""What every notebook does the same way: run a program and measure it, find real input, keep a figure, state a claim.

No algorithm lives here. Environment, set by scripts/notebooks.sh:
    ASTROLITH_BIN    folder of the programs          (default build/release/bin)
    ASTROLITH_BUILD  folder of the build             (default build/release), for benchmarks
    ASTROLITH_FULL   1: the sizes of the thesis, for the figures kept in docs/; else small ones that take seconds
    ASTROLITH_OUT    folder of everything written    (default build/notebooks)
"""
import importlib
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import matplotlib
import matplotlib.pyplot as plt
import PIL.Image
from IPython.display import Image, Markdown, display

ROOT = Path(__file__).resolve().parent.parent
BUILD = Path(os.environ.get("ASTROLITH_BUILD", ROOT / "build/release"))
BIN = Path(os.environ.get("ASTROLITH_BIN", BUILD / "bin"))
OUT = Path(os.environ.get("ASTROLITH_OUT", ROOT / "build/notebooks"))
FULL = os.environ.get("ASTROLITH_FULL") == "1"
SHARED = ROOT.parent / "shared/data"
CACHE = ROOT / "data-cache"
EXAMPLES = ROOT / "synthesis/examples"

# Print sizes: a column of a paper is 84 mm wide, two are 174 mm.
matplotlib.rcParams.update({
    "figure.figsize": (6.85, 3.6), "figure.dpi": 110, "savefig.dpi": 200, "savefig.bbox": "tight",
    "font.size": 9, "axes.titlesize": 9, "axes.spines.top": False, "axes.spines.right": False,
    "axes.grid": True, "grid.alpha": 0.25, "legend.frameon": False, "lines.linewidth": 1.5,
    "image.interpolation": "nearest",
})


def choose(quick, full):
    """The size of an experiment: small in quick mode, the thesis's (or larger) in full mode."""
    return full if FULL else quick


class Notebook:
    """Folder, figures and claims of one notebook, under OUT."""

    def __init__(self, name):
        self.name = name
        self.folder = OUT / "work" / name
        self.folder.mkdir(parents=True, exist_ok=True)
        self._claims = []

    def path(self, name):
        """A file in this notebook's own folder."""
        return self.folder / name

    def run(self, program, *arguments, check=True):
        """Runs a program; returns its summary with wall_seconds and cpu_seconds as the system counted them.

        peak_bytes is the program's own where it states one: the system's counts this process before it became the program.
        """
        summary = Path(tempfile.mkstemp(suffix=".json", dir=self.folder)[1])
        command = [str(find_program(program)), *map(str, arguments), "--quiet", "--summary", str(summary)]
        with tempfile.TemporaryFile() as errors:
            start = time.perf_counter()
            process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=errors)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            seconds = time.perf_counter() - start
            errors.seek(0)
            words = errors.read().decode(errors="replace").strip()
        figures = json.loads(summary.read_text() or "{}")
        summary.unlink()
        if check and process.returncode != 0:
            raise RuntimeError(f"{program} ended with status {process.returncode}: {words}")
        return {"peak_bytes": usage.ru_maxrss * 1024} | figures | {
            "wall_seconds": seconds, "cpu_seconds": usage.ru_utime + usage.ru_stime, "status": process.returncode, "words": words}

    def once(self, output, program, *arguments, check=True):
        """run(), unless a former execution of the same command left its output: an expensive result is kept."""
        record = Path(f"{output}.record.json")
        command = [program, *map(str, arguments)]
        if Path(output).exists() and record.exists():
            kept = json.loads(record.read_text())
            if kept["command"] == command:
                return kept["figures"]
        figures = self.run(program, *arguments, check=check)
        record.write_text(json.dumps({"command": command, "figures": figures}))
        return figures

    def figure(self, name, photo=False):
        """Keeps the current figure: of full runs in docs/figures, of quick ones under OUT; photo: pictures, as JPEG."""
        folder = ROOT / "docs/figures" if FULL else OUT / "figures"
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / f"{self.name[:2]}_{name}.{'jpg' if photo else 'png'}"
        if photo:
            plt.savefig(path, pil_kwargs={"quality": 85})
        else:
            plt.savefig(path)
            # A palette is as good in print, and half the bytes that the repository keeps for ever.
            PIL.Image.open(path).convert("RGB").quantize(256).save(path, optimize=True)
        plt.show()

    def claim(self, what, thesis, ours, comment=""):
        """An entry of the list of claims; every number in it was computed in a cell."""
        self._claims.append({"notebook": self.name, "what": what, "thesis": thesis, "ours": ours, "comment": comment})
        folder = OUT / ("claims_full" if FULL else "claims")
        folder.mkdir(parents=True, exist_ok=True)
        (folder / f"{self.name}.json").write_text(json.dumps(self._claims, indent=1))
        say(f"**{what}**: thesis {thesis}, ours {ours}. {comment}")


def say(text):
    """Text with computed numbers."""
    display(Markdown(text))


def picture(path, width=900):
    """Shows a picture that a program wrote."""
    display(Image(filename=str(path), width=width))


def find_program(name):
    """A program or a benchmark of the build."""
    for folder in (BIN, BUILD / "tests/benchmarks"):
        if (folder / name).exists():
            return folder / name
    raise FileNotFoundError(f"no program {name} in {BIN}: run scripts/notebooks.sh, which builds it")


class NotAtHand(Exception):
    """The notebook needs input that cannot be had here; scripts/notebooks.sh then says "skipped"."""


def needed(path):
    """path, or the end of this notebook where the file is not at hand."""
    if not Path(path).exists():
        raise NotAtHand(f"{Path(path).name} is not at hand")
    return path


def package(name="astrolith"):
    """A Python package: ours, Debian's, or one of notebooks/requirements.txt; the end of this notebook where it is not there."""
    # Before Debian's packages: some of theirs are too old for them.
    sys.path[:0] = [str(folder) for folder in (OUT / "venv/lib").glob("python3*/site-packages") if str(folder) not in sys.path]
    try:
        return importlib.import_module(name)
    except ImportError:
        remedy = "-DASTROLITH_PYTHON=ON builds it" if name == "astrolith" else "scripts/notebooks.sh installs it"
        raise NotAtHand(f"the Python package {name} is not at hand ({remedy})") from None


def run_peer(script, *arguments, peers=False):
    """What notebooks/peers/SCRIPT prints as JSON; peers: it needs the packages of notebooks/requirements.txt."""
    python = needed(OUT / "venv/bin/python") if peers else sys.executable
    command = [python, ROOT / "notebooks/peers" / script, *map(str, arguments)]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def shape(body):
    """The finest model of a body at hand: of the data folder beside the checkout, else of data-cache."""
    models = sorted((SHARED / "shapes").glob(f"{body}_*.ply")) if SHARED.exists() else []
    models = [m for m in models if "DEFECT" not in m.name]
    if models:
        return max(models, key=lambda m: m.stat().st_size)
    if (CACHE / f"{body}.bmf").exists():
        return CACHE / f"{body}.bmf"
    return None


def first_shape(*bodies):
    """The first of some bodies that is at hand: notebooks run wherever scripts/fetch_data.sh has run."""
    return next(path for path in map(shape, bodies) if path is not None)


def all_shapes():
    """A model of each body at hand, the finest of each, by name."""
    names = {p.name.split("_")[0] for p in (SHARED / "shapes").glob("*.ply")} | {p.stem for p in CACHE.glob("*.bmf")}
    return {name: shape(name) for name in sorted(names)}


def photo(name):
    """A photo of rock: of the data folder, else the gravel of data-cache."""
    found = sorted((SHARED / "textures").glob(f"{name}*.png")) if SHARED.exists() else []
    return found[0] if found else CACHE / "gravel.png"


def read_json(path):
    return json.loads(Path(path).read_text())


def markdown_table(rows, header):
    """Shows rows as a table."""
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    say("\n".join(lines))


if sys.platform != "linux":
    raise RuntimeError("the notebooks measure processes the way Linux counts them")
