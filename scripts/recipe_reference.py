#!/usr/bin/env python3
"""Fills the tables of fields in docs/recipe.md from recipe/recipe.schema.json.

recipe_reference.py          rewrites docs/recipe.md
recipe_reference.py --check  exit status 1, and a word, where docs/recipe.md is not what it would write

A table stands between two comments. The first comment names one or more of the schema's definitions, and the table
shows all their fields, all fields but some (`without`) or some fields only (`only`):

    <!-- fields of gradient_noise, worley without type, locality -->
    <!-- fields of worley only name, seed -->
    <!-- end -->
"""
import json
import pathlib
import re
import sys

from narrow_table import narrow_table

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCHEMA = json.loads((ROOT / "recipe/recipe.schema.json").read_text())
REFERENCE = ROOT / "docs/recipe.md"
TABLE = re.compile(
    r"<!-- fields of (?P<names>[\w, ]+?)(?: without (?P<omitted>[\w, ]+?))?(?: only (?P<only>[\w, ]+))? -->\n"
    r".*?<!-- end -->", re.S)
HEADER = "| field | meaning | unit | range | default |\n|---|---|---|---|---|\n"
BIG = 1e12  # the largest magnitude of any number: not worth a word in each row


def definition(name):
    return SCHEMA if name == "document" else SCHEMA["definitions"][name]


def resolved(field):
    """The field with what it refers to; its own description, unit and default come first."""
    if "$ref" not in field:
        return field
    return {**definition(field["$ref"].rsplit("/", 1)[1]), **field}


def number(value):
    if value > 1e5 and value == int(value) and int(value) & (int(value) + 1) == 0:
        return f"2^{int(value).bit_length()} - 1"
    text = f"{value:g}" if abs(value) < 1e5 else f"{value:.0e}"
    return text.replace("e+", "e").replace("e0", "e").replace("e-0", "e-")


def interval(field):
    if "oneOf" in field:
        return ", or ".join(interval(option) for option in field["oneOf"])
    low, high = field.get("minimum"), field.get("maximum", BIG)
    if "exclusiveMinimum" in field:
        above = f"above {number(field['exclusiveMinimum'])}"
        return above if high == BIG else f"{above}, to {number(high)}"
    if low == high:
        return number(low)
    if high == BIG:
        return {None: "", -BIG: "", 1e-12: "> 0"}.get(low, f">= {number(low)}" if low is not None else "")
    return f"{number(low)} to {number(high)}"


def range_of(field):
    field = resolved(field)
    kind = field.get("type")
    if "enum" in field:
        return ", ".join(f"`{value}`" for value in field["enum"])
    if kind == "boolean":
        return "`true`, `false`"
    if kind == "integer":
        limits = interval(field)
        return f"integer, {limits}" if limits else "integer"
    if kind == "number":
        return interval(field)
    if kind == "string":
        return "text"
    if kind == "array":
        return range_of_array(field)
    return "an object"


def range_of_array(field):
    items = field["items"]
    if "minItems" in field and field["minItems"] == field.get("maxItems"):
        limits = range_of(items)
        return f"{field['minItems']} numbers" + (f", {limits} each" if limits else "")
    return "a list of at least one" if field.get("minItems") else "a list"


def default_of(name, field, owner):
    """As JSON; of a field that has not the same default everywhere, each with its name."""
    if name in owner.get("required", []):
        return "required"
    alternatives = [option["required"][0] for option in owner.get("oneOf", []) if "required" in option]
    if name in alternatives:
        return " or ".join(f"`{other}`" for other in alternatives) + " is required"
    if "default" not in field:
        return "none"
    default = field["default"]
    if default == "":
        return "empty"
    if isinstance(default, dict):
        return ", ".join(f"{value} {key}" for key, value in default.items())
    return default if isinstance(default, str) else json.dumps(default)


def rows(names, omitted, only):
    owners = [definition(name) for name in names]
    fields = {}  # by name, in the order of their first owner
    for owner in owners:
        for name, field in owner["properties"].items():
            fields.setdefault(name, (field, owner))
    for name, (field, owner) in fields.items():
        if name in omitted or (only and name not in only):
            continue
        having = [n for n in names if name in definition(n)["properties"]]
        meaning = resolved(field)["description"]
        if len(having) < len(names):
            types = [t for n in having for t in definition(n)["properties"]["type"]["enum"]]
            meaning += f"; {' and '.join(types)} only"
        yield [f"`{name}`", meaning, field.get("unit", ""), range_of(field), default_of(name, field, owner)]


def table(match):
    def split(names):
        return [name.strip() for name in (names or "").split(",") if name.strip()]

    names, omitted, only = split(match["names"]), split(match["omitted"]), split(match["only"])
    comment = match[0].split("\n", 1)[0]
    return f"{comment}\n{HEADER}" + narrow_table(rows(names, omitted, only), shortened=1) + "<!-- end -->"


def main():
    text = REFERENCE.read_text()
    filled = TABLE.sub(table, text)
    if sys.argv[1:] == ["--check"]:
        shown = {n.strip() for m in TABLE.finditer(text) if not m["only"] for n in m["names"].split(",")}
        hidden = [n for n, d in SCHEMA["definitions"].items() if "properties" in d and n not in shown]
        for name in hidden:
            print(f"docs/recipe.md has no table of the fields of {name}")
        if filled != text:
            print("docs/recipe.md: its tables differ from recipe/recipe.schema.json; run scripts/recipe_reference.py")
        return 1 if hidden or filled != text else 0
    REFERENCE.write_text(filled)
    return 0


if __name__ == "__main__":
    sys.exit(main())
