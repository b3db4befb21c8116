# SPDX-License-Identifier: Apache-2.0
"""Writes a Mitsuba scene for renderers that do not read such files: scene_export.py '{"scene", "out"}'.

The file "out" is an archive of NumPy arrays. Its entry "scene" is the text of a JSON object, in which {"array": name} refers to
another entry:
  camera     to_world (4x4; it looks along +z, +x is on the left), x_fov (degrees), size
  max_edges  of a path, from the camera to a light; null without limit
  meshes     positions, faces, and where there are some normals and uv; material (its number); radiance (RGB) of a lamp
  materials  a kind with its parameters (see material()); a colour is RGB or a texture of linear RGB with its transform of UV
  points     position, intensity (W/sr) of point lights
  sky        a map of linear RGB in Mitsuba's latitudes and longitudes, with to_world; or one RGB; or null
What cannot be written ends the program with one line.
"""
import json
import re
import sys

import numpy as np

DISC_CORNERS = 256


class Unsupported(Exception):
    """The scene has something that this file does not convert."""


class Archive:
    """Arrays under names."""

    def __init__(self):
        self.arrays = {}

    def add(self, array):
        name = f'a{len(self.arrays)}'
        self.arrays[name] = np.ascontiguousarray(array)
        return {'array': name}


def numbers(value):
    return np.asarray(value, dtype=np.float32)


def rgb(value):
    return np.broadcast_to(numbers(value).ravel(), 3).tolist()


def linear(pixels, is_raw):
    """Pixels of a bitmap as linear RGB. Those of 8 bits are kept as in their file: in sRGB, unless they are raw."""
    pixels = np.broadcast_to(pixels[..., :3], (*pixels.shape[:2], 3))
    if pixels.dtype != np.uint8:
        return pixels.astype(np.float32)
    values = pixels.astype(np.float32) / 255
    return values if is_raw else np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


class Parameters:
    """The parameters of a plugin, as mi.traverse() names them, below a prefix. `text` describes the plugin."""

    def __init__(self, values, prefix, text, archive):
        self._values, self._prefix, self._text, self._archive = values, prefix, text, archive

    def get(self, name):
        found = [key for key in (self._prefix + name, f'{self._prefix}{name}.value') if key in self._values]
        if not found:
            raise Unsupported(f'no parameter {name}')
        return self._values[found[0]]

    def number(self, name):
        return float(np.mean(numbers(self.get(name))))

    def color(self, name, default=None):
        """RGB, or a texture. A checkerboard is a texture of four pixels."""
        keys = {key.removeprefix(self._prefix + name + '.') for key in self._values if key.startswith(self._prefix + name)}
        if not keys and default is not None:
            return default
        if 'to_uv' not in keys:
            return rgb(self.get(name))
        is_checkered = 'color0.value' in keys
        if is_checkered:
            first, second = (rgb(self.get(f'{name}.color{i}')) for i in (0, 1))
            pixels = numbers([[first, second], [second, first]])
        else:
            raw = re.search(name + r'(?: =|:) BitmapTexture.*?raw = (\d)', self._text, re.DOTALL)
            pixels = linear(np.array(self.get(name + '.data')), raw is not None and raw.group(1) == '1')
        to_uv = np.array(self.get(name + '.to_uv').matrix, dtype=np.float32).reshape(3, 3)
        return {'texture': self._archive.add(pixels), 'to_uv': to_uv[:2].tolist(), 'is_smooth': not is_checkered}


def material(mi, bsdf, archive):
    """The kind of a BSDF, and its parameters."""
    text = str(bsdf)
    values = {key: value for key, value in mi.traverse(bsdf)}
    return named_material(text, values, '', archive)


def principled(parameters):
    """Metal, or a base under reflections; colour, metalness and roughness may be textures."""
    for name in ('anisotropic', 'clearcoat', 'flatness', 'sheen', 'spec_tint', 'spec_trans'):
        if parameters.color(name) != [0, 0, 0]:
            raise Unsupported(f'no counterpart of the parameter {name} of a principled BSDF')
    amplitude = (0.08 * parameters.number('specular')) ** 0.5
    return {'kind': 'principled', 'color': parameters.color('base_color'), 'metallic': parameters.color('metallic'),
            'roughness': parameters.color('roughness'), 'eta': (1 + amplitude) / (1 - amplitude)}


def named_material(text, values, prefix, archive):
    kind = re.match(r'\w+', text).group()
    parameters = Parameters(values, prefix, text, archive)
    if kind == 'TwoSided':
        inner = re.search(r'brdf\[0\] = ', text)
        return named_material(text[inner.end():], values, prefix + 'brdf_0.', archive)
    if kind == 'Mask':
        inner = re.search(r'nested_bsdf = ', text)
        return {'kind': 'mask', 'opacity': parameters.color('opacity'),
                'inner': named_material(text[inner.end():], values, prefix + 'nested_bsdf.', archive)}
    if kind == 'NormalMap':
        inner = re.search(r'nested_bsdf = ', text)
        return {'kind': 'normal_map', 'normals': parameters.color('normalmap'),
                'inner': named_material(text[inner.end():], values, prefix + 'nested_bsdf.', archive)}
    if kind == 'Principled':
        return principled(parameters)
    if kind == 'SmoothDiffuse':
        return {'kind': 'diffuse', 'reflectance': parameters.color('reflectance')}
    if kind in ('SmoothPlastic', 'RoughPlastic'):
        return {'kind': 'plastic', 'reflectance': parameters.color('diffuse_reflectance'), 'eta': parameters.number('eta'),
                'alpha': parameters.number('alpha') if kind == 'RoughPlastic' else 0.0}
    if kind in ('SmoothConductor', 'RoughConductor'):
        rough = kind == 'RoughConductor'
        return {'kind': 'conductor', 'eta': parameters.color('eta'), 'k': parameters.color('k'),
                'tint': parameters.color('specular_reflectance', [1, 1, 1]),
                'alpha': parameters.number('alpha') if rough else 0.0,
                'distribution': 'beckmann' if rough and 'distribution = beckmann' in text else 'ggx'}
    if kind == 'SmoothDielectric':
        return {'kind': 'dielectric', 'eta': parameters.number('eta')}
    raise Unsupported(f'no counterpart of the BSDF {kind}')


