"""Reads the .glb files that Astrolith writes: their levels, textures and material; and adds parts that collide."""

from __future__ import annotations

import dataclasses
import json
import struct
from typing import Any, Optional, Sequence

import numpy as np
import numpy.typing as npt

from astrolith import _arrays
from astrolith._arrays import PathLike

_MAGIC, _JSON, _BINARY = 0x46546C67, 0x4E4F534A, 0x004E4942
_TYPES: dict[int, Any] = {5126: np.float32, 5125: np.uint32, 5123: np.uint16}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


@dataclasses.dataclass
class Level:
    """A mesh of the file in metres, with +z up, as the body's frame has it."""

    name: str
    vertices: npt.NDArray[np.float64]
    faces: npt.NDArray[np.uint32]
    normals: Optional[npt.NDArray[np.float32]]
    uv: Optional[npt.NDArray[np.float32]]  # from the image's top left corner
    images: dict[str, bytes]  # PNG, by their use in the material: "normal", "occlusion", "color"
    colors: Optional[npt.NDArray[np.float32]] = None  # linear light of the vertices


def is_collision(name: str) -> bool:
    """Whether a node is a part that collides and is not seen, by Unreal's or Godot's names."""
    return name.startswith("UCX_") or name.endswith("-convcolonly")


class _File:
    def __init__(self, file: PathLike) -> None:
        self.name = _arrays.file_name(file, "glb")
        try:
            with open(self.name, "rb") as stream:
                data = stream.read()
            magic, _, _ = struct.unpack_from("<III", data, 0)
            length, kind = struct.unpack_from("<II", data, 12)
            if magic != _MAGIC or kind != _JSON:
                raise struct.error
            self.document = json.loads(data[20 : 20 + length])
            self.binary = memoryview(data)[28 + length :]
        except FileNotFoundError:
            raise _arrays.MissingFileError(f"{self.name}: there is no such file") from None
        except (struct.error, ValueError):
            raise ValueError(f"{self.name}: is no .glb of synth; make one with synth -o NAME.glb") from None

    def view(self, number: int) -> memoryview:
        view = self.document["bufferViews"][number]
        return self.binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]

    def array(self, number: Optional[int]) -> Any:
        if number is None:
            return None
        accessor = self.document["accessors"][number]
        values = np.frombuffer(self.view(accessor["bufferView"]), _TYPES[accessor["componentType"]])
        width = _WIDTHS[accessor["type"]]
        return values.reshape(-1, width) if width > 1 else values

    def colors(self, number: Optional[int]) -> Optional[npt.NDArray[np.float32]]:
        values = self.array(number)
        return None if values is None else (values[:, :3] / np.iinfo(values.dtype).max).astype(np.float32)

    def images(self, material: dict[str, Any]) -> dict[str, bytes]:
        textures = {
            "normal": material.get("normalTexture"),
            "occlusion": material.get("occlusionTexture"),
            "color": material["pbrMetallicRoughness"].get("baseColorTexture"),
        }
        images = {}
        for use, texture in textures.items():
            if texture is not None:
                source = self.document["textures"][texture["index"]]["source"]
                images[use] = bytes(self.view(self.document["images"][source]["bufferView"]))
        return images


def read_origin(file: PathLike) -> npt.NDArray[np.float64]:
    """The place in the body's frame that the vertices of a .glb of ``synth`` are relative to, metres."""
    return np.array(_File(file).document["asset"].get("extras", {}).get("origin", (0.0, 0.0, 0.0)), np.float64)


def read_levels(file: PathLike) -> list[Level]:
    """The levels of detail of a .glb of ``synth``, the finest first.

    Raises
    ------
    ValueError
        The file is none of ``synth``. FileNotFoundError, which is one, too: there is no such file.
    """
    glb = _File(file)
    levels = []
    try:
        for node in glb.document["nodes"]:
            if is_collision(node["name"]):
                continue
            primitive = glb.document["meshes"][node["mesh"]]["primitives"][0]
            attributes = primitive["attributes"]
            levels.append(
                Level(
                    node["name"],
                    glb.array(attributes["POSITION"]).astype(np.float64)
                    * node.get("scale", (1.0,))[0],  # of files before November 2026
                    glb.array(primitive["indices"]).reshape(-1, 3),
                    glb.array(attributes.get("NORMAL")),
                    glb.array(attributes.get("TEXCOORD_0")),
                    glb.images(glb.document["materials"][primitive["material"]]),
                    glb.colors(attributes.get("COLOR_0")),
                )
            )
    except (KeyError, IndexError, TypeError, ValueError):
        raise ValueError(f"{glb.name}: is no .glb of synth; make one with synth -o NAME.glb") from None
    return levels


def with_parts(file: PathLike, parts: Sequence[tuple[str, npt.NDArray[Any], npt.NDArray[Any]]]) -> bytes:
    """The bytes of a .glb of ``synth`` with further meshes: names, vertices in metres of the body's frame, and faces."""
    glb = _File(file)
    document, binary = glb.document, bytearray(glb.binary)
    try:
        node = document["nodes"][0]
        if "scale" in node:
            raise ValueError(f"{glb.name}: was made by an earlier version; make it anew")
        turn, origin = node["rotation"], document["asset"]["extras"].get("origin", (0.0, 0.0, 0.0))
        for name, vertices, faces in parts:
            points, corners = np.ascontiguousarray(vertices - np.array(origin), np.float32), np.ascontiguousarray(faces, np.uint32)
            first = len(document["accessors"])
            for array, target, component, kind in ((points, 34962, 5126, "VEC3"), (corners, 34963, 5125, "SCALAR")):
                view = {"buffer": 0, "byteOffset": len(binary), "byteLength": array.nbytes, "target": target}
                accessor = {"bufferView": len(document["bufferViews"]), "componentType": component,
                            "count": array.size // _WIDTHS[kind], "type": kind}  # fmt: skip
                document["bufferViews"].append(view)
                document["accessors"].append(accessor)
                binary += array.tobytes()
            document["accessors"][first].update(min=points.min(axis=0).tolist(), max=points.max(axis=0).tolist())
            primitive = {"attributes": {"POSITION": first}, "indices": first + 1, "mode": 4}
            document["scenes"][0]["nodes"].append(len(document["nodes"]))
            document["nodes"].append({"mesh": len(document["meshes"]), "name": name, "rotation": turn})
            document["meshes"].append({"name": name, "primitives": [primitive]})
        document["buffers"][0]["byteLength"] = len(binary)
    except (KeyError, IndexError, TypeError):
        raise ValueError(f"{glb.name}: is no .glb of synth; make one with synth -o NAME.glb") from None
    text = json.dumps(document, separators=(",", ":"), ensure_ascii=False).encode()
    text += b" " * (-len(text) % 4)
    header = struct.pack("<IIIII", _MAGIC, 2, 28 + len(text) + len(binary), len(text), _JSON)
    return header + text + struct.pack("<II", len(binary), _BINARY) + bytes(binary)
