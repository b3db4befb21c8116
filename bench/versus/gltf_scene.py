# SPDX-License-Identifier: Apache-2.0
"""Writes a glTF scene for renderers that read Mitsuba 3's files: gltf_scene.py '{"scene", "folder"}'.

The folder gets "scene.xml" with its meshes (PLY) and textures (PNG). Materials become `principled`: metallic-roughness with its textures, normal
maps, alpha and emission. Their bases are Disney's, brighter than those of nearlight's reader of glTF, which lie below their reflections; so
nearlight, too, renders what is written here. Of lights there are points, of cameras the first. What else a file may have (animation, skins,
extensions of materials, sparse accessors, compressed meshes) ends the program with one line.
"""
import base64
import json
import math
import os
import sys
import urllib.parse
import xml.etree.ElementTree as xml

import numpy as np

LUMENS_PER_WATT = 683      # between the candela of KHR_lights_punctual and W/sr
HEIGHT = 480
EXTENSIONS = {'KHR_lights_punctual'}
COMPONENTS = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3, 'VEC4': 4}
TRIANGLES = 4
WRAPS = {10497: 'repeat', 33648: 'mirror', 33071: 'clamp'}
NEAREST = 9728


class Unsupported(Exception):
    """The scene has something that this file does not convert."""


class Gltf:
    """A file and its buffers."""

    def __init__(self, path):
        self.folder = os.path.dirname(os.path.abspath(path))
        with open(path, encoding='utf-8') as file:
            self.json = json.load(file)
        for name in ('skins', 'animations'):
            if self.json.get(name):
                raise Unsupported(f'no counterpart of {name}')
        unknown = sorted(set(self.json.get('extensionsUsed', ())) - EXTENSIONS)
        if unknown:
            raise Unsupported(f'no counterpart of {", ".join(unknown)}')
        self._buffers = {}

    def __getitem__(self, name):
        return self.json.get(name, [])

    def path(self, uri):
        return os.path.join(self.folder, urllib.parse.unquote(uri))

    def _buffer(self, index):
        if index not in self._buffers:
            uri = self['buffers'][index]['uri']
            if uri.startswith('data:'):
                self._buffers[index] = base64.b64decode(uri.partition(',')[2])
            else:
                with open(self.path(uri), 'rb') as file:
                    self._buffers[index] = file.read()
        return self._buffers[index]

    def array(self, index):
        """The elements of an accessor, one a row. Integers that stand for parts of one are not converted."""
        accessor = self['accessors'][index]
        if 'sparse' in accessor or accessor.get('normalized') or 'bufferView' not in accessor:
            raise Unsupported('no counterpart of accessors that are sparse, normalized or empty')
        view = self['bufferViews'][accessor['bufferView']]
        kind, width = np.dtype(COMPONENTS[accessor['componentType']]), WIDTHS[accessor['type']]
        start = view.get('byteOffset', 0) + accessor.get('byteOffset', 0)
        stride = view.get('byteStride', kind.itemsize * width)
        return np.ndarray((accessor['count'], width), kind, self._buffer(view['buffer']), start, (stride, kind.itemsize))


