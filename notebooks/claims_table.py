"""Prints the table of claims as Markdown: claims_table.py FOLDER, the folder of what the notebooks claimed."""
import json
import sys
from pathlib import Path

print("| notebook | what | thesis | ours | |\n|---|---|---|---|---|")
for path in sorted(Path(sys.argv[1]).glob("*.json")):
    for claim in json.loads(path.read_text()):
        print("| {} | {what} | {thesis} | {ours} | {comment} |".format(claim["notebook"][:2], **claim))
