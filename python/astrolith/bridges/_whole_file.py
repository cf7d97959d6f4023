"""Files that are whole or absent."""

import os


def write_bytes(file: str, content: bytes) -> None:
    """Write the file beside its place first: whoever reads it meets the old content or the new one."""
    partial = f"{file}.part"
    try:
        with open(partial, "wb") as stream:
            stream.write(content)
        os.replace(partial, file)
    finally:
        if os.path.exists(partial):
            os.remove(partial)


def write_text(file: str, text: str, encoding: str = "utf-8") -> None:
    """Write a text file as :func:`write_bytes` does."""
    write_bytes(file, text.encode(encoding))
