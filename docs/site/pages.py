"""Gathers what scripts/site.sh builds a site of: pages.py FOLDER

FOLDER/pages has the documents, whose links to other files of the repository lead to copies of these, the page of the
browser where it has been built, and one page for each part of the Python package. FOLDER/headers has the installed C++
headers, whose comments are marked for Doxygen.
"""

import ast
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Documents outside docs/, by the name of their page.
OTHERS = {"index": "README.md", "changelog": "CHANGELOG.md", "contributing": "CONTRIBUTING.md", "security": "SECURITY.md", "library": "library/SOURCES.md"}
FOLDERS = {"notebooks": "The notebooks", "synthesis/examples": "The examples, as files"}
API = {"synthesis": "Python: synthesis and measurement", "estimation": "Python: fits", "bridges": "Python: bridges to other packages"}
HEADERS = ["numerics", "recipe", "geometry", "gravity", "descriptor", "synthesis", "estimation", "cuda"]
LINK = re.compile(r"(\]\()([^)\s#]+)((?:#[^)\s]*)?\))|^(\[[^\]]+\]: )([^\s#]+)(.*)$", re.M)
FIRST_SCREEN = '<iframe class="astrolith-page" src="page.html" title="The page that makes bodies"></iframe>\n\n'
NO_PAGE = "*The page that makes bodies in the browser was not built with this site (`scripts/web.sh build`).*\n\n"


def page_name(path):
    """The page that a file or folder of the repository has on the site; None where it has none."""
    name = path.relative_to(ROOT).as_posix()
    for page, other in OTHERS.items():
        if name == other:
            return f"{page}.md"
    if name in FOLDERS:
        return name.replace("/", "_") + ".md"
    return path.name if path.parent == ROOT / "docs" else None


def title_of(document):
    """The heading of a document of docs/; its name where there is none of this name."""
    file = ROOT / "docs" / document
    return file.read_text(encoding="utf-8").split("\n", 1)[0].removeprefix("# ") if file.exists() else document


class Pages:
    """The folder of pages, and what its links lead to."""

    def __init__(self, folder):
        self.folder = folder
        shutil.copytree(ROOT / "docs/figures", folder / "figures")

    def copied(self, path):
        """Where the copy of a file of the repository lies in the folder."""
        executed = ROOT / "build/notebooks/executed" / path.with_suffix(".html").name
        if path.suffix == ".ipynb" and executed.exists():
            path, place = executed, pathlib.Path("files/notebooks") / executed.name
        else:
            place = pathlib.Path("files") / path.relative_to(ROOT)
        (self.folder / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, self.folder / place)
        return place.as_posix()

    def linked(self, text, folder):
        """The text of a document of a folder, with links as they are on the site."""

        def link(match):
            before, address, after = match.groups()[:3] if match[1] else match.groups()[3:]
            path = (folder / address).resolve()
            if re.match(r"[a-z]+:", address) or not path.exists():
                return match[0]
            if path == ROOT / "docs/figures":
                return before + "gallery.md" + after
            if path.is_relative_to(ROOT / "docs/figures"):
                return before + path.relative_to(ROOT / "docs").as_posix() + after
            return before + (page_name(path) or self.copied(path)) + after

        # A link that names a document's file gets the document's title.
        text = re.sub(r"\[(?:docs/)?(\w+\.md)\](?=\()", lambda match: f"[{title_of(match[1])}]", text)
        return LINK.sub(link, text)

    def write(self, page, text):
        """Writes a page of Markdown."""
        (self.folder / page).write_text(text, encoding="utf-8")


def list_of(pages, name, title):
    """A page of links to the files of a folder, each with what it says of itself."""
    rows = []
    for file in sorted((ROOT / name).glob("[0-9a-z]*.ipynb" if name == "notebooks" else "*.json")):
        text = file.read_text(encoding="utf-8")
        said = re.search(r'"# (.+?)(?:\\n)?"' if name == "notebooks" else r'"description": "((?:[^"\\]|\\.)*)"', text)
        words = said[1].replace("|", "\\|") if said else ""
        rows.append(f"| [`{file.stem}`]({pages.copied(file)}) | {words} |")
    return "\n".join([f"# {title}", "", "| file | what it shows |", "|---|---|", *rows, ""])


def public_names(module):
    """The names that a module of the Python package has for everyone."""
    file = ROOT / f"python/astrolith/{module}"
    source = (file / "__init__.py" if file.is_dir() else file.with_suffix(".py")).read_text(encoding="utf-8")
    return next(
        ast.literal_eval(node.value) for node in ast.parse(source).body if isinstance(node, ast.Assign) and node.targets[0].id == "__all__"
    )


