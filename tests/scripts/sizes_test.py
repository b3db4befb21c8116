#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""No source file is so long that it holds more than one concept. Called with the folder of the source."""

import pathlib
import sys

MAX_LINES = 400
FOLDERS = ["bench", "host", "include", "kernels", "python", "scenes", "scripts", "tests", "viewer"]
SUFFIXES = {".cl", ".cpp", ".h", ".py", ".sh"}


def sources(root):
    """All source files. Those in `scripts` have no suffix."""
    for folder in FOLDERS:
        for file in sorted((root / folder).rglob("*")):
            if file.is_file() and (file.suffix in SUFFIXES or folder == "scripts"):
                yield file


def main():
    root = pathlib.Path(sys.argv[1])
    lines = {file.relative_to(root): file.read_bytes().count(b"\n") for file in sources(root)}
    too_long = [f"{file} has {count} lines" for file, count in lines.items() if count > MAX_LINES]
    print("\n".join(too_long) or f"none of {len(lines)} source files has more than {MAX_LINES} lines")
    return 1 if too_long or len(lines) < 500 else 0


if __name__ == "__main__":
    sys.exit(main())
