"""The table of claims as Markdown: thesis's value, ours, a remark.

    claims_table.py FOLDER                  prints it; FOLDER: what the notebooks claimed
    claims_table.py FOLDER --keep CLAIMS    writes it between the markers <!-- claims --> and <!-- end of claims --> of the
                                            file; rows of notebooks that FOLDER lacks stay
"""
import json
import re
import sys
from pathlib import Path

HEAD = "| notebook | what | thesis | ours | remark |\n|---|---|---|---|---|\n"
REGION = re.compile(r"(<!-- claims -->\n).*?(<!-- end of claims -->)", re.S)


def claimed_rows(folder):
    """Rows by notebook number."""
    rows = {}
    for path in sorted(folder.glob("*.json")):
        for claim in json.loads(path.read_text()):
            row = "| {} | {what} | {thesis} | {ours} | {comment} |\n".format(claim["notebook"][:2], **claim)
            rows.setdefault(claim["notebook"][:2], []).append(row)
    return rows


def kept_rows(file):
    rows = {}
    for row in re.findall(r"^\| \d\d \|.*\n", REGION.search(file.read_text())[0], re.M):
        rows.setdefault(row[2:4], []).append(row)
    return rows


def joined(rows):
    return "".join(row for number in sorted(rows) for row in rows[number])


def write_between_markers(file, table):
    file.write_text(REGION.sub(lambda found: found[1] + "\n" + table + "\n" + found[2], file.read_text()))


def main():
    rows = claimed_rows(Path(sys.argv[1]))
    if sys.argv[2:3] != ["--keep"]:
        print(HEAD + joined(rows), end="")
        return
    claims = Path(sys.argv[3])
    write_between_markers(claims, HEAD + joined(kept_rows(claims) | rows))


if __name__ == "__main__":
    main()
