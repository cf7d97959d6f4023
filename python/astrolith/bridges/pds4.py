"""Labels of the Planetary Data System (PDS4) for meshes in binary PLY and for tables in CSV."""

from __future__ import annotations

import argparse
import hashlib
import os
import re
import xml.etree.ElementTree as xml
from pathlib import Path
from typing import Optional

import numpy as np

from astrolith import _arrays
from astrolith._arrays import PathLike
from astrolith.bridges._whole_file import write_bytes

_MODEL = "1.18.0.0"  # of the information model, whose classes stand here in its order
_SPACE = "http://pds.nasa.gov/pds4/pds/v1"
# PLY's types: PDS4's, bytes.
_BINARY = {
    "char": ("SignedByte", 1), "uchar": ("UnsignedByte", 1), "short": ("SignedLSB2", 2), "ushort": ("UnsignedLSB2", 2),
    "int": ("SignedLSB4", 4), "uint": ("UnsignedLSB4", 4), "float": ("IEEE754LSBSingle", 4), "double": ("IEEE754LSBDouble", 8),
}  # fmt: skip
_ALIASES = {
    "int8": "char", "uint8": "uchar", "int16": "short", "uint16": "ushort",
    "int32": "int", "uint32": "uint", "float32": "float", "float64": "double",
}  # fmt: skip
# The ends of names of columns, and PDS4's units.
_UNITS = {"_m_s2": "m/s**2", "_J_kg": "J/kg", "_deg": "deg", "_kg": "kg", "_km": "km", "_m": "m"}
_LENGTHS = {"x", "y", "z", "elevation"}


def _add(parent: xml.Element, *names: str, **values: object) -> xml.Element:
    """Add an element with the children `values`; several names stand in one another. Returns the last one."""
    for name in names:
        parent = xml.SubElement(parent, name)
    for name, value in values.items():
        if value is not None:
            xml.SubElement(parent, name).text = str(value)
    return parent


def _unit_of(column: str, length: Optional[str]) -> Optional[str]:
    if column in _LENGTHS:
        return length
    return next((unit for end, unit in _UNITS.items() if column.endswith(end)), None)


def _binary_table(area: xml.Element, name: str, offset: int, records: int, columns: list[tuple[str, str]], length: Optional[str]) -> int:
    """Add a table of fixed records; returns its end."""
    table = _add(area, "Table_Binary", name=name, offset=None, records=None)
    xml.SubElement(table, "offset", unit="byte").text = str(offset)
    _add(table, records=records)
    size = sum(_BINARY[kind][1] for _, kind in columns)
    record = _add(table, "Record_Binary", fields=len(columns), groups=0)
    xml.SubElement(record, "record_length", unit="byte").text = str(size)
    place = 1
    for number, (column, kind) in enumerate(columns, 1):
        field = _add(record, "Field_Binary", name=column, field_number=number)
        xml.SubElement(field, "field_location", unit="byte").text = str(place)
        _add(field, data_type=_BINARY[kind][0])
        xml.SubElement(field, "field_length", unit="byte").text = str(_BINARY[kind][1])
        _add(field, unit=_unit_of(column, length))
        place += _BINARY[kind][1]
    return offset + records * size


def _header(area: xml.Element, size: int, standard: str) -> None:
    header = _add(area, "Header", name="header")
    xml.SubElement(header, "offset", unit="byte").text = "0"
    xml.SubElement(header, "object_length", unit="byte").text = str(size)
    _add(header, parsing_standard_id=standard)


def _columns(element: str, name: str) -> list[tuple[str, str]]:
    """The columns of an element of a PLY file, where a list is one of three corners: their names and PLY's types."""
    columns: list[tuple[str, str]] = []
    for counted, of, column in re.findall(r"^property (?:list (\w+) )?(\w+) (\w+)$", element, re.M):
        columns += [("corners", counted), *((f"{column}_{k}", of) for k in (1, 2, 3))] if counted else [(column, of)]
    columns = [(column, _ALIASES.get(of, of)) for column, of in columns]
    for column, of in columns:
        if of not in _BINARY:
            raise ValueError(f"{name}: property {column}: is of type {of!r}, which PLY has not; write it with synth or write_mesh")
    return columns


