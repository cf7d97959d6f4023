"""What archives read of ours: PDS4 labels by pds4_tools, data cards of sets by mlcroissant."""

import json
import xml.etree.ElementTree as xml

import astrolith
import numpy as np
import pytest
from astrolith import bridges
from astrolith.bridges import pds4

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


def test_labels_are_written_from_a_shell(tmp_path, capsys):
    (tmp_path / "Body 1.ply").write_bytes(binary_ply(FLOATS, FACES))
    words = ["--target", "(433) Eros", "--collection", "urn:nasa:pds:made:data", "--investigation", "made bodies"]
    pds4.main([str(tmp_path / "Body 1.ply"), *words])
    assert capsys.readouterr().out == f"{tmp_path / 'Body 1.ply.xml'}\n"
    assert "urn:nasa:pds:made:data:body_1.ply" in (tmp_path / "Body 1.ply.xml").read_text()
    with pytest.raises(SystemExit) as ended:
        pds4.main([str(tmp_path / "no.ply"), *words])
    assert ended.value.code == 2 and "no.ply: does not exist" in capsys.readouterr().err


def binary_ply(properties, faces, corners=3):
    """A PLY of one vertex and one facet, of the types that other programs name."""
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex 1\n{properties}element face 1\n{faces}end_header\n"
    return header.encode() + bytes(12) + bytes([corners]) + bytes(4 * corners)


FLOATS = "property float32 x\nproperty float32 y\nproperty float32 z\n"
FACES = "property list uint8 int32 vertex_indices\n"


def test_the_other_names_of_types_are_taken_and_unknown_ones_are_not(tmp_path):
    mesh = tmp_path / "other.ply"
    mesh.write_bytes(binary_ply(FLOATS, FACES))
    bridges.write_pds4_label(mesh, **NAMES)
    space = "{http://pds.nasa.gov/pds4/pds/v1}"
    types = [each.text for each in xml.parse(f"{mesh}.xml").getroot().iter(f"{space}data_type")]
    assert types == ["IEEE754LSBSingle"] * 3 + ["UnsignedByte"] + ["SignedLSB4"] * 3
    mesh.write_bytes(binary_ply(FLOATS.replace("float32 z", "half z"), FACES))
    with pytest.raises(ValueError, match="property z: is of type 'half'"):
        bridges.write_pds4_label(mesh, **NAMES)


def test_facets_of_other_numbers_of_corners_and_uneven_rows_are_refused(tmp_path):
    mesh, table = tmp_path / "mesh.ply", tmp_path / "table.csv"
    # Of the second the size is that of a triangle.
    for content in (binary_ply(FLOATS, FACES, corners=4), binary_ply(FLOATS, FACES).replace(b"\3", b"\2"), binary_ply(FLOATS, FACES)[:-1]):
        mesh.write_bytes(content)
        with pytest.raises(ValueError, match="other facets than triangles"):
            bridges.write_pds4_label(mesh, **NAMES)
    mesh.write_bytes(binary_ply(FLOATS, FACES) + b"\0")
    with pytest.raises(ValueError, match="where its elements take"):
        bridges.write_pds4_label(mesh, **NAMES)
    for text in ("x,y\n1,2\n3\n", "x,y\n1,2\n3,4,5\n", "x,y\n1,2\n\n3,4\n"):
        table.write_text(text)
        with pytest.raises(ValueError, match="line 3: has [123] fields where the first line names 2"):
            bridges.write_pds4_label(table, **NAMES)
    table.write_text("x,y\n")
    with pytest.raises(ValueError, match="no rows follow"):
        bridges.write_pds4_label(table, **NAMES)
    table.write_bytes(b"x,y\r\n1,2\r\n3,4")
    bridges.write_pds4_label(table, **NAMES)
    assert "<records>2</records>" in (tmp_path / "table.csv.xml").read_text()


def test_the_card_of_draws_has_the_body_drawn_and_the_numbers_of_all_members(tmp_path):
    line = {"seed": 1, "files": [{"name": "a.ply", "sha256": "0"}]}
    members = [{**line, "member": 0, "drawn": {"a": 1.5}}, {**line, "member": 1, "drawn": {"b": 2.5}}]
    for member, diameter, kind in zip(members, (300.0, 400.0), ("top", "rounded")):
        member["drawn_body"] = {"diameter": diameter, "class": kind, "donors": [], "attempts": 1}
    (tmp_path / "set.jsonl").write_text("".join(json.dumps(member) + "\n" for member in members))
    bridges.write_data_card(tmp_path / "set.jsonl", tmp_path / "card.json", name="a", description="b", license="CC0-1.0", creator="c", date="2026-11-29")
    fields = json.loads((tmp_path / "card.json").read_text())["recordSet"][0]["field"]
    assert [each["name"] for each in fields] == ["member", "seed", "drawn_a", "drawn_b", "diameter", "class"]
    mlcroissant = pytest.importorskip("mlcroissant")
    records = list(mlcroissant.Dataset(jsonld=str(tmp_path / "card.json")).records("members"))
    assert [(each["members/diameter"], each["members/class"]) for each in records] == [(300.0, b"top"), (400.0, b"rounded")]


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
