# SPDX-License-Identifier: Apache-2.0
"""Builds a scene in Blender from what scene_export.py wrote. Its axes stay those of the file."""
import json
import math

import bpy
from mathutils import Matrix
import numpy as np


class Archive:
    """The exported scene: its description, and images of its textures."""

    def __init__(self, file):
        self._arrays = np.load(file)
        self._images = {}
        self.description = json.loads(str(self._arrays['scene']))

    def array(self, reference):
        return self._arrays[reference['array']]

    def image(self, reference, upside_down=False):
        """A linear image, whose first row is at v = 0."""
        name = reference['array']
        if name not in self._images:
            pixels = self._arrays[name][::-1] if upside_down else self._arrays[name]
            height, width, _ = pixels.shape
            image = bpy.data.images.new(name, width, height, float_buffer=True, is_data=True)
            image.pixels.foreach_set(np.concatenate([pixels, np.ones((height, width, 1))], axis=2).astype(np.float32).ravel())
            self._images[name] = image
        return self._images[name]


def normal_reflectance(eta, k):
    """Of a metal at normal incidence. Mitsuba's perfect mirror has the index 0."""
    return ((eta - 1) ** 2 + k ** 2) / ((eta + 1) ** 2 + k ** 2)


def mean_fresnel(eta):
    """What a smooth surface of a dielectric reflects of light from all sides, outside."""
    cosine = (np.arange(4096) + 0.5) / 4096
    inside = np.sqrt(1 - (1 - cosine ** 2) / eta ** 2)
    across, along = (cosine - eta * inside) / (cosine + eta * inside), (eta * cosine - inside) / (eta * cosine + inside)
    return float(np.mean((across ** 2 + along ** 2) * cosine))


