#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of bench/versus, without any renderer."""
import importlib.util
import json
import os
import sys
import tempfile
import types
import unittest
import xml.etree.ElementTree

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, '../../bench/versus'))
if importlib.util.find_spec('numpy') is None:
    print('skipped: the tests of the race need the Python package numpy')
    sys.exit(77)

import numpy as np

import gltf_scene
import measures
import mitsuba_scene
import plots
import race
import report
import scene_export


def grey(values):
    return np.repeat(np.asarray(values, dtype=np.float64)[..., None], 3, axis=2)


class Measures(unittest.TestCase):
    def test_relative_mse_leaves_out_fireflies(self):
        truth = grey(np.ones((100, 100)))
        picture = grey(np.full((100, 100), 1.1))
        self.assertAlmostEqual(measures.relative_mse(picture, truth), 0.01 / 1.01)
        picture[3, 4] = 1e6
        self.assertAlmostEqual(measures.relative_mse(picture, truth), 0.01 / 1.01)

    def test_spectrum_tells_white_from_correlated_noise(self):
        random = np.random.default_rng(1)
        truth = grey(np.ones((128, 128)))
        white = [p for _, p in measures.spectrum(truth + grey(random.normal(0, 0.1, (128, 128))), truth)]
        self.assertTrue(all(0.5 < p < 2 for p in white[4:]), white)
        blocks = np.kron(random.normal(0, 0.1, (8, 8)), np.ones((16, 16)))
        correlated = [p for _, p in measures.spectrum(truth + grey(blocks), truth)]
        self.assertGreater(correlated[2], 20)
        self.assertLess(correlated[-1], 0.1)

    def test_seconds_to_an_error_lie_on_the_curve(self):
        seconds, errors = [1, 2, 4, 8], [0.4, 0.2, 0.1, 0.05]
        self.assertAlmostEqual(measures.seconds_to(0.1, seconds, errors), 4)
        self.assertAlmostEqual(measures.seconds_to(0.08, seconds, errors), 5)
        self.assertEqual(measures.seconds_to(1, seconds, errors), 1)
        self.assertIsNone(measures.seconds_to(0.01, seconds, errors))

    def test_ratios_say_how_they_are_to_be_read(self):
        slow = ([1, 2, 4], [0.8, 0.4, 0.2])
        fast = ([1, 2, 4], [0.2, 0.1, 0.05])
        self.assertEqual(measures.ratio_to_equal(slow, slow, 1), (1.0, ''))
        ratio, mark = measures.ratio_to_equal(([1, 2], [0.4, 0.1]), slow, 1)
        self.assertEqual(mark, '')
        self.assertAlmostEqual(ratio, 4 / 1.5, delta=0.2)
        self.assertEqual(measures.ratio_to_equal(([1, 2], [0.1, 0.05]), slow, 1), (8.0, '~'))
        self.assertEqual(measures.ratio_to_equal(([1, 2], [0.1, 0.05]), slow, 0.5), (16.0, '~'))
        self.assertEqual(measures.ratio_to_equal(([1, 2], [0.1, 0.05]), slow, None), (4.0, '>'))
        self.assertLess(measures.ratio_to_equal(slow, fast, 1)[0], 1)
        self.assertEqual(measures.ratio_to_equal(([1, 2], [0.4, 0.2]), ([5, 10], [0.1, 0.05]), 1), (2.5, '<'))

    def test_a_single_picture_is_compared_on_the_other_curve(self):
        ratio, mark = measures.ratio_to_equal(([1], [0.2]), ([1, 10], [0.4, 0.1]), None)
        self.assertEqual(mark, '')
        self.assertAlmostEqual(ratio, 10 ** 0.5)

    def test_the_truth_trusts_the_less_noisy(self):
        random = np.random.default_rng(2)
        truth = grey(np.ones((64, 64)))

        def halves(deviation):
            return [truth + grey(random.normal(0, deviation, (64, 64))) for _ in range(2)]
        noisy, clean = halves(0.3), halves(0.01)
        picture, variance = measures.combined([noisy, clean])
        self.assertLess(measures.relative_mse(picture, truth), 2 * 0.01 ** 2)
        self.assertAlmostEqual(variance, 0.5 * 0.01 ** 2, delta=0.2 * 0.01 ** 2)
        ratio, error = measures.mean_ratio(noisy, clean)
        self.assertLess(abs(ratio - 1), 5 * error + 0.02)


