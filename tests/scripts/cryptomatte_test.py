#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reads the mattes of rendered EXR files by the rules of Cryptomatte, with a reader of its own, and compares
them with pictures of single objects.

Called with the program and a library that stands in for Open Image Denoise.
"""

import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

PROGRAM, DENOISER = sys.argv[1:3]
SKIPPED = 77  # the exit status that says so

CAMERA = """<integrator type="path"><integer name="max_depth" value="3"/></integrator>
<sensor type="perspective"><float name="fov" value="50"/>
<transform name="to_world"><lookat origin="0, -4, 2" target="0, 0, 0.3" up="0, 0, 1"/></transform>
<film type="hdrfilm"><integer name="width" value="70"/><integer name="height" value="50"/>
<rfilter type="gaussian"/></film></sensor>
<emitter type="constant"/>
<bsdf type="diffuse" id="clay"/>"""
BALL = """<shape type="sphere" id="ball &quot;ä&quot;"><point name="center" x="-0.4" y="-1" z="0.6"/>
<float name="radius" value="0.4"/><ref id="clay"/></shape>"""
REST = """<shape type="rectangle" id="floor"><bsdf type="diffuse"/></shape>
<shape type="cube"><transform name="to_world"><scale value="0.3"/><translate x="0.5" y="0.4" z="0.3"/></transform>
<ref id="clay"/></shape>
<shape type="rectangle" id="hidden"><transform name="to_world"><translate z="-9"/></transform></shape>"""
BALL_NAME = 'ball "ä"'


def terminated(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def read_header(data):
    """The attributes of an EXR file of scan lines, as bytes, and where they end."""
    assert struct.unpack_from("<I", data)[0] == 20000630
    assert data[4] == 2 and data[5] & 0x1A == 0, "neither tiles, nor deep data, nor several parts"
    attributes, at = {}, 8
    while data[at]:
        name, at = terminated(data, at)
        _, at = terminated(data, at)
        size = struct.unpack_from("<I", data, at)[0]
        attributes[name] = data[at + 4 : at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def channels_of(attribute):
    """Names and formats of the channels, in the order of the data."""
    channels, at = [], 0
    while attribute[at]:
        name, at = terminated(attribute, at)
        channels.append((name, {1: "e", 2: "f"}[struct.unpack_from("<I", attribute, at)[0]]))
        at += 16
    return channels


def unzipped(data):
    """Undoes the compression by zip, whose bytes are differences, the even ones before the odd ones."""
    data = bytearray(zlib.decompress(data))
    for i in range(1, len(data)):
        data[i] = (data[i - 1] + data[i] - 128) & 255
    half = (len(data) + 1) // 2
    result = bytearray(len(data))
    result[0::2], result[1::2] = data[:half], data[half:]
    return bytes(result)


class Picture:
    """An EXR file: `channels` has the bytes of four a value, row by row, as unsigned numbers for mattes."""

    def __init__(self, file):
        data = pathlib.Path(file).read_bytes()
        self.attributes, at = read_header(data)
        left, top, right, bottom = struct.unpack("<4i", self.attributes["dataWindow"])
        self.width, self.height = right - left + 1, bottom - top + 1
        compression = self.attributes["compression"][0]
        rows_together = {0: 1, 3: 16}[compression]
        layout = channels_of(self.attributes["channels"])
        self.channels = {name: [] for name, _ in layout}
        chunks = -(-self.height // rows_together)
        for offset in struct.unpack_from(f"<{chunks}Q", data, at):
            y, size = struct.unpack_from("<iI", data, offset)
            rows = min(rows_together, bottom + 1 - y)
            row_bytes = self.width * sum(struct.calcsize(kind) for _, kind in layout)
            body = data[offset + 8 : offset + 8 + size]
            body = body if size == rows * row_bytes else unzipped(body)
            place = 0
            for _ in range(rows):
                for name, kind in layout:
                    kind = "I" if name.startswith("Crypto") and name[-1] in "RB" else kind
                    self.channels[name] += struct.unpack_from(f"<{self.width}{kind}", body, place)
                    place += self.width * struct.calcsize(kind)

    def text(self, name):
        return self.attributes[name].decode()

    def layer(self, file_name):
        """The names of a layer's mattes with their identifiers, from the manifest."""
        key = f"cryptomatte/{identifier(file_name):08x}"[: len("cryptomatte/") + 7]
        assert self.text(f"{key}/name") == file_name
        assert self.text(f"{key}/hash") == "MurmurHash3_32"
        assert self.text(f"{key}/conversion") == "uint32_to_float32"
        manifest = json.loads(self.text(f"{key}/manifest"))
        for name, digits in manifest.items():
            assert int(digits, 16) == identifier(name), name
        return {name: int(digits, 16) for name, digits in manifest.items()}

    def matte(self, file_name, wanted):
        """The coverage of an identifier in each pixel; of all together if it is None."""
        matte = [0.0] * (self.width * self.height)
        for part in range(3):
            for rank, coverage in ("RG", "BA"):
                ranks = self.channels[f"{file_name}{part:02}.{rank}"]
                covered = self.channels[f"{file_name}{part:02}.{coverage}"]
                for pixel, (name, share) in enumerate(zip(ranks, covered)):
                    matte[pixel] += share if wanted in (None, name) else 0.0
        return matte


