#!/usr/bin/env python3
"""Puts the pictures of a set onto one sheet.

    sheet.py PICTURE ... -o sheet.jpg [--across 10] [--width 160]     needs Pillow (apt install python3-pil)
"""
import argparse

from PIL import Image


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pictures", nargs="+")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--across", type=int, default=10, help="pictures side by side")
    parser.add_argument("--width", type=int, default=160, help="pixels of one picture")
    given = parser.parse_args()
    with Image.open(given.pictures[0]) as first:
        size = (given.width, round(given.width * first.height / first.width))
    rows = -(-len(given.pictures) // given.across)
    sheet = Image.new("RGB", (given.across * size[0], rows * size[1]))
    for number, name in enumerate(given.pictures):
        with Image.open(name) as picture:
            place = (number % given.across * size[0], number // given.across * size[1])
            sheet.paste(picture.convert("RGB").resize(size, Image.LANCZOS), place)
    sheet.save(given.output, quality=85)


if __name__ == "__main__":
    main()
