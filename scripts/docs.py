#!/usr/bin/env python3
"""Fills the tables of docs/recipe*.md and docs/summaries*.md, and finds lines and paragraphs that are too long to read.

docs.py          writes the tables
docs.py --check  ends with status 1, and a line for each fault, where a table is stale, a text too long or a link dead

A table stands between two comments. One of summaries names a section of apps/summary_fields.json. One of the recipe names
definitions of recipe/recipe.schema.json, and shows all their fields, all but some (`without`) or some only (`only`):

    <!-- fields of gradient_noise, worley without type, locality -->
    <!-- end -->
"""
import json
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCHEMA = json.loads((ROOT / "recipe/recipe.schema.json").read_text())
SUMMARIES = json.loads((ROOT / "apps/summary_fields.json").read_text())
TABLE = re.compile(r"<!-- (fields|summary) of ([^>]+?)(?: without ([^>]+?))?(?: only ([^>]+?))? -->\n.*?<!-- end -->", re.S)
LONGEST_LINE = 120  # characters outside tables
LONGEST_PAGE = 250  # lines of a page of docs/
LONGEST_PARAGRAPH = 600  # characters without the addresses of links: five rendered lines
BIG = 1e12  # the largest magnitude of any number: not worth a word in each row


def definition(name):
    return SCHEMA if name == "document" else SCHEMA["definitions"][name]


def resolved(field):
    """The field with what it refers to; its own description, unit and default come first."""
    return {**definition(field["$ref"].rsplit("/", 1)[1]), **field} if "$ref" in field else field


def number(value):
    if value > 1e5 and value == int(value) and int(value) & (int(value) + 1) == 0:
        return f"2^{int(value).bit_length()} - 1"
    text = f"{value:g}" if abs(value) < 1e5 else f"{value:.0e}"
    return text.replace("e+", "e").replace("e0", "e").replace("e-0", "e-")


def interval(field):
    low, high, above = field.get("minimum"), field.get("maximum", BIG), field.get("exclusiveMinimum")
    if above is not None:
        return f"above {number(above)}" + (f", to {number(high)}" if high != BIG else "")
    if low == high:
        return number(low)
    if high != BIG:
        return f"{number(low)} to {number(high)}"
    return {None: "", -BIG: "", 1e-12: "> 0"}.get(low, f">= {number(low or 0)}")


def range_of(field):
    field = resolved(field)
    if "enum" in field:
        return ", ".join(f"`{value}`" for value in field["enum"])
    limits = ", or ".join(interval(option) for option in field.get("oneOf", [field]) if "required" not in option)
    match field.get("type"):
        case "integer":
            return f"integer, {limits}".removesuffix(", ")
        case "number":
            return limits
        case "array" if field.get("minItems") == field.get("maxItems") and "minItems" in field:
            each = range_of(field["items"])
            return f"{field['minItems']} numbers" + (f", {each} each" if each else "")
        case "array":
            return "a list of at least one" if field.get("minItems") else "a list"
        case kind:
            return {"boolean": "`true`, `false`", "string": "text"}.get(kind, "an object")


def default_of(name, field, owner):
    """As JSON; of a field that has not the same default everywhere, each with its name."""
    alternatives = [option["required"][0] for option in owner.get("oneOf", []) if "required" in option]
    if name in alternatives:
        return " or ".join(f"`{other}`" for other in alternatives) + " is required"
    default = "required" if name in owner.get("required", []) else field.get("default", "none")
    if isinstance(default, dict):
        return ", ".join(f"{value} {key}" for key, value in default.items())
    return (default or "empty") if isinstance(default, str) else json.dumps(default)


def recipe_rows(names, omitted, only):
    owners = {name: definition(name) for name in names}
    fields = {}  # by name, in the order of their first owner
    for owner in owners.values():
        for name, field in owner["properties"].items():
            fields.setdefault(name, (field, owner))
    for name, (field, owner) in fields.items():
        if name in omitted or (only and name not in only):
            continue
        having = [one["properties"] for one in owners.values() if name in one["properties"]]
        meaning = resolved(field)["description"]
        if len(having) < len(names):
            meaning += f"; {' and '.join(kind for one in having for kind in one['type']['enum'])} only"
        yield [f"`{name}`", meaning, field.get("unit", ""), range_of(field), default_of(name, field, owner)]


