"""Text files that are whole or absent."""

import os


def write_text(file: str, text: str, encoding: str = "utf-8") -> None:
    """Write the file beside its place first: whoever reads it meets the old content or the new one."""
    partial = f"{file}.part"
    try:
        with open(partial, "w", encoding=encoding, newline="\n") as stream:
            stream.write(text)
        os.replace(partial, file)
    finally:
        if os.path.exists(partial):
            os.remove(partial)
