"""Rows of Markdown tables that fit into the documents' lines: what is too long for a row stands below the table."""
import re
import textwrap

LONGEST_LINE = 120  # characters; scripts/check_docs.py holds documents to it


def row(cells):
    return "| " + " | ".join(cells) + " |"


def leading_clauses(text, longest):
    """As many clauses from the text's start as `longest` characters hold, or as many words where they hold no clause;
    commas, colons and semicolons outside `code` part clauses."""
    for pattern in (r"`[^`]*`|[,:;](?= )", r"`[^`]*`| "):
        ends = [found.start() for found in re.finditer(pattern, text) if found[0][0] != "`"]
        if fitting := [end for end in ends if end <= longest]:
            return text[: fitting[-1]]
    return text


def narrow_table(rows, shortened):
    """Rows of a table as text, and below it in full what column `shortened` of rows that were too long said."""
    lines, notes = [], []
    for cells in rows:
        if len(row(cells)) > LONGEST_LINE:
            notes.append(f"- {cells[0]}: {cells[shortened]}.")
            room = LONGEST_LINE - len(row(cells)) + len(cells[shortened]) - len(" ...")
            cells = list(cells)
            cells[shortened] = leading_clauses(cells[shortened], room) + " ..."
        lines.append(row(cells))
    text = "\n".join(lines) + "\n"
    if notes:
        text += "\nIn full:\n\n" + "".join(
            textwrap.fill(note, LONGEST_LINE, subsequent_indent="  ", break_on_hyphens=False, break_long_words=False) + "\n"
            for note in notes)
    return text