def table(match):
    names, omitted, only = ([name.strip() for name in (group or "").split(",")] if group else [] for group in match.groups()[1:])
    if match[1] == "summary":
        columns = ["field", "meaning", "unit"]
        rows = ([f"`{path}`", meaning, unit] for path, (unit, meaning) in SUMMARIES[match[2]].items())
    else:
        columns, rows = ["field", "meaning", "unit", "range", "default"], recipe_rows(names, omitted, only)
    head, *body = (f"| {' | '.join(row)} |" for row in [columns, *rows])
    return "\n".join([match[0].split("\n")[0], head, "|---" * len(columns) + "|", *body, "<!-- end -->"])


def not_shown(texts):
    """What no table shows whole."""
    tables = [match for text in texts for match in TABLE.finditer(text) if not match[4]]
    shown = {name.strip() for match in tables for name in match[2].split(",")}
    yield from (name for name, its in SCHEMA["definitions"].items() if "properties" in its and name not in shown)
    yield from (name for name in SUMMARIES if name not in shown)


def too_long(name, text):
    """Complaints about lines and about paragraphs, list items among them, outside code and tables."""
    text = re.sub(r"^```.*?^```", lambda code: "\n" * code[0].count("\n"), text, flags=re.S | re.M)
    for number, line in enumerate(text.split("\n"), 1):
        if len(line) > LONGEST_LINE and not line.startswith("|"):
            yield f"{name}:{number}: a line of {len(line)} characters; break it at {LONGEST_LINE}"
    for paragraph in re.finditer(r"^(?![|#]|    ).+(?:\n(?![|#]|    | *(?:[-*]|\d+\.) ).+)*", text, re.M):
        length = len(re.sub(r"\]\([^)]*\)", "]", " ".join(paragraph[0].split())))
        if length > LONGEST_PARAGRAPH:
            number = text[: paragraph.start()].count("\n") + 1
            yield f"{name}:{number}: a paragraph of {length} characters; break it at {LONGEST_PARAGRAPH}"


def without_code(text):
    """The text, in which the lines of code are empty and code within a line is gone."""
    text = re.sub(r"^```.*?^```|^    .*?$", lambda code: "\n" * code[0].count("\n"), text, flags=re.S | re.M)
    return re.sub(r"`[^`\n]*`", "", text)


def anchors_of(file):
    """The anchors of a page's headings, as GitHub and the site make them."""
    if file.suffix != ".md":
        return set()
    text = re.sub(r"^```.*?^```", "", file.read_text(encoding="utf-8"), flags=re.S | re.M)
    names = [re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in re.findall(r"^#+ (.*)$", text, re.M)]
    return {name if names[:i].count(name) == 0 else f"{name}-{names[:i].count(name)}" for i, name in enumerate(names)}


def dead_links(file, text):
    """Complaints about links within the repository to files, images and headings that are not there."""
    text = without_code(text)
    for link in re.finditer(r"\]\(([^)\s]+)\)|^\[[^\]]+\]: (\S+)$", text, re.M):
        address = link[1] or link[2]
        path, _, anchor = address.partition("#")
        target = (file.parent / path).resolve() if path else file
        if re.match(r"[a-z]+:", address) or (target.exists() and (not anchor or anchor in anchors_of(target))):
            continue
        yield f"{file.name}:{text[: link.start()].count(chr(10)) + 1}: the link to {address} is dead"


def main():
    faults, texts = [], []
    for file in sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")]):
        text = file.read_text(encoding="utf-8")
        texts.append(TABLE.sub(table, text))
        faults += [*too_long(file.name, texts[-1]), *dead_links(file, texts[-1])]
        if file.parent != ROOT and (lines := texts[-1].count("\n")) > LONGEST_PAGE:
            faults.append(f"{file.name}: a page of {lines} lines; split it at {LONGEST_PAGE}")
        if texts[-1] != text and sys.argv[1:] == ["--check"]:
            faults.append(f"{file.name}: its tables are stale; run scripts/docs.py")
        elif texts[-1] != text:
            file.write_text(texts[-1])
    faults += [f"no table shows the fields of {name}" for name in not_shown(texts)]
    print("\n".join(faults), end="\n" if faults else "")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