class Nodes:
    """The node tree of a material or of the world."""

    def __init__(self, tree, archive):
        self._tree, self._archive = tree, archive
        self._normal = None      # the output of the normal map that what is added lies under
        tree.nodes.clear()

    def add(self, kind, inputs=None, **properties):
        """A node; each input is a value, or an output of another node."""
        node = self._tree.nodes.new(kind)
        for name, value in properties.items():
            setattr(node, name, value)
        for name, value in (inputs or {}).items():
            if isinstance(value, bpy.types.NodeSocket):
                self._tree.links.new(value, node.inputs[name])
            else:
                node.inputs[name].default_value = value
        return node

    def color(self, color):
        """RGB, or the output of a texture."""
        if isinstance(color, list):
            return (*color, 1.0)
        uv = self.add('ShaderNodeVectorMath', {0: self.add('ShaderNodeUVMap').outputs[0], 1: (0, 0, 1)}, operation='ADD').outputs[0]
        row = [self.add('ShaderNodeVectorMath', {0: uv, 1: tuple(row)}, operation='DOT_PRODUCT').outputs['Value']
               for row in color['to_uv']]
        place = self.add('ShaderNodeCombineXYZ', {'X': row[0], 'Y': row[1]}).outputs[0]
        return self.add('ShaderNodeTexImage', {'Vector': place}, image=self._archive.image(color['texture']),
                        interpolation='Linear' if color['is_smooth'] else 'Closest').outputs['Color']

    def number(self, color):
        """A number, or the output of a grey texture."""
        return color[0] if isinstance(color, list) else self.color(color)

    def shader(self, kind, inputs, **properties):
        """The output of a shader that the normal map, if there is one, turns."""
        turned = {} if self._normal is None else {'Normal': self._normal}
        return self.add(kind, inputs | turned, **properties).outputs[0]

    def surface(self, material):
        """The output of a material's shader."""
        kind = material['kind']
        if kind == 'normal_map':
            return self._mapped(material)
        if kind == 'principled':
            return self.shader('ShaderNodeBsdfPrincipled', {
                'Base Color': self.color(material['color']), 'Metallic': self.number(material['metallic']),
                'Roughness': self.number(material['roughness']), 'IOR': material['eta']}, distribution='GGX')
        if kind == 'diffuse':
            return self.shader('ShaderNodeBsdfDiffuse', {'Color': self.color(material['reflectance'])})
        if kind == 'plastic':
            return self._plastic(material)
        if kind == 'conductor':
            return self._conductor(material)
        if kind == 'dielectric':
            return self.shader('ShaderNodeBsdfGlass', {'IOR': material['eta'], 'Roughness': 0.0})
        if kind == 'mask':
            return self.add('ShaderNodeMixShader', {0: self.color(material['opacity']),
                                                    1: self.add('ShaderNodeBsdfTransparent').outputs[0],
                                                    2: self.surface(material['inner'])}).outputs[0]
        raise ValueError(kind)

    def _mapped(self, material):
        """A surface under a normal map, whose y is against the texture's v: rows of its image go down, and so does v here."""
        upwards = self.add('ShaderNodeVectorMath', {0: self.color(material['normals']), 1: (1, -1, 1), 2: (0, 1, 0)},
                           operation='MULTIPLY_ADD').outputs[0]
        self._normal = self.add('ShaderNodeNormalMap', {'Color': upwards}, space='TANGENT').outputs[0]
        surface = self.surface(material['inner'])
        self._normal = None
        return surface

    def _plastic(self, material):
        """A coat over a diffuse base of reflectance R, of which the coat lets through (1 - F) R / (eta^2 (1 - F' R)), with the
        mean Fresnel reflectances F outside and F' inside. Its dependence on the angle is only about that of Mitsuba."""
        eta = material['eta']
        outside = mean_fresnel(eta)
        passed = (1 - outside) / eta ** 2
        base = self.color(material['reflectance'])
        base = base[:3] if isinstance(base, tuple) else base
        left = self.add('ShaderNodeVectorMath', {0: base, 1: (passed - 1,) * 3, 2: (1, 1, 1)}, operation='MULTIPLY_ADD').outputs[0]
        numerator = self.add('ShaderNodeVectorMath', {0: base, 1: (passed,) * 3}, operation='MULTIPLY').outputs[0]
        color = self.add('ShaderNodeVectorMath', {0: numerator, 1: left}, operation='DIVIDE').outputs[0]
        return self.shader('ShaderNodeBsdfPrincipled', {'Base Color': color, 'IOR': eta, 'Roughness': math.sqrt(material['alpha'])},
                           distribution='GGX')

    def _conductor(self, material):
        """With Fresnel's equations where nothing tints them; else with the reflectance at normal incidence in all directions."""
        roughness, distribution = math.sqrt(material['alpha']), material['distribution'].upper()
        if material['tint'] == [1, 1, 1] and max(material['eta']) > 0:
            return self.shader('ShaderNodeBsdfMetallic', {'IOR': material['eta'], 'Extinction': material['k'], 'Roughness': roughness},
                               fresnel_type='PHYSICAL_CONDUCTOR', distribution=distribution)
        color = material['tint']
        if isinstance(color, list):
            color = [tint * normal_reflectance(eta, k) for tint, eta, k in zip(color, material['eta'], material['k'])]
        return self.shader('ShaderNodeBsdfAnisotropic', {'Color': self.color(color), 'Roughness': roughness},
                           distribution=distribution)

    def lamp(self, radiance, surface):
        """A surface that shines on the side of its normal."""
        light = self.add('ShaderNodeEmission', {'Color': (*radiance, 1.0), 'Strength': 1.0}).outputs[0]
        back = self.add('ShaderNodeNewGeometry').outputs['Backfacing']
        dark = self.add('ShaderNodeMixShader', {0: back, 1: light, 2: self.add('ShaderNodeEmission', {'Strength': 0.0}).outputs[0]})
        return self.add('ShaderNodeAddShader', {0: dark.outputs[0], 1: surface}).outputs[0]

    def end(self, surface, kind='ShaderNodeOutputMaterial'):
        self.add(kind, {'Surface': surface})


