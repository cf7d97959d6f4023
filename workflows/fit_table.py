#!/usr/bin/env python3
"""Makes the table of the fits that workflows/fits.smk has made: fits.csv, and index.html with a picture of each.

    fit_table.py FOLDER
"""
import argparse
import csv
import html
import json
import pathlib

# column of the table: path in the summary of fit_shape, and the factor to the column's unit
COLUMNS = {
    "metaballs": ("spheres", 1),
    "mean_percent": ("mean_distance", 100),
    "p99_percent": ("p99_distance", 100),
    "base_mean_percent": ("base.mean_distance", 100),
    "similarity": ("similarity", 1),
    "similarity_floor": ("similarity_floor", 1),
    "volume_ratio": ("volume_ratio", 1),
    "components": ("components", 1),
    "genus": ("genus", 1),
    "seconds": ("seconds", 1),
}
HEAD = """<!doctype html><meta charset="utf-8"><title>Fits</title>
<style>body{font:15px/1.5 sans-serif;max-width:1300px;margin:2em auto;padding:0 1em}table{border-collapse:collapse}
td,th{padding:6px 10px;border-bottom:1px solid #ccc;text-align:right}td:first-child,th:first-child{text-align:left}
img{width:320px;display:block}</style>
<h1>Fits</h1>
<p>Distances between the surfaces of target and fit, both ways, are in % of the target's bounding-box diagonal. A name
leads to the report, on which target and fit turn together.</p>
"""


def figure(summary, path):
    for name in path.split("."):
        summary = summary.get(name) if isinstance(summary, dict) else None
    return summary


def rows(folder):
    """(name, figures by column, message) of each model; the figures are empty where the fit failed."""
    for message in sorted((folder / "messages").glob("*.txt")):
        summary_file = folder / "summaries" / f"{message.stem}.json"
        words = message.read_text(encoding="utf-8", errors="replace").strip()
        if not summary_file.exists():
            yield message.stem, {}, words.splitlines()[-1] if words else "failed without a word"
            continue
        summary = json.loads(summary_file.read_text())
        figures = {column: figure(summary, path) for column, (path, _) in COLUMNS.items()}
        yield message.stem, {c: v if v is None else v * COLUMNS[c][1] for c, v in figures.items()}, words


def shown(value):
    return "" if value is None else f"{value:.4g}"


def page(table):
    text = HEAD + "<table><tr><th>model</th>" + "".join(f"<th>{c.replace('_', ' ')}</th>" for c in COLUMNS) + "</tr>\n"
    for name, figures, message in table:
        report, label = f"reports/{html.escape(name, quote=True)}", html.escape(name)
        if not figures:
            text += f"<tr><td>{label}</td><td colspan='{len(COLUMNS)}'>{html.escape(message)}</td></tr>\n"
            continue
        picture = f"<a href='{report}/index.html'><img src='{report}/target_and_fit.png' alt='target and fit'>{label}</a>"
        text += f"<tr><td>{picture}</td>" + "".join(f"<td>{shown(figures[c])}</td>" for c in COLUMNS) + "</tr>\n"
    return text + "</table>\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    folder = parser.parse_args().folder
    table = list(rows(folder))
    with open(folder / "fits.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["model", *COLUMNS, "message"])
        for name, figures, message in table:
            writer.writerow([name, *(figures.get(column) for column in COLUMNS), message])
    (folder / "index.html").write_text(page(table), encoding="utf-8")
    failed = sum(not figures for _, figures, _ in table)
    print(f"{folder}/index.html: {len(table)} models, {failed} could not be fitted")


if __name__ == "__main__":
    main()