def _has_triangles(records: bytes, number: int, columns: list[tuple[str, str]]) -> bool:
    """Whether each record states three corners, where it states their number."""
    sizes = [_BINARY[of][1] for _, of in columns]
    table = np.frombuffer(records, np.uint8).reshape(number, sum(sizes))
    stated = [table[:, sum(sizes[:k]) : sum(sizes[: k + 1])] for k, (column, _) in enumerate(columns) if column == "corners"]
    return all((corners[:, 0] == 3).all() and not corners[:, 1:].any() for corners in stated)


def _ply(area: xml.Element, content: bytes, name: str) -> None:
    """The tables of vertices and facets of a binary PLY file of triangles."""
    start = content.find(b"end_header\n") + len(b"end_header\n")
    header = content[:start].decode("ascii", "replace")
    if not header.startswith("ply\nformat binary_little_endian"):
        raise ValueError(f"{name}: is no binary PLY of little endian; write one with synth or write_mesh")
    said = re.search(r"^comment length unit: (\w+)$", header, re.M)
    _header(area, start, "7-Bit ASCII Text")
    end = start
    for element in re.split(r"^element ", header, flags=re.M)[1:]:
        kind, number = element.split()[:2]
        columns = _columns(element, name)
        begin, end = end, _binary_table(area, kind, end, int(number), columns, said[1] if said else None)
        if end > len(content) or not _has_triangles(content[begin:end], int(number), columns):
            raise ValueError(f"{name}: ends within its {kind}, or has other facets than triangles, for which PDS4 has no table")
    if end != len(content):
        raise ValueError(f"{name}: has {len(content)} bytes where its elements take {end}; write it anew with synth or write_mesh")