class Transform:
    """As Mitsuba's transforms of textures are, as far as an export looks at them."""

    def __init__(self, matrix):
        self.matrix = matrix


class Export(unittest.TestCase):
    def setUp(self):
        self.archive = scene_export.Archive()

    def material(self, text, values):
        return scene_export.named_material(text, values, '', self.archive)

    def test_nested_materials_keep_their_parameters(self):
        text = 'Mask[\n  opacity = 0.5,\n  nested_bsdf = TwoSided[\n    brdf[0] = RoughPlastic[\n  ],\n    brdf[1] = SmoothDiffuse[]]]'
        inner = 'nested_bsdf.brdf_0.'
        material = self.material(text, {'opacity.value': 0.5, inner + 'diffuse_reflectance.value': [0.1, 0.2, 0.3],
                                        inner + 'alpha': 0.25, inner + 'eta': 1.5})
        self.assertEqual(material['kind'], 'mask')
        self.assertEqual(material['opacity'], [0.5, 0.5, 0.5])
        self.assertEqual(material['inner']['kind'], 'plastic')
        self.assertEqual((material['inner']['alpha'], material['inner']['eta']), (0.25, 1.5))
        np.testing.assert_allclose(material['inner']['reflectance'], [0.1, 0.2, 0.3], rtol=1e-6)

    def test_textures_become_linear(self):
        pixels = np.array([[[0, 128, 255]]], dtype=np.uint8)
        for raw, middle in ((0, 0.2158605), (1, 128 / 255)):
            material = self.material(f'SmoothDiffuse[\n  reflectance = BitmapTexture[\n    raw = {raw},', {
                'reflectance.data': pixels, 'reflectance.to_uv': Transform([[2, 0, 0], [0, 3, 0], [0, 0, 1]])})
            texture = material['reflectance']
            self.assertEqual(texture['to_uv'], [[2, 0, 0], [0, 3, 0]])
            np.testing.assert_allclose(self.archive.arrays[texture['texture']['array']][0, 0], [0, middle, 1], atol=1e-5)

    def test_principled_materials_keep_what_blender_has_too(self):
        inner = 'nested_bsdf.brdf_0.'
        none = {f'{inner}{name}.value': 0.0 for name in ('anisotropic', 'clearcoat', 'flatness', 'sheen', 'spec_tint', 'spec_trans')}
        values = none | {inner + 'base_color.value': [0.1, 0.2, 0.3], inner + 'roughness.value': 0.4, inner + 'metallic.value': 1.0,
                         inner + 'specular': 0.5, 'normalmap.data': np.full((1, 1, 3), 128, dtype=np.uint8),
                         'normalmap.to_uv': Transform(np.eye(3))}
        text = 'NormalMap[\n  nested_bsdf = TwoSided[\n    brdf[0] = Principled BSDF :\n],\n  normalmap = BitmapTexture[\n    raw = 1,\n]]'
        material = self.material(text, values)
        self.assertEqual(material['kind'], 'normal_map')
        normals = self.archive.arrays[material['normals']['texture']['array']]
        np.testing.assert_allclose(normals, np.full((1, 1, 3), 128 / 255), rtol=1e-6)
        inside = material['inner']
        self.assertEqual((inside['kind'], inside['metallic']), ('principled', [1, 1, 1]))
        self.assertAlmostEqual(inside['eta'], 1.5)
        with self.assertRaisesRegex(scene_export.Unsupported, 'clearcoat'):
            self.material(text, values | {inner + 'clearcoat.value': 0.5})

    def test_what_has_no_counterpart_is_refused_by_name(self):
        with self.assertRaisesRegex(scene_export.Unsupported, 'Hair'):
            self.material('Hair[]', {})
        with self.assertRaisesRegex(scene_export.Unsupported, 'reflectance'):
            self.material('SmoothDiffuse[]', {})

    def test_a_disc_has_its_place_and_nearly_its_area(self):
        corners, faces = scene_export.disc([[2, 0, 0, 5], [0, 2, 0, 0], [0, 0, 2, 0], [0, 0, 0, 1]])
        a, b, c = (corners[faces[:, i]] for i in range(3))
        across = np.cross(b - a, c - a)
        self.assertTrue((across[:, 2] > 0).all())
        self.assertAlmostEqual(np.linalg.norm(across, axis=1).sum() / 2, 4 * np.pi, delta=0.01)
        np.testing.assert_allclose(corners[0], [5, 0, 0])


