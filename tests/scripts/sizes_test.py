#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""No source file is so long that it holds more than one concept. Called with the folder of the source."""

import pathlib
import sys

MAX_LINES = 400
FOLDERS = ["bench", "host", "include", "kernels", "python", "scenes", "scripts", "tests", "viewer"]
SUFFIXES = {".cl", ".cpp", ".h", ".py", ".sh", ""}  # scripts have none
# Stubs list everything that the Python module has.
LONG = {"python/nearlight/_core.pyi"}


def main():
    source = pathlib.Path(sys.argv[1])
    too_long = []
    count = 0
    for folder in FOLDERS:
        for file in sorted((source / folder).rglob("*")):
            name = file.relative_to(source).as_posix()
            is_data = "/corpus/" in name or "/shared/" in name and not name.startswith("kernels/")
            if not file.is_file() or file.suffix not in SUFFIXES or name in LONG or is_data:
                continue
            count += 1
            lines = file.read_bytes().count(b"\n")
            if lines > MAX_LINES:
                too_long.append(f"{name} has {lines} lines")
    print("\n".join(too_long) or f"none of {count} source files has more than {MAX_LINES} lines")
    return 1 if too_long or count < 500 else 0


if __name__ == "__main__":
    sys.exit(main())
