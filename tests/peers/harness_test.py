#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests of the comparison itself, without either renderer: what it accepts, what it must reject, what it keeps."""
import argparse
import importlib.util
import os
import stat
import sys
import tempfile
import types
import unittest
import xml.etree.ElementTree

if importlib.util.find_spec('numpy') is None:
    print('skipped: the tests of tests/peers need the Python package numpy (pip install numpy)')
    sys.exit(77)

import numpy as np

import agreement
import peers
import report
import rooms
import rows
from comparison import Comparison, Result
from renderers import Mitsuba, Nearlight, NearlightFailure, NearlightRefusal
from rows.row import Row
from scene_text import *

NOISE = 0.004   # of a block mean of one seed, relative


def pictures(seeds, generator, factor=1.0, noise=NOISE):
    """Block means of pictures with a gradient from dark to bright."""
    truth = np.linspace(0.05, 2.0, 6 * 8 * 3).reshape(6, 8, 3)
    return truth * factor * (1 + noise * generator.standard_normal((seeds, 6, 8, 3)))


class Agreement(unittest.TestCase):
    def setUp(self):
        self.generator = np.random.default_rng(7)

    def compared(self, ours, theirs=None):
        return agreement.compare(ours, pictures(8, self.generator) if theirs is None else theirs)

    def test_the_same_expectation_agrees(self):
        verdicts = [self.compared(pictures(4, self.generator)).verdict for _ in range(300)]
        self.assertGreaterEqual(verdicts.count('agrees'), 299)

    def test_one_percent_deviates(self):
        verdicts = [self.compared(pictures(4, self.generator, 1.01)).verdict for _ in range(100)]
        self.assertEqual(verdicts.count('deviates'), 100)

    def test_three_tenths_of_a_percent_agree(self):
        self.assertEqual(self.compared(pictures(4, self.generator, 1.003)).verdict, 'agrees')

    def test_one_block_that_is_off_by_ten_percent_deviates(self):
        for sign in (1, -1):
            ours = pictures(4, self.generator)
            ours[:, 3, 4, 1] *= 1 + 0.1 * sign
            found = self.compared(ours)
            self.assertEqual((found.verdict, found.block_at), ('deviates', (3, 4)))
            self.assertAlmostEqual(found.block_deviation, 0.1 * sign, delta=0.02)

    def test_one_channel_that_is_off_deviates(self):
        ours = pictures(4, self.generator)
        ours[..., 0] *= 1.04
        ours[..., 2] *= 0.96
        self.assertEqual(self.compared(ours).verdict, 'deviates')

    def test_noise_that_could_hide_an_error_does_not_agree(self):
        ours = pictures(4, self.generator) * (1 + 0.02 * np.array([1, -1, 1.1, -1.1]))[:, None, None, None]
        self.assertEqual(self.compared(ours).verdict, 'noisy')
        self.assertEqual(self.compared(pictures(4, self.generator, noise=0.3)).verdict, 'noisy')

    def test_black_pictures(self):
        black = np.zeros((4, 6, 8, 3))
        self.assertEqual(self.compared(black, black).verdict, 'agrees')
        self.assertEqual(self.compared(pictures(4, self.generator), black).verdict, 'deviates')
        self.assertEqual(self.compared(black).verdict, 'deviates')

    def test_student_quantiles(self):
        for freedom, tail, expected in ((3, 0.025, 3.18245), (7, 0.005, 3.49948), (30, 0.05, 1.69726)):   # from printed tables
            self.assertAlmostEqual(agreement.student_quantile(freedom, tail), expected, places=3)

    def test_block_means(self):
        picture = np.arange(5 * 4 * 3, dtype=float).reshape(5, 4, 3)
        blocks = agreement.block_means(picture, 2)
        self.assertEqual(blocks.shape, (2, 2, 3))
        np.testing.assert_allclose(blocks[1, 0], picture[2:4, 0:2].mean(axis=(0, 1)))


class Rows(unittest.TestCase):
    def test_every_scene_is_xml_with_a_sensor(self):
        for row in rows.all_rows():
            for text in (row.text, row.planted or row.text):
                root = xml.etree.ElementTree.fromstring(text)
                self.assertEqual([len(root.findall(tag)) for tag in ('integrator', 'sensor')], [1, 1], row.name)
                self.assertNotIn('NAME', text, row.name)

    def test_no_scene_appears_twice(self):
        texts = {}
        for row in rows.all_rows():
            if not row.planted:
                other = texts.setdefault((row.text, row.block), row.name)
                self.assertEqual(other, row.name, 'these two rows are the same')

    def test_the_fast_rows_exist(self):
        self.assertEqual({row.name for row in rows.fast_rows()}, set(rows.FAST))

    def test_planted_rows_differ(self):
        planted = [row for row in rows.all_rows() if row.planted]
        self.assertTrue(planted)
        self.assertTrue(all(row.planted != row.text for row in planted))

    def test_elements(self):
        text = bsdf('mask', diffuse(0.5), opacity=0.25, use=True, mode='a').plain()
        root = xml.etree.ElementTree.fromstring(text)
        self.assertEqual([(child.tag, child.get('name')) for child in root],
                         [('bsdf', None), ('float', 'opacity'), ('boolean', 'use'), ('string', 'mode')])
        self.assertEqual(root.find('bsdf/rgb').get('value'), '0.5')

    def test_rooms_have_the_shape_of_their_film(self):
        with tempfile.TemporaryDirectory() as folder:
            os.makedirs(f'{folder}/hall')
            with open(f'{folder}/hall/scene.xml', 'w') as file:
                file.write('<scene><default name="w" value="1280"/><sensor><film><integer name="width" value="$w"/>'
                           '<integer name="height" value="720"/></film></sensor></scene>')
            with open(f'{folder}/part.xml', 'w') as file:
                file.write('<scene/>')
            found = rooms.rows([folder], '128x96')
        self.assertEqual([(row.name, row.size) for row in found], [('rooms/hall', [128, 72])])


