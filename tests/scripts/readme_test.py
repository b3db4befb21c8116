#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs every command of README.md, on a smaller scale, in a folder with the files that they name.

Called with the folder of the source, the program and a library that stands in for Open Image Denoise.
"""

import json
import os
import pathlib
import re
import shlex
import shutil
import struct
import subprocess
import sys
import tempfile

SOURCE, PROGRAM, DENOISER = (pathlib.Path(argument) for argument in sys.argv[1:4])

SKIPPED = 77  # the exit status that says so

# Values of options that commands of the README have, and options that they get besides.
SMALLER = {"--size": "48x36", "--vpls": "50", "--spp": "1", "--time": "3", "--error": "0.5"}
BESIDES = {
    "render": ["--size 48x36", "--vpls 50"],
    "view": ["--size 48x36", "--vpls 50", "--until-samples 1"],
    "reference": ["--size 48x36"],
    "compare": ["--size 32x24", "--vpls 50,100", "--seeds 2", "--reference-spp 16"]
    + ["--samplers close-range:complete,instant-radiosity"],
    "tune": ["--repeats 1", "--triangles 500", "--dry-run"],
    "bench gather": ["--size 64x64", "--vpls 16", "--repeats 1"],
    "bench build": ["--repeats 1"],
    "bench trace": ["--size 64x64", "--repeats 1"],
    "bench sort": ["--repeats 1", "--count 100000"],
}


def commands_of(text):
    """The commands of nearlight in blocks for a shell, as lists of words."""
    lines = [line for block in re.findall(r"```sh\n(.*?)```", text, re.S) for line in block.splitlines()]
    commands = [shlex.split(line, comments=True) for line in lines]
    return [words[1:] for words in commands if words and pathlib.Path(words[0]).name == "nearlight"]


def smaller(words):
    """The command on a smaller scale."""
    words = [SMALLER.get(before, word) for before, word in zip([None, *words], words)]
    name = " ".join(words[:2]) if words[0] == "bench" else words[0]
    for besides in map(str.split, BESIDES.get(name, [])):
        if besides[0] not in words:
            words += besides
    return words


def make_model(file):
    """A square in glTF, seen by a camera with the name kitchen."""
    square = struct.pack("<12f6H", 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 1, 2, 0, 2, 3)
    text = json.dumps(
        {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0, 1]}],
            "nodes": [{"mesh": 0}, {"camera": 0, "name": "kitchen", "translation": [0.5, 0.5, 2]}],
            "cameras": [{"type": "perspective", "name": "kitchen", "perspective": {"yfov": 0.8, "znear": 0.1}}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
            ],
            "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
            "buffers": [{"byteLength": len(square)}],
        }
    ).encode()
    text += b" " * (-len(text) % 4)
    chunks = [(b"JSON", text), (b"BIN\0", square)]
    body = b"".join(struct.pack("<I", len(data)) + kind + data for kind, data in chunks)
    file.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body)


def make_files(folder):
    """The files that commands of the README name."""
    (folder / "scenes").symlink_to(SOURCE / "scenes")
    (folder / "room.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 4 3 2\n")
    for name in ("model.glb", "flat.glb"):
        make_model(folder / name)


def reason_to_skip(words):
    """Why a command cannot run on this machine; empty if it can."""
    if words[0] != "view":
        return ""
    if not shutil.which("xvfb-run") or not shutil.which("xauth"):
        return "xvfb-run or xauth is missing (Debian: xvfb, xauth)"
    return "" if list(PROGRAM.parent.glob("**/nearlight-viewer.so")) else "the viewer is not built"


def run(words, folder):
    """Runs a command; returns whether it succeeded."""
    command = [*(["xvfb-run", "-a"] if words[0] == "view" else []), PROGRAM, *words]
    environment = os.environ | {"NEARLIGHT_OIDN": str(DENOISER)}
    result = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=300)
    if result.returncode != 0:
        print(f"exit status {result.returncode}:\n{result.stderr}")
    return result.returncode == 0


def main():
    commands = commands_of((SOURCE / "README.md").read_text())
    if len(commands) < 15:
        print(f"README.md has only {len(commands)} commands")
        return 1
    has_device = subprocess.run([PROGRAM, "devices"], capture_output=True, check=False).returncode == 0
    if not has_device and os.environ.get("NEARLIGHT_REQUIRE_DEVICE") != "1":
        print("skipped: no OpenCL device")
        return SKIPPED
    failed = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        make_files(folder)
        for words in commands:
            shown = "nearlight " + shlex.join(words)
            if reason := reason_to_skip(words):
                print(f"skipped: {shown}: {reason}", flush=True)
                continue
            print(shown, flush=True)
            failed += not run(smaller(words), folder)
    print(f"{failed} of {len(commands)} commands failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
