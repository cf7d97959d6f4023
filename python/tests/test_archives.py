"""What archives read of ours: PDS4 labels by pds4_tools, data cards of sets by mlcroissant."""

import json
import xml.etree.ElementTree as xml

import astrolith
import numpy as np
import pytest
from astrolith import bridges

NAMES = {"target": "(25143) Itokawa", "identifier": "urn:nasa:pds:made_bodies:data:itokawa", "investigation": "made bodies"}


def labelled(folder, example):
    """A labelled mesh and the labelled table of its gravity."""
    mesh = astrolith.mesh(example("itokawa_metaballs"), resolution=16)
    made = astrolith.gravity(mesh, 1900.0, sample=0)
    astrolith.write_mesh(mesh, folder / "body.ply")
    rows = [",".join(made.columns), *(",".join(map(repr, row)) for row in made.table.tolist())]
    (folder / "gravity.csv").write_text("\n".join(rows) + "\n")
    bridges.write_pds4_label(folder / "body.ply", **NAMES)
    bridges.write_pds4_label(folder / "gravity.csv", unit="m", **NAMES)
    return mesh, made


def test_a_reader_of_pds4_reads_the_mesh_and_the_table(tmp_path, example):
    pds4_tools = pytest.importorskip("pds4_tools")
    mesh, made = labelled(tmp_path, example)
    read = pds4_tools.read(str(tmp_path / "body.ply.xml"), quiet=True)
    vertices, facets = read["vertex"], read["face"]
    assert np.array_equal(np.stack([vertices[axis] for axis in "xyz"], 1), mesh.vertices)
    assert np.array_equal(np.stack([facets[f"vertex_indices_{k}"] for k in (1, 2, 3)], 1), mesh.faces)
    table = pds4_tools.read(str(tmp_path / "gravity.csv.xml"), quiet=True)["table"]
    assert np.array_equal(np.stack([table[name] for name in made.columns], 1), made.table)
    assert table["slope_deg"].meta_data["unit"] == "deg"


def test_a_label_has_the_classes_that_the_information_model_requires(tmp_path, example):
    labelled(tmp_path, example)
    space = "{http://pds.nasa.gov/pds4/pds/v1}"
    root = xml.parse(tmp_path / "body.ply.xml").getroot()
    assert root.tag == f"{space}Product_Observational"
    assert [child.tag.removeprefix(space) for child in root] == ["Identification_Area", "Observation_Area", "File_Area_Observational"]
    parts = ["Time_Coordinates", "Primary_Result_Summary", "Investigation_Area", "Observing_System", "Target_Identification"]
    assert [child.tag.removeprefix(space) for child in root[1]] == parts
    assert [child.tag.removeprefix(space) for child in root[2]] == ["File", "Header", "Table_Binary", "Table_Binary"]


def test_what_has_no_label_is_refused(tmp_path):
    (tmp_path / "body.obj").write_text("v 0 0 0\n")
    (tmp_path / "ascii.ply").write_text("ply\nformat ascii 1.0\nend_header\n")
    for file, words in (("body.obj", "neither"), ("ascii.ply", "no binary PLY"), ("missing.ply", "does not exist")):
        with pytest.raises(ValueError, match=words):
            bridges.write_pds4_label(tmp_path / file, **NAMES)
    with pytest.raises(ValueError, match="identifier"):
        bridges.write_pds4_label(tmp_path / "body.obj", **{**NAMES, "identifier": "Itokawa"})


def test_mlcroissant_reads_the_card_of_a_set(tmp_path, example):
    mlcroissant = pytest.importorskip("mlcroissant")
    made = astrolith.mesh(example("family_of_rubble"), resolution=16, members="0:3", output=tmp_path / "{member}.ply", manifest=tmp_path / "manifest.jsonl")
    assert len(made) == 3
    words = {"name": "rubble", "description": "Rubble piles.", "license": "CC0-1.0", "creator": "nobody", "date": "2026-11-29"}
    bridges.write_data_card(tmp_path / "manifest.jsonl", tmp_path / "croissant.json", **words)
    records = list(mlcroissant.Dataset(jsonld=str(tmp_path / "croissant.json")).records("members"))
    drawn = [json.loads(line)["drawn"] for line in (tmp_path / "manifest.jsonl").read_text().splitlines()]
    assert sorted(record["members/member"] for record in records) == [0, 1, 2]
    assert sorted(record["members/drawn_body_warp_amplitude"] for record in records) == sorted(one["body.warp.amplitude"] for one in drawn)
    with pytest.raises(ValueError, match="folder of the manifest"):
        bridges.write_data_card(tmp_path / "manifest.jsonl", tmp_path.parent / "croissant.json", **words)
