#!/usr/bin/env python3
"""Puts the pictures of a set onto one sheet.

    sheet.py PICTURE ... -o sheet.jpg [--across 10] [--width 160]     needs Pillow (apt install python3-pil)
"""
import argparse

try:
    from PIL import Image
except ImportError:
    raise SystemExit("sheet.py: Pillow is missing; apt install python3-pil, and run it with /usr/bin/python3") from None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pictures", nargs="+")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--across", type=int, default=10, help="pictures side by side")
    parser.add_argument("--width", type=int, default=160, help="pixels of one picture")
    given = parser.parse_args()
    with Image.open(given.pictures[0]) as first:
        size = (given.width, round(given.width * first.height / first.width))
    across = min(given.across, len(given.pictures))
    rows = -(-len(given.pictures) // across)
    sheet = Image.new("RGB", (across * size[0], rows * size[1]))
    for number, name in enumerate(given.pictures):
        with Image.open(name) as picture:
            place = (number % across * size[0], number // across * size[1])
            sheet.paste(picture.convert("RGB").resize(size, Image.LANCZOS), place)
    sheet.save(given.output, quality=85)


if __name__ == "__main__":
    main()