def add_materials(archive):
    """A function that gives the material of a mesh. One that shines has a material of its own."""
    made = {}

    def of(mesh):
        key = (mesh['material'], tuple(mesh.get('radiance', ())))
        if key not in made:
            made[key] = bpy.data.materials.new(str(key))
            made[key].use_nodes = True
            nodes = Nodes(made[key].node_tree, archive)
            surface = nodes.surface(archive.description['materials'][mesh['material']])
            if 'radiance' in mesh:
                surface = nodes.lamp(mesh['radiance'], surface)
                made[key].cycles.emission_sampling = 'FRONT'
            nodes.end(surface)
        return made[key]
    return of


def add_mesh(archive, mesh, material):
    positions, faces = archive.array(mesh['positions']), archive.array(mesh['faces'])
    data = bpy.data.meshes.new('mesh')
    data.from_pydata(positions, [], faces)
    if 'uv' in mesh:
        uv = archive.array(mesh['uv'])[faces.ravel()]
        data.uv_layers.new().uv.foreach_set('vector', uv.astype(np.float32).ravel())
    if 'normals' in mesh:
        data.normals_split_custom_set_from_vertices(archive.array(mesh['normals']))
    else:
        data.shade_flat()
    data.materials.append(material)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new('mesh', data))


def add_point(point):
    """A point light of radiant intensity I has the power 4πI."""
    data = bpy.data.lights.new('point', 'POINT')
    strongest = max(point['intensity'])
    data.color = [c / strongest for c in point['intensity']]
    data.energy = 4 * math.pi * strongest
    data.shadow_soft_size = 0
    light = bpy.data.objects.new('point', data)
    light.location = point['position']
    bpy.context.scene.collection.objects.link(light)


def add_sky(archive, sky):
    world = bpy.data.worlds.new('sky')
    bpy.context.scene.world = world
    world.use_nodes = True
    nodes = Nodes(world.node_tree, archive)
    if sky is None or isinstance(sky, list):
        color = (*(sky or [0, 0, 0]), 1.0)
    else:
        # Latitudes and longitudes of Mitsuba are those of Blender if (x, y, z) becomes (z, x, y).
        turn = Matrix(((0, 0, 1), (1, 0, 0), (0, 1, 0))) @ Matrix(sky['to_world']).to_3x3().inverted()
        direction = nodes.add('ShaderNodeMapping', {'Vector': nodes.add('ShaderNodeTexCoord').outputs['Generated'],
                                                    'Rotation': turn.to_euler('XYZ')}, vector_type='POINT').outputs[0]
        color = nodes.add('ShaderNodeTexEnvironment', {'Vector': direction},
                          image=archive.image(sky['texture'], upside_down=True)).outputs['Color']
    nodes.end(nodes.add('ShaderNodeBackground', {'Color': color}).outputs[0], 'ShaderNodeOutputWorld')


def add_camera(camera):
    """Mitsuba's cameras look along +z with +x on the left, Blender's along -z with +x on the right."""
    data = bpy.data.cameras.new('camera')
    data.sensor_fit = 'HORIZONTAL'
    data.angle = math.radians(camera['x_fov'])
    data.clip_start, data.clip_end = 1e-4, 1e6
    object_ = bpy.data.objects.new('camera', data)
    object_.matrix_world = Matrix(camera['to_world']) @ Matrix.Diagonal((-1, 1, -1, 1))
    bpy.context.scene.collection.objects.link(object_)
    bpy.context.scene.camera = object_


def build(file):
    """Replaces Blender's scene; returns the description of the new one."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    archive = Archive(file)
    material_of = add_materials(archive)
    for mesh in archive.description['meshes']:
        add_mesh(archive, mesh, material_of(mesh))
    for point in archive.description['points']:
        add_point(point)
    add_sky(archive, archive.description['sky'])
    add_camera(archive.description['camera'])
    return archive.description
