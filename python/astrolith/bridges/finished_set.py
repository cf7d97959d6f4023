"""A set that ``synth --members`` has made, read member by member."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any, Iterator, Optional

import numpy as np

from astrolith._arrays import MissingFileError, PathLike, file_name
from astrolith._mesh import mesh_formats, read_mesh

_MESHES = {row.extension for row in mesh_formats() if row.read and row.written} | {".ply.zst"}


class FinishedSet:
    """The members of a manifest, in the order of their numbers.

    Item k is a dictionary: ``member``, ``seed``, ``drawn`` (the numbers of the family by their paths), ``files`` (the
    paths of the member's files by their endings); where there is a mesh, ``vertices`` (n, 3) float32, ``faces``
    (m, 3) int64 and, where the file has them, ``normals`` (n, 3) float32, ``labels`` (n) int32 and ``elevations`` (n)
    float32 (``synth --labels``); where there are maps of pictures, ``maps`` (their arrays by name); ``variation`` with
    ``--vary``: its similarity, strength and distances. Files are read when an item is asked for. ``torch_dataset`` takes such a set.

    Parameters
    ----------
    manifest
        The ``.jsonl`` file. Its folder holds the members' files.
    check
        Compare every file with its SHA-256 when it is read.

    Raises
    ------
    ValueError
        The manifest is damaged, or a file is not the one that the manifest states.
    FileNotFoundError
        The manifest or a file of it is missing. It is a ValueError, too.
    """

    def __init__(self, manifest: PathLike, *, check: bool = False) -> None:
        manifest = file_name(manifest, "manifest")
        self._folder = Path(manifest).resolve().parent
        self._check = check
        members: dict[int, dict[str, Any]] = {}
        try:
            text = Path(manifest).read_text(encoding="utf-8")
        except FileNotFoundError:
            raise MissingFileError(f"{manifest}: does not exist; check the name") from None
        except (OSError, UnicodeDecodeError) as error:
            raise ValueError(f"{manifest}: cannot be read ({error})") from None
        for line in text.split("\n"):
            member = _member(line)  # a run that was cut off leaves a piece of a line, and makes that member again
            if member is not None:
                members[member["member"]] = member
        if text.strip() and not members:
            raise ValueError(f"{manifest}: holds no member of a set; give a manifest of synth")
        self._members = [members[key] for key in sorted(members)]

    def __len__(self) -> int:
        return len(self._members)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return (self[k] for k in range(len(self)))

    def __repr__(self) -> str:
        return f"<astrolith.bridges.FinishedSet: {len(self)} members in {self._folder}>"

    def __getitem__(self, index: int) -> dict[str, Any]:
        stated = self._members[index]
        item: dict[str, Any] = {key: stated[key] for key in ("member", "seed", "drawn")}
        if "variation" in stated:
            item["variation"] = stated["variation"]
        item["files"] = {_ending(entry["name"]): str(self._path(entry)) for entry in stated["files"]}
        for ending, path in item["files"].items():
            if ending in _MESHES and "vertices" not in item:
                mesh = read_mesh(path)
                item.update(vertices=mesh.vertices.astype(np.float32), faces=mesh.faces.astype(np.int64))
                if mesh.normals is not None:
                    item["normals"] = mesh.normals.astype(np.float32)
                if mesh.labels is not None and mesh.elevations is not None:
                    item.update(labels=mesh.labels, elevations=mesh.elevations)
            elif ending == ".npz":
                with np.load(path, allow_pickle=False) as maps:
                    item["maps"] = dict(maps)
        return item

    def _path(self, entry: dict[str, Any]) -> Path:
        path = self._folder / str(entry["name"])
        if not path.is_file():
            raise MissingFileError(f"{path}: is missing; run synth --members again")
        if self._check and _sha256(path) != entry["sha256"]:
            raise ValueError(f"{path}: is not the file that the manifest states; run synth --members again")
        return path


def _member(line: str) -> Optional[dict[str, Any]]:
    """The member of a line; None for a line that states none."""
    try:
        stated = json.loads(line)
        member = {key: stated[key] for key in ("seed", "drawn", "files")}
        member["member"] = int(stated["member"])
        member.update({key: stated[key] for key in ("variation", "drawn_body") if key in stated})
        for entry in member["files"]:
            if not all(isinstance(entry[key], str) for key in ("name", "sha256")):
                return None
    except (ValueError, KeyError, TypeError):
        return None
    return member


def _ending(name: str) -> str:
    path = Path(name)
    return Path(path.stem).suffix + path.suffix if path.suffix == ".zst" else path.suffix


def _sha256(path: Path) -> str:
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while piece := file.read(1 << 20):
            digest.update(piece)
    return digest.hexdigest()