def rotated(word, bits):
    return (word << bits | word >> 32 - bits) & 0xFFFFFFFF


def murmur3(text):
    """MurmurHash3_x86_32 with the seed 0."""
    data, state = text.encode(), 0
    for i in range(0, len(data), 4):
        part = data[i : i + 4]
        state ^= rotated(int.from_bytes(part, "little") * 0xCC9E2D51 & 0xFFFFFFFF, 15) * 0x1B873593 & 0xFFFFFFFF
        if len(part) == 4:
            state = (rotated(state, 13) * 5 + 0xE6546B64) & 0xFFFFFFFF
    state ^= len(data)
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35), (16, 1)):
        state = (state ^ state >> shift) * factor & 0xFFFFFFFF
    return state


def identifier(name):
    """The bits of the float that stands for a name, whose exponent is that of a normal number."""
    bits = murmur3(name)
    return bits & 0x807FFFFF | min(max(bits >> 23 & 255, 1), 254) << 23


def render(scene, output, *options, **variables):
    command = [PROGRAM, "render", scene, "-o", output, "--vpls", "30", "--spp", "5", "--exr-precision", "float"]
    done = subprocess.run([*command, *options], env={**os.environ, **variables}, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return Picture(output)


def expect_equal(found, expected, what):
    assert len(found) == len(expected), what
    for pixel, (a, b) in enumerate(zip(found, expected)):
        assert abs(a - b) < 1e-5, f"{what}: {a} instead of {b} at pixel {pixel}"


def check(folder):
    (folder / "all.xml").write_text(f'<scene version="3.0.0">{CAMERA}{BALL}{REST}</scene>', "utf-8")
    (folder / "ball.xml").write_text(f'<scene version="3.0.0">{CAMERA}{BALL}</scene>', "utf-8")
    layers = ["--layers", "A,cryptomatte_object,cryptomatte_material"]
    whole = render(folder / "all.xml", folder / "all.exr", *layers)
    objects = whole.layer("CryptoObject")
    materials = whole.layer("CryptoMaterial")
    assert sorted(objects) == sorted([BALL_NAME, "floor", "cube 3", "hidden"]), objects
    assert sorted(materials) == sorted(["clay", "diffuse 2", "default"]), materials
    alpha = whole.channels["A"]
    expect_equal(whole.matte("CryptoObject", None), alpha, "all objects")
    expect_equal(whole.matte("CryptoMaterial", None), alpha, "all materials")

    alone = render(folder / "ball.xml", folder / "ball.exr", "--layers", "A", "--splat", "off")
    ball = whole.matte("CryptoObject", objects[BALL_NAME])
    expect_equal(ball, alone.channels["A"], "the ball")
    assert sum(1 for share in ball if 0 < share < 1) > 20 and max(ball) == 1
    cube = whole.matte("CryptoObject", objects["cube 3"])
    assert max(cube) == 1 and max(whole.matte("CryptoObject", objects["hidden"])) == 0
    clay = [a + b for a, b in zip(ball, cube)]
    expect_equal(whole.matte("CryptoMaterial", materials["clay"]), clay, "clay")

    names = [name for name in whole.channels if name.startswith("Crypto")]
    assert len(names) == 24

    def expect_same_mattes(other, what):
        for name in names:
            assert other.channels[name] == whole.channels[name], f"{what}: {name}"

    expect_same_mattes(
        render(folder / "all.xml", folder / "zip.exr", *layers, "--exr-compression", "none"), "uncompressed"
    )
    expect_same_mattes(
        render(folder / "all.xml", folder / "two.exr", *layers, "--device", "all", POCL_DEVICES="pthread pthread"),
        "two devices",
    )
    denoised = render(folder / "all.xml", folder / "raw.exr", layers[0], layers[1] + ",raw", "--denoise", NEARLIGHT_OIDN=DENOISER)
    expect_same_mattes(denoised, "denoised")
    assert denoised.channels["raw.R"] == whole.channels["R"]

    crop = render(folder / "all.xml", folder / "crop.exr", *layers, "--crop", "31x20+13+9")
    for name in names:
        part = [whole.channels[name][(y + 9) * 70 + 13 + x] for y in range(20) for x in range(31)]
        assert crop.channels[name] == part, f"crop: {name}"

    passes = render(folder / "all.xml", folder / "passes.exr", *layers, "--passes", "3")
    expect_equal(passes.matte("CryptoObject", None), passes.channels["A"], "three passes")
    assert passes.channels["CryptoObject00.G"] != whole.channels["CryptoObject00.G"]


def main():
    has_device = subprocess.run([PROGRAM, "devices"], capture_output=True).returncode == 0
    if not has_device and os.environ.get("NEARLIGHT_REQUIRE_DEVICE") != "1":
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as folder:
        check(pathlib.Path(folder))


if __name__ == "__main__":
    main()