def is_mirrored(to_world):
    return np.linalg.det(np.array(to_world, dtype=np.float64).reshape(4, 4)[:3, :3]) < 0


def disc(to_world):
    turn = np.linspace(0, 2 * np.pi, DISC_CORNERS, endpoint=False)
    corners = np.stack([np.cos(turn), np.sin(turn), 0 * turn, 1 + 0 * turn], axis=1)
    corners = np.concatenate([[[0, 0, 0, 1]], corners]) @ np.array(to_world, dtype=np.float64).T
    last = np.arange(DISC_CORNERS)
    faces = np.stack([0 * last, 1 + last, 1 + (last + 1) % DISC_CORNERS], axis=1)
    return corners[:, :3], faces[:, ::-1] if is_mirrored(to_world) else faces     # lamps shine along their own +z


def mesh(mi, shape, archive):
    to_world = dict(mi.traverse(shape)).get('to_world')
    if shape.is_mesh():
        faces = np.asarray(shape.faces_buffer(), dtype=np.int32).reshape(-1, 3)
        if shape.class_name() == 'Rectangle' and is_mirrored(to_world.matrix):
            faces = faces[:, ::-1]
        written = {'positions': archive.add(numbers(shape.vertex_positions_buffer()).reshape(-1, 3)),
                   'faces': archive.add(faces)}
        if shape.has_vertex_normals():
            written['normals'] = archive.add(numbers(shape.vertex_normals_buffer()).reshape(-1, 3))
        if shape.has_vertex_texcoords():
            written['uv'] = archive.add(numbers(shape.vertex_texcoords_buffer()).reshape(-1, 2))
        return written
    if shape.class_name() != 'Disk':
        raise Unsupported(f'no counterpart of the shape {shape.class_name()}')
    positions, faces = disc(np.array(to_world.matrix).reshape(4, 4))
    return {'positions': archive.add(positions.astype(np.float32)), 'faces': archive.add(faces.astype(np.int32))}


def shapes(mi, scene, archive):
    """All meshes, and the materials that they refer to."""
    meshes, materials, known = [], [], {}
    for shape in scene.shapes():
        key = str(shape.bsdf()) + shape.bsdf().id()
        if key not in known:
            known[key] = len(materials)
            materials.append(material(mi, shape.bsdf(), archive))
        written = mesh(mi, shape, archive) | {'material': known[key]}
        if shape.is_emitter():
            written['radiance'] = rgb(dict(mi.traverse(shape.emitter()))['radiance.value'])
        meshes.append(written)
    return meshes, materials


def lights(mi, scene, archive):
    """Point lights and the sky. Lamps belong to their meshes."""
    points, sky = [], None
    for emitter in scene.emitters():
        values = dict(mi.traverse(emitter))
        kind = emitter.class_name()
        if kind == 'PointLight':
            points.append({'position': numbers(values['position']).ravel().tolist(), 'intensity': rgb(values['intensity.value'])})
        elif kind == 'EnvironmentMapEmitter':
            pixels = numbers(values['data'])[:, 1:-1, :3] * float(values['scale'])     # without the columns that wrap around
            sky = {'texture': archive.add(pixels), 'to_world': np.array(values['to_world'].matrix).reshape(4, 4).tolist()}
        elif kind == 'ConstantBackgroundEmitter':
            sky = rgb(values['radiance.value'])
        elif kind != 'AreaLight':
            raise Unsupported(f'no counterpart of the emitter {kind}')
    return points, sky


def exported(mi, scene):
    archive = Archive()
    meshes, materials = shapes(mi, scene, archive)
    points, sky = lights(mi, scene, archive)
    camera = dict(mi.traverse(scene.sensors()[0]))
    depth = re.search(r'max_depth = (\d+)', str(scene.integrator()))
    edges = int(depth.group(1)) if depth and int(depth.group(1)) < 1 << 30 else None
    description = {'camera': {'to_world': np.array(camera['to_world'].matrix).reshape(4, 4).tolist(), 'x_fov': float(camera['x_fov']),
                              'size': np.array(camera['film.size']).ravel().tolist()},
                   'max_edges': edges, 'meshes': meshes, 'materials': materials, 'points': points, 'sky': sky}
    return archive.arrays | {'scene': np.array(json.dumps(description))}


def main():
    request = json.loads(sys.argv[1])
    import mitsuba as mi
    mi.set_variant('scalar_rgb')
    mi.set_log_level(mi.LogLevel.Error)
    import mitsuba_scene
    try:
        np.savez(request['out'], **exported(mi, mitsuba_scene.loaded(mi, request['scene'])))
    except Unsupported as reason:
        sys.exit(str(reason))


if __name__ == '__main__':
    main()