def triangle_file(folder, **more):
    """A glTF file of a triangle on a node that mirrors it, with a camera and a light."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype=np.float32)
    with open(os.path.join(folder, 'a b.bin'), 'wb') as out:
        out.write(corners.tobytes())
    model = {'asset': {'version': '2.0'}, 'extensionsUsed': ['KHR_lights_punctual'], 'buffers': [{'uri': 'a%20b.bin', 'byteLength': 36}],
             'bufferViews': [{'buffer': 0, 'byteLength': 36}],
             'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3'}],
             'materials': [{'pbrMetallicRoughness': {'baseColorFactor': [0.1, 0.2, 0.3, 1], 'roughnessFactor': 0.5}, 'alphaMode': 'BLEND'}],
             'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'material': 0}]}],
             'cameras': [{'type': 'perspective', 'perspective': {'yfov': np.pi / 2, 'aspectRatio': 2}}],
             'extensions': {'KHR_lights_punctual': {'lights': [{'type': 'point', 'intensity': 683, 'color': [1, 0.5, 0]}]}},
             'scenes': [{'nodes': [0]}],
             'nodes': [{'children': [1, 2, 3], 'translation': [10, 0, 0], 'rotation': [0, 0, 0.5 ** 0.5, 0.5 ** 0.5]},
                       {'mesh': 0, 'scale': [-2, 1, 1]}, {'camera': 0},
                       {'translation': [1, 0, 0], 'extensions': {'KHR_lights_punctual': {'light': 0}}}]} | more
    file = os.path.join(folder, 'scene.gltf')
    with open(file, 'w', encoding='utf-8') as out:
        json.dump(model, out)
    return file


class Filters(unittest.TestCase):
    def test_a_box_replaces_the_filter_of_a_film_or_its_default(self):
        with tempfile.TemporaryDirectory(prefix='Race-') as folder:
            file = os.path.join(folder, 'scene.xml')
            for film in ('<film type="hdrfilm"><rfilter name="rfilter" type="tent"/><integer name="width" value="4"/></film>',
                         '<film type="hdrfilm"/>'):
                with open(file, 'w', encoding='utf-8') as out:
                    out.write(f'<scene version="3.0.0"><sensor type="perspective">{film}</sensor></scene>')
                scene = xml.etree.ElementTree.fromstring(mitsuba_scene.with_box_filters(file))
                self.assertEqual([f.get('type') for f in scene.iter('rfilter')], ['box'])
                self.assertEqual(len(scene.findall('sensor/film/integer')), film.count('<integer'))


class FromGltf(unittest.TestCase):
    def test_meshes_lights_and_cameras_keep_their_places(self):
        with tempfile.TemporaryDirectory(prefix='Race-') as folder:
            scene = gltf_scene.converted(None, triangle_file(folder), folder)
            with open(os.path.join(folder, scene.find('shape/string').get('value')), 'rb') as ply:
                body = ply.read().partition(b'end_header\n')[2]
        corners = np.frombuffer(body, dtype='<f4', count=9).reshape(3, 3)
        np.testing.assert_allclose(corners, [[10, 0, 0], [10, -2, 0], [9, 0, 0]], atol=1e-6)      # mirrored, turned, moved
        self.assertEqual(np.frombuffer(body, dtype='<i4', count=3, offset=37).tolist(), [2, 1, 0])  # so the front stays in front
        position = scene.find('emitter/point')
        np.testing.assert_allclose([float(position.get(axis)) for axis in 'xyz'], [10, 1, 0], atol=1e-12)
        self.assertEqual(scene.find('emitter/rgb').get('value'), '1.0 0.5 0.0')
        sensor = scene.find('sensor')
        self.assertAlmostEqual(float(sensor.find('float').get('value')), np.degrees(2 * np.arctan(2)))
        matrix = np.array(sensor.find('transform/matrix').get('value').split(), dtype=float).reshape(4, 4)
        np.testing.assert_allclose(matrix[:3], [[0, -1, 0, 10], [-1, 0, 0, 0], [0, 0, -1, 0]], atol=1e-12)

    def test_materials_become_principled_behind_their_alpha(self):
        with tempfile.TemporaryDirectory(prefix='Race-') as folder:
            scene = gltf_scene.converted(None, triangle_file(folder), folder)
        mask = scene.find('shape/bsdf')
        self.assertEqual((mask.get('type'), mask.find('float').get('value')), ('mask', '1.0'))
        principled = mask.find('bsdf/bsdf')
        self.assertEqual({child.get('name'): child.get('value') for child in principled},
                         {'base_color': '0.1 0.2 0.3', 'roughness': '0.5', 'metallic': '1.0'})

    def test_what_has_no_counterpart_is_refused_by_name(self):
        with tempfile.TemporaryDirectory(prefix='Race-') as folder:
            for more, name in (({'extensionsUsed': ['KHR_materials_sheen']}, 'KHR_materials_sheen'), ({'skins': [{}]}, 'skins'),
                               ({'extensions': {}, 'nodes': [{'mesh': 0}]}, 'camera and lights')):
                with self.assertRaisesRegex(gltf_scene.Unsupported, name):
                    gltf_scene.converted(None, triangle_file(folder, **more), folder)


class KeptPictures(unittest.TestCase):
    def test_their_names_change_with_the_size_the_scene_and_its_files(self):
        with tempfile.TemporaryDirectory(prefix='Race-') as folder:
            scene, mesh = (os.path.join(folder, name) for name in ('scene.xml', 'mesh.obj'))
            keys = set()
            for triangle in ('f 1 2 3', 'f 3 2 1'):
                with open(mesh, 'w', encoding='utf-8') as out:
                    out.write(triangle)
                for value in ('a', 'b'):
                    with open(scene, 'w', encoding='utf-8') as out:
                        out.write(f'<scene><string name="filename" value="mesh.obj"/><!-- {value} --></scene>')
                    for size in ((4, 3), (8, 6)):
                        self.assertEqual(race.key_of(scene, size), race.key_of(scene, size))
                        keys.add(race.key_of(scene, size))
            self.assertEqual(len(keys), 8)


class Report(unittest.TestCase):
    def test_a_race_becomes_tables_and_plots(self):
        def curve(name, denoised, factor):
            spectrum = [(0.1, 1.0), (0.3, 1.0)]
            points = [{'work': w, 'runs': [{'seed': s, 'seconds': {'render': w, 'process': w + 1, 'processor': 2 * w},
                                            'relative_mse': factor / w, 'flip': factor / w ** 0.5, 'spectrum': spectrum} for s in (1, 2)]}
                      for w in (1, 2, 4)]
            return {'renderer': name, 'denoised': denoised, 'points': points}
        result = {'scene': 'a<b', 'size': [4, 3], 'truth_relative_mse': {'the scene': 1e-5}, 'notes': ['third is left out: it is not there'],
                  'agreement': [{'renderers': ['nearlight', 'other'], 'ratio': 1.001, 'error': 0.002}],
                  'curves': [curve('nearlight', False, 0.1), curve('other', False, 0.8)]}
        with tempfile.TemporaryDirectory(prefix='Race-') as folder:
            file = os.path.join(folder, 'VERSUS.md')
            report.write(file, [result], ['a note'], types.SimpleNamespace(seeds=2, size='4x3', clock='render'))
            with open(file, encoding='utf-8') as text:
                lines = text.read()
            for plot in os.listdir(os.path.join(folder, 'versus-plots')):
                xml.etree.ElementTree.parse(os.path.join(folder, 'versus-plots', plot))
        self.assertIn('1.0010 ± 0.0020', lines)
        self.assertIn('third is left out: it is not there.', lines)
        self.assertIn('| relative MSE, raw | render | ~ 8 (8 to 8) |', lines)

    def test_axes_have_ticks(self):
        for low, high in ((1, 2), (0.001, 1), (1e-6, 1e6)):
            self.assertGreaterEqual(len(plots.Axis([low, high], 0, 100).ticks()), 2)


if __name__ == '__main__':
    unittest.main()
