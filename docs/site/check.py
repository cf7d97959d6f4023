"""Checks a built site: check.py FOLDER  ends with status 1, and a line for each fault.

A link, picture, script or style that leads to no file or anchor of the site is a fault; so is a script, style or picture
of another host, a public function of the Python package without a docstring, and a page of docs/ above 250 lines. Counts
the public C++ functions that have no comment of their own or of their group, too.
"""

import ast
import html.parser
import pathlib
import sys
import urllib.parse
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
LONGEST_PAGE = 250


class Addresses(html.parser.HTMLParser):
    """The addresses that a page leads to, and the anchors that it has."""

    def __init__(self, file):
        super().__init__()
        self.links, self.anchors = [], {"", "top"}
        self.feed(file.read_text(encoding="utf-8", errors="replace"))

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.anchors |= {values[key] for key in ("id", "name") if values.get(key)}
        self.links += [(tag, values[key]) for key in ("href", "src") if values.get(key) is not None]


def dead_links(folder):
    """Complaints about the links of all pages, and how many links there were."""
    # The page of the browser and executed notebooks are programs of their own: their links are not followed.
    files = [file for file in sorted(folder.rglob("*.html")) if file.name not in ("page.html", "404.html") and "files" not in file.parts]
    pages = {file: Addresses(file) for file in files}
    faults, count = [], 0
    for file, page in pages.items():
        for tag, address in page.links:
            parts = urllib.parse.urlsplit(address)
            name = f"{file.relative_to(folder)}: {address}"
            if parts.scheme in ("http", "https") or parts.netloc:
                if tag != "a":
                    faults.append(f"{name} is of another host")
                continue
            if parts.scheme:
                continue
            count += 1
            target = (file.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else file
            target = target / "index.html" if target.is_dir() else target
            if not target.exists():
                faults.append(f"{name} is dead")
            elif target in pages and urllib.parse.unquote(parts.fragment) not in pages[target].anchors and tag == "a":
                faults.append(f"{name} has no such anchor")
    return sorted(set(faults)), len(pages), count


def public_functions(node, public=True):
    """Public functions and classes of a module, with whether they have a docstring."""
    for child in node.body:
        if not isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            continue
        overload = any(getattr(decorator, "id", "") == "overload" for decorator in child.decorator_list)
        if public and not child.name.startswith("_") and not overload:
            yield child, bool(ast.get_docstring(child))
            if isinstance(child, ast.ClassDef):
                yield from public_functions(child)


def undocumented(folder):
    """Complaints about functions of the Python package, and how many functions and classes it has."""
    found = [
        (file.relative_to(folder), *function)
        for file in sorted(folder.rglob("*.py"))
        for function in public_functions(ast.parse(file.read_text(encoding="utf-8")))
    ]
    return [f"{file}:{node.lineno}: {node.name} has no docstring" for file, node, has in found if not has], len(found)


def cpp_functions(folder):
    """How many public C++ functions Doxygen found, and how many of them have no comment."""
    members = {}
    for file in folder.glob("*.xml"):
        for member in xml.etree.ElementTree.parse(file).getroot().iter("memberdef"):
            if member.get("kind") == "function" and member.get("prot") == "public":
                members[member.get("id")] = any("".join(member.find(part).itertext()).strip() for part in ("briefdescription", "detaileddescription"))
    return len(members), sum(not has for has in members.values())


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    dead, pages, links = dead_links(folder / "html")
    bare, functions = undocumented(ROOT / "python/astrolith")
    documents = list((ROOT / "docs").glob("*.md"))
    long = [f"docs/{file.name}: above {LONGEST_PAGE} lines" for file in documents if file.read_text(encoding="utf-8").count("\n") > LONGEST_PAGE]
    print("\n".join([*dead, *long, *bare]), end="\n" if dead or long or bare else "")
    print(f"site: {pages} pages, {links} links, {len(dead)} of them dead; {len(long)} of {len(documents)} documents above {LONGEST_PAGE} lines")
    print(f"site: {len(bare)} of {functions} public functions and classes of the Python package have no docstring")
    total, silent = cpp_functions(folder / "xml")
    print(f"site: {silent} of {total} public functions of the C++ headers have no comment of their own or of their group")
    return 1 if dead or long or bare else 0


if __name__ == "__main__":
    sys.exit(main())
