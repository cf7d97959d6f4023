"""The list of claims as Markdown: thesis's value, ours, a remark.

    claims_list.py FOLDER                  prints it; FOLDER: what the notebooks claimed
    claims_list.py FOLDER --keep CLAIMS    writes it between the markers <!-- claims --> and <!-- end of claims --> of the
                                            file; claims of notebooks that FOLDER lacks stay
"""
import json
import re
import sys
import textwrap
from pathlib import Path

REGION = re.compile(r"(<!-- claims -->\n).*?(<!-- end of claims -->)", re.S)
CLAIM = re.compile(r"^\*\*(\d\d): .*?(?=^\*\*|^<!--)", re.M | re.S)


def item(name, value):
    return textwrap.fill(f"- {name}: {value}", 120, subsequent_indent="  ", break_on_hyphens=False) + "\n"


def text_of(claim):
    values = [("thesis", claim["thesis"]), ("here", claim["ours"]), ("remark", claim["comment"])]
    return f"**{claim['notebook'][:2]}: {claim['what']}**\n\n" + "".join(item(*v) for v in values if v[1]) + "\n"


def claims_of(folder):
    """Texts by notebook number."""
    texts = {}
    for path in sorted(folder.glob("*.json")):
        for claim in json.loads(path.read_text()):
            texts.setdefault(claim["notebook"][:2], []).append(text_of(claim))
    return texts


def kept_claims(file):
    texts = {}
    for found in CLAIM.finditer(REGION.search(file.read_text())[0]):
        texts.setdefault(found[1], []).append(found[0])
    return texts


def joined(texts):
    return "".join(text for number in sorted(texts) for text in texts[number])


def write_between_markers(file, claims):
    file.write_text(REGION.sub(lambda found: found[1] + "\n" + claims + found[2], file.read_text()))


def main():
    texts = claims_of(Path(sys.argv[1]))
    if sys.argv[2:3] != ["--keep"]:
        print(joined(texts), end="")
        return
    claims = Path(sys.argv[3])
    write_between_markers(claims, joined(kept_claims(claims) | texts))


if __name__ == "__main__":
    main()
