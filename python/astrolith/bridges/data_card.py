"""A data card of a set in Croissant 1.1 (MLCommons): what its files are, with checksums, and the numbers of its members."""

from __future__ import annotations

import hashlib
import json
import re
from pathlib import Path
from typing import Any

from astrolith._arrays import PathLike, file_name
from astrolith.bridges._whole_file import write_text
from astrolith.bridges.finished_set import FinishedSet

# What the files of a set are, by their endings: what the card says of them, and their media type.
_KINDS = {
    ".ply": ("closed meshes, one of each member; with --labels each vertex has its layer and its elevation", "model/ply"),
    ".glb": ("meshes in metres, one of each member", "model/gltf-binary"),
    ".obj": ("meshes, one of each member", "model/obj"),
    ".csv": ("lists of the craters and boulders of each member", "text/csv"),
    ".png": ("pictures of each member", "image/png"),
    ".npz": ("arrays of what each pixel of a picture shows", "application/x-npz"),
    ".json": ("the recipe of each member", "application/json"),
    ".astro": ("the compact recipe of each member", "application/octet-stream"),
}
_TYPES = {int: "sc:Integer", float: "sc:Float", str: "sc:Text"}
_CONTEXT = {
    "@language": "en", "@vocab": "https://schema.org/", "sc": "https://schema.org/", "cr": "http://mlcommons.org/croissant/",
    "dct": "http://purl.org/dc/terms/", "conformsTo": "dct:conformsTo", "citeAs": "cr:citeAs", "column": "cr:column", "recordSet": "cr:recordSet",
    "field": "cr:field", "dataType": {"@id": "cr:dataType", "@type": "@vocab"}, "data": {"@id": "cr:data", "@type": "@json"}, "extract": "cr:extract",
    "source": "cr:source", "fileObject": "cr:fileObject", "fileSet": "cr:fileSet", "fileProperty": "cr:fileProperty", "includes": "cr:includes",
    "transform": "cr:transform", "jsonPath": "cr:jsonPath", "format": "cr:format", "regex": "cr:regex", "replace": "cr:replace", "separator": "cr:separator",
    "key": "cr:key", "md5": "cr:md5", "parentField": "cr:parentField", "path": "cr:path", "references": "cr:references", "repeated": "cr:repeated",
    "examples": {"@id": "cr:examples", "@type": "@json"}, "isLiveDataset": "cr:isLiveDataset", "subField": "cr:subField", "samplingRate": "cr:samplingRate",
    "equivalentProperty": "cr:equivalentProperty", "rai": "http://mlcommons.org/croissant/RAI/",
}  # fmt: skip


def write_data_card(manifest: PathLike, file: PathLike, *, name: str, description: str, license: str, creator: str, date: str) -> None:
    """Write a card in Croissant (JSON-LD) beside the manifest of a set that ``synth --members`` made.

    Parameters
    ----------
    manifest
        The ``.jsonl`` file of the set.
    file
        The card to write, in the folder of the manifest, such as ``set/croissant.json``.
    name, description, license, creator, date
        What the card says of the set; `license` is an address or an SPDX name, `date` is such as ``2026-11-29``.

    Raises
    ------
    ValueError
        The manifest is damaged or empty, or the card is to lie in another folder.
    FileNotFoundError
        The manifest is missing. It is a ValueError, too.
    """
    made, place, name_of_card = FinishedSet(manifest), Path(file_name(manifest, "manifest")).resolve(), file_name(file, "file")
    if Path(name_of_card).resolve().parent != place.parent:
        raise ValueError(f"{name_of_card}: is not in the folder of the manifest, to which the names of files are relative; write it to {place.parent}")
    if not len(made):
        raise ValueError(f"{place}: holds no member; make one with synth --members")
    names = [entry["name"] for member in made._members for entry in member["files"]]
    folders = sorted({str(Path(each).parent) for each in names})
    objects: list[dict[str, Any]] = [
        {"@type": "cr:FileObject", "@id": "manifest", "name": place.name, "contentUrl": place.name, "encodingFormat": "application/jsonlines",
         "sha256": hashlib.sha256(place.read_bytes()).hexdigest(), "description": "a line of JSON for each member: the numbers drawn, its files with their SHA-256, and figures of its mesh"}
    ]  # fmt: skip
    for ending in sorted({Path(each).suffix for each in names}):
        words, media = _KINDS.get(ending, ("files of each member", "application/octet-stream"))
        objects.append({"@type": "cr:FileSet", "@id": f"files{ending.replace('.', '-')}", "name": f"*{ending}", "description": words,
                        "encodingFormat": media, "includes": [f"*{ending}" if folder == "." else f"{folder}/*{ending}" for folder in folders]})  # fmt: skip

    def field(key: str, value: Any, path: str, words: str) -> dict[str, Any]:
        source: dict[str, Any] = {"fileObject": {"@id": "manifest"}, "extract": {"column": path.split(".", 1)[0]}}
        if "." in path:
            source["transform"] = {"jsonPath": f"$.'{path.split('.', 1)[1]}'"}
        identifier = re.sub(r"\W+", "_", key).strip("_")
        return {"@type": "cr:Field", "@id": f"members/{identifier}", "name": identifier, "description": words, "dataType": _TYPES[type(value)], "source": source}

    fields = [field("member", 0, "member", "the number of the body"), field("seed", 0, "seed", "its seed")]
    for key in dict.fromkeys(key for member in made._members for key in member["drawn"]):
        fields.append(field(f"drawn {key}", 0.0, f"drawn.{key}", f"what was drawn for {key} of the recipe"))
    if any("drawn_body" in member for member in made._members):
        fields.append(field("diameter", 0.0, "drawn_body.diameter", "the diameter that was drawn from the population, in the unit of its recipes"))
        fields.append(field("class", "", "drawn_body.class", "the class of the body that was drawn, such as rounded"))
    card = {
        "@context": _CONTEXT, "@type": "sc:Dataset", "conformsTo": "http://mlcommons.org/croissant/1.1", "name": name, "description": description,
        "license": license, "creator": {"@type": "sc:Organization", "name": creator}, "datePublished": date, "version": "1.0.0",
        "keywords": ["small bodies", "meshes", "synthetic data"],
        "citeAs": f"{creator} ({date[:4]}): {name}, {len(made)} bodies made with Astrolith", "distribution": objects,
        "recordSet": [{"@type": "cr:RecordSet", "@id": "members", "name": "members", "description": "The bodies of the set.", "key": {"@id": "members/member"}, "field": fields}],
    }  # fmt: skip
    write_text(name_of_card, json.dumps(card, indent=1) + "\n")