def _csv(area: xml.Element, content: bytes, name: str, unit: Optional[str]) -> None:
    """The table of a CSV file, of which the first line names the columns."""
    lines = content.split(b"\n")
    columns = lines[0].decode("utf-8").strip().split(",")
    rows = lines[1:] if lines[-1] else lines[1:-1]
    if not rows or not all(re.fullmatch(r"[A-Za-z_][\w .]*", column) for column in columns):
        raise ValueError(f"{name}: its first line names no columns, or no rows follow; write one with gravity -o FILE.csv")
    for number, row in enumerate(rows, 2):
        if not row.strip() or row.count(b",") + 1 != len(columns):
            raise ValueError(f"{name}: line {number}: has {row.count(b',') + 1} fields where the first line names {len(columns)}; write as many, none of them with a comma")
    _header(area, len(lines[0]) + 1, "PDS DSV 1")
    table = _add(area, "Table_Delimited", name="table")
    xml.SubElement(table, "offset", unit="byte").text = str(len(lines[0]) + 1)
    delimiter = "Carriage-Return Line-Feed" if lines[0].endswith(b"\r") else "Line-Feed"
    _add(table, parsing_standard_id="PDS DSV 1", records=len(rows), record_delimiter=delimiter, field_delimiter="Comma")
    record = _add(table, "Record_Delimited", fields=len(columns), groups=0)
    first = rows[0].decode("utf-8").strip().split(",")
    for number, (column, value) in enumerate(zip(columns, first), 1):
        number_like = re.fullmatch(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", value)
        _add(record, "Field_Delimited", name=column, field_number=number, data_type="ASCII_Real" if number_like else "ASCII_String", unit=_unit_of(column, unit))


def write_pds4_label(
    file: PathLike,
    *,
    target: str,
    target_type: str = "Asteroid",
    identifier: str,
    investigation: str,
    title: Optional[str] = None,
    unit: Optional[str] = None,
) -> str:
    """Write the PDS4 label of a mesh (binary PLY) or of a table (CSV, as ``gravity -o`` writes it) beside it, as FILE.xml.

    The label is a ``Product_Observational`` of the information model 1.18: identification, times (inapplicable), the
    investigation, the target, and every byte of the file as header, table of vertices and table of facets, or as header
    and delimited table. An archive wants more, such as citations and references to its bundle.

    Parameters
    ----------
    file
        The mesh or the table.
    target, target_type
        The body, such as "(433) Eros", and what it is in PDS4's words, such as "Asteroid" or "Satellite".
    identifier
        The logical identifier, such as "urn:nasa:pds:bundle:collection:product".
    investigation
        The name of the study, which the label calls an "Individual Investigation".
    title
        The product's title. None: the name of the file.
    unit
        "m" or "km": the unit of the places in a table. Meshes state theirs.

    Returns
    -------
    str
        The name of the label.

    Raises
    ------
    ValueError
        The file is neither, or has what PDS4 has no words for.
    FileNotFoundError
        The file is missing. It is a ValueError, too.
    """
    name = _arrays.file_name(file, "file")
    if not re.fullmatch(r"urn(:[a-z0-9._-]+){5}", identifier):
        raise ValueError(f"identifier: is {identifier!r}; give one such as urn:nasa:pds:bundle:collection:product, in small letters")
    try:
        content = Path(name).read_bytes()
    except FileNotFoundError:
        raise _arrays.MissingFileError(f"{name}: does not exist; check the name") from None
    root = xml.Element("Product_Observational", {"xmlns": _SPACE, "xmlns:xsi": "http://www.w3.org/2001/XMLSchema-instance"})
    _add(root, "Identification_Area", logical_identifier=identifier, version_id="1.0", title=title or os.path.basename(name),
         information_model_version=_MODEL, product_class="Product_Observational")  # fmt: skip
    observation = _add(root, "Observation_Area")
    times = _add(observation, "Time_Coordinates")
    for which in ("start_date_time", "stop_date_time"):
        xml.SubElement(times, which, {"xsi:nil": "true", "nilReason": "inapplicable"})
    _add(observation, "Primary_Result_Summary", purpose="Science", processing_level="Derived")
    about = _add(observation, "Investigation_Area", name=investigation, type="Individual Investigation")
    _add(about, "Internal_Reference", lid_reference=":".join(identifier.split(":")[:4]), reference_type="data_to_investigation")
    _add(observation, "Observing_System", "Observing_System_Component", name="Astrolith", type="Host")
    _add(observation, "Target_Identification", name=target, type=target_type)
    area = _add(root, "File_Area_Observational")
    place = _add(area, "File", file_name=os.path.basename(name))
    xml.SubElement(place, "file_size", unit="byte").text = str(len(content))
    _add(place, md5_checksum=hashlib.md5(content).hexdigest())
    if name.endswith(".ply"):
        _ply(area, content, name)
    elif name.endswith(".csv"):
        _csv(area, content, name, unit)
    else:
        raise ValueError(f"{name}: is neither a .ply nor a .csv; PDS4 describes tables of these")
    xml.indent(root)
    write_bytes(f"{name}.xml", xml.tostring(root, encoding="utf-8", xml_declaration=True) + b"\n")
    return f"{name}.xml"


def main(words: Optional[list[str]] = None) -> None:
    """Write labels from a shell: ``python -m astrolith.bridges.pds4 body.ply --target "(433) Eros" ...``."""
    parser = argparse.ArgumentParser(prog="astrolith.bridges.pds4", description="Writes the PDS4 label of each file beside it, as FILE.xml.")
    parser.add_argument("files", nargs="+", help="meshes (binary .ply) and tables (.csv, as gravity -o writes them)")
    parser.add_argument("--target", required=True, help='the body, such as "(433) Eros"')
    parser.add_argument("--target-type", default="Asteroid", help="what it is in PDS4's words (default Asteroid)")
    parser.add_argument("--collection", required=True, help="urn:agency:archive:bundle:collection; the name of the file follows it")
    parser.add_argument("--investigation", required=True, help="the name of the study")
    parser.add_argument("--unit", choices=["m", "km"], help="of the places in tables; meshes state theirs")
    given = parser.parse_args(words)
    for file in given.files:
        product = re.sub(r"[^a-z0-9._-]", "_", os.path.basename(file).lower())
        try:
            print(write_pds4_label(file, target=given.target, target_type=given.target_type, identifier=f"{given.collection}:{product}",
                                   investigation=given.investigation, unit=given.unit))  # fmt: skip
        except ValueError as error:
            parser.exit(2, f"{parser.prog}: {error}\n")


if __name__ == "__main__":
    main()
