#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that Blender cuts objects and materials out of nearlight's pictures by their names.

Renders a room whose walls fill the picture, and has Blender's Cryptomatte node make the matte of each name. Blender must
turn each name into the number that the file lists, and the mattes of all names must cover each pixel once. Needs the
Python package bpy; without it prints one line and ends with exit code 77, which ctest counts as skipped.
"""
import argparse
import importlib.util
import json
import os
import re
import struct
import subprocess
import sys
import tempfile

SKIPPED = 77
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCENE = os.path.join(ROOT, 'scenes/cornell-box/scene.xml')
SIZE = (48, 48)
LAYERS = {'CryptoObject': 'cryptomatte_object', 'CryptoMaterial': 'cryptomatte_material'}
TOLERANCE = 1e-4     # Blender's sums of 32-bit floats


def manifests(picture):
    """For each Cryptomatte layer of an EXR file: names, each with its number in hexadecimal digits."""
    with open(picture, 'rb') as file:
        data = file.read()
    texts = {}
    for found in re.finditer(rb'cryptomatte/(\w+)/(name|manifest)\0string\0(.{4})', data, re.S):
        key, what, length = found.groups()
        texts[key, what] = data[found.end():found.end() + struct.unpack('<i', length)[0]].decode()
    return {texts[key, b'name']: json.loads(texts[key, b'manifest']) for key, what in texts if what == b'name'}


def make_compositor(bpy, picture):
    """A scene whose picture is a matte of a file, and the node that chooses which."""
    scene = bpy.context.scene
    tree = bpy.data.node_groups.new('mattes', 'CompositorNodeTree')
    tree.interface.new_socket('Image', in_out='OUTPUT', socket_type='NodeSocketColor')
    scene.compositing_node_group = tree
    node = tree.nodes.new('CompositorNodeCryptomatteV2')
    node.source = 'IMAGE'
    node.image = bpy.data.images.load(picture)
    tree.links.new(node.outputs['Matte'], tree.nodes.new('NodeGroupOutput').inputs[0])
    scene.render.engine = 'CYCLES'     # which needs no graphics card
    scene.cycles.samples = 1
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = 'OPEN_EXR'
    scene.render.image_settings.color_depth = '32'
    return scene, node


def matte(bpy, scene, node, name, file):
    """Blender's matte of a name, a value for each pixel, and the number that it makes of the name."""
    node.matte_id = name
    scene.render.filepath = file
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(file)
    values = image.pixels[:][::4]
    bpy.data.images.remove(image)
    return values, struct.pack('>f', node.entries[0].encoded_hash).hex()


def check_layer(bpy, scene, node, layer, numbers, folder):
    """What is wrong with a layer, one line each."""
    node.layer_name = layer
    wrong, sums, partial = [], [0.0] * (SIZE[0] * SIZE[1]), 0
    for name, number in numbers.items():
        values, blenders_number = matte(bpy, scene, node, name, os.path.join(folder, 'matte.exr'))
        if blenders_number != number:
            wrong.append(f'{layer}: {name} is {number} in the file and {blenders_number} in Blender')
        sums = [total + value for total, value in zip(sums, values)]
        partial += sum(0 < value < 1 for value in values)
    if max(abs(total - 1) for total in sums) > TOLERANCE:
        wrong.append(f'{layer}: mattes cover pixels {min(sums)} to {max(sums)} times')
    if partial == 0:
        wrong.append(f'{layer}: no pixel is covered in part')
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--nearlight', default=os.path.join(ROOT, 'build/release/nearlight'), help='the program')
    program = parser.parse_args().nearlight
    if importlib.util.find_spec('bpy') is None:
        print("skipped: Blender's mattes need the Python package bpy (pip install bpy)")
        return SKIPPED
    import bpy
    with tempfile.TemporaryDirectory() as folder:
        picture = os.path.join(folder, 'mattes.exr')
        subprocess.run([program, 'render', SCENE, '-o', picture, '--size', 'x'.join(map(str, SIZE)), '--spp', '4',
                        '--vpls', '20', '--fov', '30', '--layers', ','.join(LAYERS.values()), '--quiet'], check=True)
        scene, node = make_compositor(bpy, picture)
        found = manifests(picture)
        wrong = [line for layer in LAYERS for line in check_layer(bpy, scene, node, layer, found[layer], folder)]
    print('\n'.join(wrong) or f"Blender {bpy.app.version_string} cuts out {sum(len(found[layer]) for layer in LAYERS)} names")
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