def local_transform(node):
    if 'matrix' in node:
        return np.array(node['matrix'], dtype=np.float64).reshape(4, 4).T
    x, y, z, w = node.get('rotation', (0, 0, 0, 1))
    transform = np.eye(4)
    transform[:3, :3] = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                                  [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                                  [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    transform[:3, :3] *= np.array(node.get('scale', (1, 1, 1)))
    transform[:3, 3] = node.get('translation', (0, 0, 0))
    return transform


def placed_nodes(gltf):
    """Each node of the scene that the file opens with, and its transform to the world, parents first."""
    def below(index, parent):
        node = gltf['nodes'][index]
        to_world = parent @ local_transform(node)
        yield node, to_world
        for child in node.get('children', ()):
            yield from below(child, to_world)
    for root in gltf['scenes'][gltf.json.get('scene', 0)]['nodes']:
        yield from below(root, np.eye(4))


def texts(values):
    return ' '.join(repr(float(value)) for value in np.ravel(values))


def plugin(parent, tag, kind, name=None, **attributes):
    return xml.SubElement(parent, tag, {'type': kind} | ({'name': name} if name else {}) | attributes)


def value(parent, tag, name, text):
    xml.SubElement(parent, tag, {'name': name, 'value': text})


def transform(parent, matrix):
    xml.SubElement(xml.SubElement(parent, 'transform', {'name': 'to_world'}), 'matrix', {'value': texts(matrix)})


class Textures:
    """Writes textures for Mitsuba, one file for all users of the same channels of an image."""

    def __init__(self, mi, gltf, folder):
        self._mi, self._gltf, self._folder = mi, gltf, folder
        self._pixels, self._files = {}, {}

    def _image(self, index):
        if index not in self._pixels:
            image = self._gltf['images'][index]
            if 'uri' not in image or image['uri'].startswith('data:'):
                raise Unsupported('no counterpart of images inside of buffers')
            pixels = np.array(self._mi.Bitmap(self._gltf.path(image['uri'])))
            if pixels.dtype not in (np.uint8, np.uint16):
                raise Unsupported('no counterpart of images of other than 8 or 16 bits')
            self._pixels[index] = pixels if pixels.ndim == 3 else pixels[..., np.newaxis]
        return self._pixels[index]

    def channels_of(self, info, channels):
        """The channels of a texture's image; a grey image has the same in all colours, and one without alpha is opaque."""
        pixels = self._image(self._gltf['textures'][info['index']]['source'])
        colors = pixels.shape[2] - 1 if pixels.shape[2] in (2, 4) else pixels.shape[2]
        alpha = pixels[..., colors:] if colors < pixels.shape[2] else np.full_like(pixels[..., :1], np.iinfo(pixels.dtype).max)
        rgb = np.broadcast_to(pixels[..., :colors], (*pixels.shape[:2], 3))
        return np.concatenate([rgb, alpha], axis=2)[..., channels]

    def add(self, parent, name, info, channels, is_raw, change=None):
        """A bitmap under a parameter's name. `change` makes other values of those of the image, as parts of one."""
        if info.get('texCoord', 0) != 0:
            raise Unsupported('no counterpart of a second set of texture coordinates')
        key = (info['index'], tuple(channels), change)
        if key not in self._files:
            pixels = self.channels_of(info, channels)
            if change:
                white = np.iinfo(pixels.dtype).max
                pixels = np.round(white * change(pixels / white)).astype(pixels.dtype)
            self._files[key] = f'texture-{len(self._files)}.png'
            self._mi.Bitmap(np.ascontiguousarray(pixels)).write(os.path.join(self._folder, self._files[key]))
        texture = self._gltf['textures'][info['index']]
        sampler = self._gltf['samplers'][texture['sampler']] if 'sampler' in texture else {}
        wraps = {WRAPS[sampler.get(wrap, 10497)] for wrap in ('wrapS', 'wrapT')}
        if len(wraps) > 1:
            raise Unsupported('no counterpart of textures that go on differently along u and v')
        bitmap = plugin(parent, 'texture', 'bitmap', name)
        value(bitmap, 'string', 'filename', self._files[key])
        value(bitmap, 'boolean', 'raw', 'true' if is_raw else 'false')
        value(bitmap, 'string', 'wrap_mode', wraps.pop())
        value(bitmap, 'string', 'filter_type', 'nearest' if sampler.get('magFilter') == NEAREST else 'bilinear')


class Materials:
    """Writes BSDFs, and says what shines."""

    def __init__(self, gltf, textures):
        self._gltf, self._textures = gltf, textures

    def _source(self, index):
        return {} if index is None else self._gltf['materials'][index]

    def radiance(self, index):
        """What the front of a material shines with, or None."""
        source = self._source(index)
        factor = source.get('emissiveFactor', (0, 0, 0))
        if not any(factor):
            return None
        if 'emissiveTexture' in source or source.get('doubleSided'):
            raise Unsupported('no counterpart of materials that shine by a texture or on both sides')
        return factor

    def write(self, parent, index):
        source = self._source(index)
        if index is None:
            value(plugin(plugin(parent, 'bsdf', 'twosided'), 'bsdf', 'diffuse'), 'rgb', 'reflectance', '0.5')
            return
        self._normal_map(self._mask(parent, source), source)

    def _mask(self, parent, source):
        """The parent of what has no holes."""
        mode = source.get('alphaMode', 'OPAQUE')
        if mode == 'OPAQUE':
            return parent
        base = source.get('pbrMetallicRoughness', {})
        factor = base.get('baseColorFactor', (1, 1, 1, 1))[3]
        cutoff = source.get('alphaCutoff', 0.5)

        def opacity(alpha):
            return (factor * alpha >= cutoff) * 1.0 if mode == 'MASK' else factor * alpha
        mask = plugin(parent, 'bsdf', 'mask')
        if 'baseColorTexture' in base:
            self._textures.add(mask, 'opacity', base['baseColorTexture'], [3], True, opacity)
        else:
            value(mask, 'float', 'opacity', repr(float(opacity(1.0))))
        return mask

    def _normal_map(self, parent, source):
        """A surface of both sides, below its normal map if there is one."""
        if 'normalTexture' in source:
            if source['normalTexture'].get('scale', 1) != 1:
                raise Unsupported('no counterpart of the scale of a normal map')
            parent = plugin(parent, 'bsdf', 'normalmap')
            self._textures.add(parent, 'normalmap', source['normalTexture'], [0, 1, 2], True)
        self._principled(plugin(plugin(parent, 'bsdf', 'twosided'), 'bsdf', 'principled'), source.get('pbrMetallicRoughness', {}))

    def _principled(self, bsdf, base):
        factor = base.get('baseColorFactor', (1, 1, 1, 1))[:3]
        if 'baseColorTexture' not in base:
            value(bsdf, 'rgb', 'base_color', texts(factor))
        elif any(part != 1 for part in factor):
            raise Unsupported('no counterpart of a base colour that is a texture times a factor')
        else:
            self._textures.add(bsdf, 'base_color', base['baseColorTexture'], [0, 1, 2], False)
        for name, key, channel in (('roughness', 'roughnessFactor', 1), ('metallic', 'metallicFactor', 2)):
            part = base.get(key, 1)
            if 'metallicRoughnessTexture' not in base or part == 0:
                value(bsdf, 'float', name, repr(float(part)))
            elif part == 1:
                self._textures.add(bsdf, name, base['metallicRoughnessTexture'], [channel], True)
            else:
                raise Unsupported(f'no counterpart of a {name} that is a texture times a factor')


def vertices(gltf, primitive, to_world):
    """Positions, normals and texture coordinates of a primitive in the world, and its faces."""
    if primitive.get('mode', TRIANGLES) != TRIANGLES:
        raise Unsupported('no counterpart of primitives that are not triangles')
    attributes = primitive['attributes']
    if 'COLOR_0' in attributes:
        raise Unsupported('no counterpart of colours of vertices')
    linear = to_world[:3, :3]
    columns = [gltf.array(attributes['POSITION']) @ linear.T + to_world[:3, 3]]
    names = ['x', 'y', 'z']
    if 'NORMAL' in attributes:
        normals = gltf.array(attributes['NORMAL']) @ np.linalg.inv(linear)
        columns.append(normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30))
        names += ['nx', 'ny', 'nz']
    if 'TEXCOORD_0' in attributes:
        columns.append(gltf.array(attributes['TEXCOORD_0']))
        names += ['u', 'v']
    count = len(columns[0])
    faces = gltf.array(primitive['indices']).reshape(-1, 3) if 'indices' in primitive else np.arange(count).reshape(-1, 3)
    return names, np.concatenate(columns, axis=1), faces[:, ::-1] if np.linalg.det(linear) < 0 else faces


def write_ply(file, names, rows, faces):
    header = ['ply', 'format binary_little_endian 1.0', f'element vertex {len(rows)}', *(f'property float {name}' for name in names),
              f'element face {len(faces)}', 'property list uchar int vertex_indices', 'end_header\n']
    packed = np.zeros(len(faces), dtype=[('count', 'u1'), ('corners', '<i4', 3)])
    packed['count'], packed['corners'] = 3, faces
    with open(file, 'wb') as out:
        out.write('\n'.join(header).encode())
        out.write(rows.astype('<f4').tobytes())
        out.write(packed.tobytes())


def add_camera(scene, gltf, node, to_world):
    """glTF's cameras look along -z with +x on the right, Mitsuba's along +z with +x on the left. Scale does not count."""
    camera = gltf['cameras'][node['camera']]
    if camera['type'] != 'perspective':
        raise Unsupported(f'no counterpart of a camera of type {camera["type"]}')
    lens = camera['perspective']
    width = round(HEIGHT * lens.get('aspectRatio', 4 / 3))
    turned = to_world.copy()
    turned[:3, :3] /= np.linalg.norm(turned[:3, :3], axis=0)
    sensor = plugin(scene, 'sensor', 'perspective')
    transform(sensor, turned @ np.diag([-1, 1, -1, 1]))
    value(sensor, 'string', 'fov_axis', 'x')
    value(sensor, 'float', 'fov', repr(2 * math.degrees(math.atan(math.tan(lens['yfov'] / 2) * width / HEIGHT))))
    film = plugin(sensor, 'film', 'hdrfilm')
    value(film, 'integer', 'width', str(width))
    value(film, 'integer', 'height', str(HEIGHT))
    value(film, 'string', 'pixel_format', 'rgb')
    plugin(film, 'rfilter', 'gaussian')
    value(plugin(sensor, 'sampler', 'independent'), 'integer', 'sample_count', '16')


def add_light(scene, light, to_world):
    if light['type'] != 'point':
        raise Unsupported(f'no counterpart of a light of type {light["type"]}')
    intensity = np.array(light.get('color', (1, 1, 1))) * light.get('intensity', 1) / LUMENS_PER_WATT
    emitter = plugin(scene, 'emitter', 'point')
    value(emitter, 'rgb', 'intensity', texts(intensity))
    xml.SubElement(emitter, 'point', {'name': 'position'} | dict(zip('xyz', map(repr, map(float, to_world[:3, 3])))))


def add_mesh(scene, gltf, mesh, to_world, materials, folder):
    for primitive in mesh['primitives']:
        file = f'mesh-{len(scene)}.ply'
        write_ply(os.path.join(folder, file), *vertices(gltf, primitive, to_world))
        shape = plugin(scene, 'shape', 'ply')
        value(shape, 'string', 'filename', file)
        if 'NORMAL' not in primitive['attributes']:
            value(shape, 'boolean', 'face_normals', 'true')
        material = primitive.get('material')
        materials.write(shape, material)
        radiance = materials.radiance(material)
        if radiance:
            value(plugin(shape, 'emitter', 'area'), 'rgb', 'radiance', texts(radiance))


def converted(mi, path, folder):
    """The scene as XML. Its meshes and textures are written to the folder."""
    gltf = Gltf(path)
    materials = Materials(gltf, Textures(mi, gltf, folder))
    lights = gltf.json.get('extensions', {}).get('KHR_lights_punctual', {}).get('lights', [])
    scene = xml.Element('scene', {'version': '3.0.0'})
    value(plugin(scene, 'integrator', 'path'), 'integer', 'max_depth', '-1')
    has_camera = False
    for node, to_world in placed_nodes(gltf):
        if 'camera' in node and not has_camera:
            add_camera(scene, gltf, node, to_world)
            has_camera = True
        if 'mesh' in node:
            add_mesh(scene, gltf, gltf['meshes'][node['mesh']], to_world, materials, folder)
        light = node.get('extensions', {}).get('KHR_lights_punctual')
        if light:
            add_light(scene, lights[light['light']], to_world)
    if not has_camera or not lights:
        raise Unsupported('a glTF file of the race needs a camera and lights, which nearlight would add in its own way')
    return scene


def main():
    request = json.loads(sys.argv[1])
    import mitsuba as mi
    mi.set_variant('scalar_rgb')
    os.makedirs(request['folder'], exist_ok=True)
    try:
        scene = converted(mi, request['scene'], request['folder'])
    except Unsupported as reason:
        sys.exit(str(reason))
    xml.ElementTree(scene).write(os.path.join(request['folder'], 'scene.xml'), encoding='utf-8')


if __name__ == '__main__':
    main()