class RoomsMadeByChance(unittest.TestCase):
    ROWS = rows.chance.rows(range(300))

    def within(self, outer):
        """The types of all materials within one of the type `outer`, over all rooms."""
        roots = [xml.etree.ElementTree.fromstring(row.text) for row in self.ROWS]
        return {inner.get('type') for root in roots for b in root.iter('bsdf') if b.get('type') == outer
                for inner in b.iter('bsdf') if inner is not b}

    def test_a_seed_makes_one_room(self):
        self.assertEqual(self.ROWS[7:9], rows.chance.rows([7, 8]))
        self.assertEqual(len({row.text for row in self.ROWS}), len(self.ROWS))

    def test_materials_stand_around_others_where_mitsuba_is_right(self):
        for map_of in rows.chance.MAPS:
            self.assertTrue(self.within(map_of).isdisjoint(rows.chance.MAPS))
        self.assertNotIn('plastic', self.within('blendbsdf'))
        self.assertNotIn('mask', self.within('twosided'))
        self.assertLessEqual({'plastic', 'mask', 'principled', 'blendbsdf', 'twosided'}, self.within('normalmap'))

    def test_no_path_leaves_a_room_into_nothing(self):
        for row in self.ROWS:
            root = xml.etree.ElementTree.fromstring(row.text)
            skies = [e for e in root.findall('emitter') if e.get('type') in ('constant', 'envmap')]
            self.assertEqual(len(skies), 1, row.name)

    def test_seeds_are_a_number_or_a_range(self):
        self.assertEqual([list(peers.seeds_of(text)) for text in ('5', '8-10')], [[5], [8, 9, 10]])
        for wrong in ('', 'x', '3-', '-3', '3-x'):
            self.assertRaises(argparse.ArgumentTypeError, peers.seeds_of, wrong)