def escaped(comment):
    """A comment's words, of which Doxygen takes none for a command."""
    return re.sub(r"([\\@#<>%&\"$]|^\.|(?<= )\.)", r"\\\1", comment)


def marked(comment, indent):
    """A comment's lines as Doxygen reads them; indented ones are code."""
    lines, code = [], False
    for line in comment:
        is_code = line.startswith("   ") or (code and not line.strip())
        if is_code != code:
            lines.append("\\verbatim" if is_code else "\\endverbatim")
            code = is_code
        lines.append(line if is_code else escaped(line.strip()))
    return [f"{indent}/// {line}".rstrip() for line in lines + ["\\endverbatim"] * code]


def statements(lines, indent):
    """How many declarations of one depth these lines hold; 0 where braces do not close."""
    text = "\n".join(re.sub(r"//.*", "", line) for line in lines)
    if text.count("{") != text.count("}") or text.count("(") != text.count(")"):
        return 0
    return sum(1 for line in lines if re.match(indent + r"\S", line) and re.search(r"[;}]\s*(//.*)?$", line))


def for_doxygen(text):
    """A header whose comments are marked. A comment holds for all declarations up to the next blank line or comment."""
    lines, result, i = text.split("\n"), [], 0
    while i < len(lines):
        start = re.match(r"( *)//(?!/)", lines[i])
        if not start:
            trailing = re.match(r"( *[^/}#\s][^/]*[;,{)] *)// ?(.*)$", lines[i])
            forward = re.match(r" *(struct|class|enum|namespace) [^{]*;", lines[i])
            result.append(f"{trailing[1]}///< {escaped(trailing[2])}" if trailing and not forward else lines[i])
            i += 1
            continue
        indent, first = start[1], i
        while i < len(lines) and lines[i].startswith(f"{indent}//"):
            i += 1
        comment = [line[len(indent) + 2 :].removeprefix(" ") for line in lines[first:i]]
        if first == 0:
            result += ["/// \\file", *marked(comment, "")]
            continue
        end = i
        while end < len(lines) and lines[end].startswith(indent) and lines[end].strip() and not lines[end].startswith(f"{indent}//"):
            end += 1
        if end == i:
            result += lines[first:i]  # a comment of no declaration
        elif statements(lines[i:end], indent) > 1:
            result += [*marked(comment, indent), f"{indent}///@{{", *for_doxygen("\n".join(["", *lines[i:end]])).split("\n")[1:], f"{indent}///@}}"]
            i = end
        else:
            result += marked(comment, indent)
    return "\n".join(result)


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    for part in ("pages", "headers", "html", "xml"):
        shutil.rmtree(folder / part, ignore_errors=True)
    pages = Pages(folder / "pages")
    for file in (ROOT / "docs").glob("*.json"):
        shutil.copy(file, folder / "pages")
    for file in (ROOT / "docs").glob("*.md"):
        pages.write(file.name, pages.linked(file.read_text(encoding="utf-8"), file.parent))
    for page, other in OTHERS.items():
        text = pages.linked((ROOT / other).read_text(encoding="utf-8"), (ROOT / other).parent)
        if page == "index":
            heading, rest = text.split("\n\n", 1)
            built = ROOT / "build/web/page.html"
            if built.exists():
                shutil.copy(built, folder / "pages/page.html")
            text = f"---\nhide: [navigation, toc]\n---\n\n{heading}\n\n{FIRST_SCREEN if built.exists() else NO_PAGE}{rest}"
            text += "\nThe public headers of the C++ libraries have [a reference of their own](cpp/index.html).\n"
            print("site: the first screen is " + ("the page of the browser" if built.exists() else "without the page of the browser: scripts/web.sh build makes it"))
        pages.write(f"{page}.md", text)
    for name, title in FOLDERS.items():
        pages.write(name.replace("/", "_") + ".md", list_of(pages, name, title))
    for module, title in API.items():
        package = "astrolith.bridges" if module == "bridges" else "astrolith"  # as they are called
        names = "".join(f"::: {package}.{name}\n\n" for name in sorted(public_names(module), key=str.lower) if name[0] != "_")
        pages.write(f"api_{module}.md", f"# {title}\n\n{names}")
    for file in ("site.css", "formulas.js", "iframe-worker.js"):
        shutil.copy(ROOT / "docs/site" / file, folder / "pages")
    katex = pathlib.Path("/usr/share/javascript/katex")
    shutil.copytree(katex, folder / "pages/katex", ignore=shutil.ignore_patterns("*.mjs", "*.ttf", "*.woff", "katex.js", "katex.css"))
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", *HEADERS], check=True, capture_output=True, text=True).stdout.split("\n")
    for name in listed:
        if name.endswith(".h") and not name.endswith("_internal.h"):
            (folder / "headers" / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / "headers" / name).write_text(for_doxygen((ROOT / name).read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
