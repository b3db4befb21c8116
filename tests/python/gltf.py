# SPDX-License-Identifier: Apache-2.0
"""A glTF file with animations, for tests."""

import base64
import json

import numpy as np


def animated_room(folder):
    """Writes a floor and a wall under a lamp, past which the camera walks in a second; later the lamp rises."""
    data = b""
    views, accessors = [], []

    def add(values, kind):
        nonlocal data
        numbers = np.array(values, np.float32)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": numbers.nbytes})
        accessors.append(
            {"bufferView": len(views) - 1, "componentType": 5126, "count": len(values), "type": kind}
        )
        data += numbers.tobytes()
        return len(accessors) - 1

    def motion(name, node, times, values):
        sampler = {"input": add(times, "SCALAR"), "output": add(values, "VEC3")}
        channel = {"sampler": 0, "target": {"node": node, "path": "translation"}}
        return {"name": name, "samplers": [sampler], "channels": [channel]}

    square = add([(-1, 0, -1), (-1, 0, 1), (1, 0, 1), (-1, 0, -1), (1, 0, 1), (1, 0, -1)], "VEC3")
    turn = 0.5**0.5
    chalk = {
        "pbrMetallicRoughness": {"metallicFactor": 0},
        "extensions": {"KHR_materials_specular": {"specularFactor": 0}},
    }
    root = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0, 1, 2, 3]}],
        "nodes": [
            {"mesh": 0},
            {"mesh": 0, "translation": [0, 1, -1], "rotation": [turn, 0, 0, turn]},
            {"mesh": 1, "translation": [0, 1.5, 0], "scale": [0.2, -0.2, 0.2], "name": "lamp"},
            {"camera": 0, "translation": [-0.5, 1, 3], "name": "eye"},
        ],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "aspectRatio": 1.5, "znear": 0.1}}],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": square}, "material": material}]} for material in (0, 1)
        ],
        "materials": [
            {"doubleSided": True, **chalk},
            {"emissiveFactor": [1, 1, 1], **chalk},
        ],
        "animations": [
            motion("walk", 3, [0, 1], [(-0.5, 1, 3), (0.5, 1, 3)]),
            motion("rise", 2, [1.5, 2], [(0, 1.5, 0), (0, 1.9, 0)]),
        ],
        "accessors": accessors,
        "bufferViews": views,
    }
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    root["buffers"] = [{"byteLength": len(data), "uri": uri}]
    file = folder / "room.gltf"
    file.write_text(json.dumps(root))
    return file