class Renderers(unittest.TestCase):
    """With a worker and a program that only seem to render."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.scene = os.path.join(self.folder.name, 'scene.xml')
        with open(self.scene, 'w') as file:
            file.write('<scene><string name="filename" value="mesh.obj"/></scene>')
        self.asked = []

    def ask(self, request, _seconds):
        self.asked.append(request)
        np.save(request['into'], np.ones((len(request.get('seeds') or request['read']), 2, 2, 3)))

    def program(self, script):
        path = os.path.join(self.folder.name, 'program')
        with open(path, 'w') as file:
            file.write('#!/bin/sh\n' + script)
        os.chmod(path, stat.S_IRWXU)
        return Nearlight(path, self, self.folder.name)

    def test_mitsuba_renders_once_until_the_scene_or_its_files_change(self):
        mitsuba = Mitsuba(self, '3.0', os.path.join(self.folder.name, 'kept'))
        row = Row('a/b', '')
        mitsuba.pictures(self.scene, row)
        mitsuba.pictures(self.scene, row)
        self.assertEqual(len(self.asked), 1)
        with open(os.path.join(self.folder.name, 'mesh.obj'), 'w') as file:
            file.write('v 0 0 0')
        mitsuba.pictures(self.scene, row)
        self.assertEqual(len(self.asked), 2)
        Mitsuba(self, '3.1', mitsuba.folder).pictures(self.scene, row)
        self.assertEqual(len(self.asked), 3)
        mitsuba.pictures(self.scene, Row('a/b', '', block=1))
        self.assertEqual(len(self.asked), 4)

    def test_a_refusal_keeps_its_message_without_the_folder(self):
        nearlight = self.program('echo "nearlight: error: /some/where/scene.xml:3: unknown emitter" >&2; exit 3')
        with self.assertRaisesRegex(NearlightRefusal, '^scene.xml:3: unknown emitter$'):
            nearlight.pictures(self.scene, Row('a/b', ''), (1,))

    def test_another_exit_code_is_a_failure(self):
        with self.assertRaisesRegex(NearlightFailure, 'exit code 1'):
            self.program('exit 1').pictures(self.scene, Row('a/b', ''), (1,))

    def test_a_program_that_hangs_is_a_failure(self):
        nearlight = self.program('exec sleep 30')
        nearlight.seconds = 0.2
        with self.assertRaisesRegex(NearlightFailure, 'took more than'):
            nearlight.pictures(self.scene, Row('a/b', ''), (1,))

    def test_warnings_seeds_and_options_pass_through(self):
        log = os.path.join(self.folder.name, 'log')
        nearlight = self.program(f'echo "$@" >> {log}; touch "$4"; echo \'{{"clamp_radius": 2}}\'\n'
                                 'echo "nearlight: warning: scene.xml:3: approximated" >&2')
        found, warnings, answer = nearlight.pictures(self.scene, Row('a/b', '', options=('--spp', '9'), size=(64, 48)), (5, 6))
        self.assertEqual((found.shape, warnings, answer), ((2, 2, 2, 3), ['scene.xml:3: approximated'], {'clamp_radius': 2}))
        with open(log) as file:
            for line, seed in zip(file, (5, 6)):
                self.assertIn(f'--seed {seed} --spp 9 --size 64x48', line)


class Verdicts(unittest.TestCase):
    """A whole row, with a worker and a program that only seem to render."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.log = os.path.join(self.folder.name, 'log')
        self.write_program('echo "$@" >> ' + self.log + '; touch "$4"; echo \'{"clamp_radius": 0.5}\'')

    def write_program(self, script):
        self.program = os.path.join(self.folder.name, 'program')
        with open(self.program, 'w') as file:
            file.write('#!/bin/sh\n' + script)
        os.chmod(self.program, stat.S_IRWXU)

    def ask(self, request, _seconds):
        np.save(request['into'], np.ones((len(request.get('seeds') or request['read']), 2, 2, 3)))

    def result(self, row, **options):
        given = dict(clamp_radius_factor=1, resume=False, redo=False, out=self.folder.name, nearlight=self.program, options='', reference=0)
        return Comparison(types.SimpleNamespace(**{**given, **options}), '3.0', self).result(row)

    def renderings(self):
        with open(self.log) as file:
            return file.read().splitlines()

    def test_the_reference_takes_samples_and_no_options_of_rows(self):
        self.result(Row('a/b', '<scene/>', options=('--vpls', '9')), reference=64)
        self.assertTrue(self.renderings()[0].startswith('reference '))
        self.assertIn('--spp 64', self.renderings()[0])
        self.assertNotIn('--vpls', self.renderings()[0])

    def test_a_row_that_agrees_passes_after_four_seeds(self):
        result = self.result(Row('a/b', '<scene/>'))
        self.assertEqual((result.status, result.passed, result.clamp_radius), ('agrees', True, 0.5))
        self.assertEqual(len(self.renderings()), 4)

    def test_a_planted_row_that_agrees_fails(self):
        result = self.result(Row('a/b', '<scene/>', planted='<scene><!-- wrong --></scene>'))
        self.assertEqual((result.status, result.passed), ('agrees', False))
        self.assertIn('a__b-wrong.xml', self.renderings()[0])

    def test_a_refusal_fails_unless_the_row_allows_it(self):
        self.write_program('echo "nearlight: error: no" >&2; exit 3')
        for supported in (True, False):
            result = self.result(Row('a/b', '<scene/>', supported=supported))
            self.assertEqual((result.status, result.passed, result.note), ('refused', not supported, 'no'))

    def test_resumed_results_hold_until_the_scene_or_the_program_change(self):
        row = Row('a/b', '<scene/>')
        first = self.result(row)
        again = self.result(row, resume=True)
        self.assertEqual((again.status, again.agreement.ratio), (first.status, first.agreement.ratio))
        self.assertEqual(len(self.renderings()), 4)
        self.result(Row('a/b', '<scene></scene>'), resume=True)
        self.assertEqual(len(self.renderings()), 8)
        with open(self.program, 'a') as file:
            file.write('\n# another build')
        self.result(row, resume=True)
        self.assertEqual(len(self.renderings()), 12)

    def test_the_clamp_radius_is_a_multiple_of_the_automatic_one(self):
        self.result(Row('a/b', '<scene/>'), clamp_radius_factor=0.1)
        self.assertNotIn('--clamp-radius', self.renderings()[0])
        self.assertIn('--clamp-radius 0.05', self.renderings()[1])


class Report(unittest.TestCase):
    def test_the_page_has_all_rows_but_planted_ones(self):
        results = [Result('a/b', 'refused', True, 'a__b.xml:7: a | b'), Result('planted/x', 'deviates', True),
                   Result('c/d', 'agrees', True, agreement=agreement.compare(np.ones((2, 1, 1, 3)), np.ones((2, 1, 1, 3))))]
        with tempfile.TemporaryDirectory() as folder:
            report.write(f'{folder}/page.md', results, 'tests/peers/peers.py', '1.0', '3.9')
            with open(f'{folder}/page.md') as file:
                page = file.read()
        self.assertIn('| b | refused |  |  | a \\| b |', page)
        self.assertIn('| d | agrees | 1.0000 ± 0.0000 | 0.0% |  |', page)
        self.assertNotIn('planted', page)
        self.assertIn('with nearlight 1.0 and Mitsuba 3.9:\n\n    tests/peers/peers.py\n', page)


if __name__ == '__main__':
    unittest.main()
