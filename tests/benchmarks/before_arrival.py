#!/usr/bin/env python3
"""What is known of a body before it is seen, drawn many times, and where the body itself then lies.

    before_arrival.py build/release/bin --truth bennu --diameter 492+-20 --axes 1.15:1.07:1+-0.05 --density 1190 --period 4.296 --draws 24

The truth is a body of library/, which is left out of the population. Each draw has the ground of another body
(--details relief). Slopes are those of the vertices against gravity and rotation. The last column is the share of the draws
below the truth: it lies within the central 90 % where this is .05 to .95.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

import numpy as np

LIBRARY = pathlib.Path(__file__).resolve().parent.parent.parent / "library"


def slopes(ply):
    """The slopes of a mesh's vertices, degrees."""
    head, body = ply.read_bytes().split(b"end_header\n", 1)
    kinds = {"float": "<f4", "double": "<f8", "uchar": "u1", "int": "<i4", "uint": "<u4"}
    columns, count, inside = [], 0, False
    for line in head.decode().splitlines():
        words = line.split()
        if words[:1] == ["element"]:
            inside = words[1] == "vertex"
            count = int(words[2]) if inside else count
        elif words[:1] == ["property"] and inside:
            columns.append((words[2], kinds[words[1]]))
    return np.frombuffer(body, np.dtype(columns), count)["slope_deg"]


def figures(synth, folder, recipe, options, arguments):
    mesh, summary = folder / "body.ply", folder / "summary.json"
    gravity = ["--gravity", arguments.density, arguments.period]
    subprocess.run([synth, recipe, "-o", mesh, "--summary", summary, "--resolution", "64", "--device", "cpu", "--min-component", "0.001",
                    "--quiet", *gravity, *options], check=True)  # fmt: skip
    found = json.loads(summary.read_text())["gravity"]
    slope = slopes(mesh)
    return {
        "slope, mean (degrees)": float(slope.mean()),
        "slope, 90th percentile": float(np.quantile(slope, 0.9)),
        "share below 10 degrees": float((slope < 10).mean()),
        "effective gravity, least (um/s2)": 1e6 * found["effective_gravity_m_s2"]["min"],
        "effective gravity, greatest": 1e6 * found["effective_gravity_m_s2"]["max"],
        "escape speed, least (mm/s)": 1e3 * found["escape_speed_m_s"]["min"],
        "elevation, range (m)": found["elevation_m"]["max"] - found["elevation_m"]["min"],
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path)
    for name in ("truth", "diameter", "axes", "density", "period"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--draws", type=int, default=100)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        others = [file for file in sorted(LIBRARY.glob("*.astro")) if file.stem != arguments.truth]
        # The full paths of recipes, whose ground is laid from where they are.
        population = folder / "others.astro"
        known = json.loads((LIBRARY / "bodies.json").read_text())["bodies"]
        rows = [f"{b['name']},{b['source']},{b.get('class', '')}" for b in known]
        (folder / "table.csv").write_text("\n".join(["name,source,class", *rows]) + "\n")
        subprocess.run([arguments.programs / "fit_population", *others, "-o", population, "--unit", "m", "--table", folder / "table.csv",
                        "--quiet"], check=True)  # fmt: skip
        conditions = ["--diameter", arguments.diameter, "--axes", arguments.axes, "--details", "relief"]
        draws = [figures(arguments.programs / "synth", folder, population, [*conditions, "--seed", str(k)], arguments)
                 for k in range(arguments.draws)]  # fmt: skip
        truth = figures(arguments.programs / "synth", folder, LIBRARY / f"{arguments.truth}.astro", [], arguments)
    print(f"{'':34s}{'5 %':>9s}{'median':>9s}{'95 %':>9s}{arguments.truth:>12s}{'below':>8s}")
    for name, value in truth.items():
        drawn = np.array([draw[name] for draw in draws])
        low, middle, high = np.quantile(drawn, (0.05, 0.5, 0.95))
        print(f"{name:34s}{low:9.3g}{middle:9.3g}{high:9.3g}{value:12.3g}{(drawn < value).mean():8.2f}")


if __name__ == "__main__":
    main()
