# SPDX-License-Identifier: Apache-2.0
"""Shapes, their transforms, and normals on coarse meshes."""
from rows.row import table
from scene_text import *

PAINT = diffuse(0.7, 0.5, 0.3)


def rows():
    return table('shapes', {**_shapes(), **_transforms()}) + table('normals', _normals())


def _lit(*things, lights=None, depth=4):
    return scene(*stage(*things), *(lights or (point_light(),)), depth=depth)


def _placed(size=0.7, *steps):
    return transform(scale(size), *steps, move(0, 0.75, 0))


def _shapes():
    group = with_id('pair', shape('shapegroup', sphere(PAINT, at=(0, 0.3, 0), radius=0.3),
        shape('cube', diffuse(0.3, 0.5, 0.7), to_world=place(0.2, (0, 0.8, 0)))))
    instance = lambda x, degrees, size=1.0: shape('instance', ref('pair'),
        to_world=place(size, (x, 0.1, 0), turn('z', degrees)))
    return {
        'rectangle': _lit(rectangle(PAINT, at=(0, 0.9, 0), size=0.7)),
        'cube': _lit(box(PAINT)),
        'sphere': _lit(sphere(PAINT)),
        'sphere-to-world': _lit(shape('sphere', PAINT, to_world=place(0.7, (0, 0.7, 0)))),
        'sphere-flipped': _lit(sphere(PAINT, flip_normals=True)),
        'sphere-inside': scene(sphere(PAINT, at=(0, 0, 0), radius=3, flip_normals=True), point_light(3, at=(0.5, 1, 0)),
            depth=6, camera=perspective(to_world=look('0, 0, 2', '0, 0, 0'))),
        'disk': _lit(shape('disk', PAINT, to_world=_placed())),
        'cylinder': _lit(shape('cylinder', PAINT, p0=point(0, 0, 0), p1=point(0.2, 1.4, 0), radius=0.4)),
        'cylinder-open': _lit(shape('cylinder', bsdf('twosided', PAINT), p0=point(0, 0.6, -0.6), p1=point(0.3, 0.8, 0.8),
            radius=0.5)),
        'obj': _lit(mesh('fine_ball.obj', PAINT, to_world=_placed())),
        'ply': _lit(mesh('wave_colors.ply', bsdf('twosided', PAINT), to_world=_placed(1.0))),
        'serialized': _lit(mesh('meshes.serialized', PAINT, to_world=_placed())),
        'serialized-second': _lit(mesh('meshes.serialized', bsdf('twosided', PAINT), shape_index=1, to_world=_placed(1.0))),
        'instances': scene(group, *stage(instance(-0.8, 10), instance(0.1, -20, 1.3), instance(0.9, 60)), point_light(),
            depth=4),
        'merge': _lit(shape('merge', mesh('ball.obj', PAINT, to_world=place(0.4, (-0.6, 0.5, 0))),
            mesh('wave.obj', PAINT, to_world=place(0.4, (0.6, 0.6, 0))))),
        'linearcurve': (_lit(shape('linearcurve', PAINT, filename=ASSETS + 'curve.txt')), dict(supported=False)),
    }


def _transforms():
    return {
        'negative-scale-mesh': _lit(mesh('ball.obj', PAINT, to_world=place((-0.7, 0.7, 0.7), (0, 0.75, 0)))),
        'negative-scale-sphere': _lit(shape('sphere', PAINT, to_world=place((0.7, 0.7, -0.7), (0, 0.7, 0)))),
        'negative-scale-cube': _lit(shape('cube', PAINT, to_world=place((-0.5, 0.5, 0.5), (0, 0.5, 0), turn('y', 30)))),
        'negative-scale-rectangle': _lit(shape('rectangle', PAINT, to_world=place((-0.8, 0.8, 1), (0, 0.9, 0)))),
        'negative-scale-rectangle-z': _lit(shape('rectangle', PAINT, to_world=place((0.8, 0.8, -1), (0, 0.9, 0)))),
        'negative-scale-cylinder': _lit(shape('cylinder', PAINT, to_world=place((-0.5, 0.5, 1.2), (0, 0.2, 0), turn('x', -90)))),
        'negative-scale-face-normals': _lit(shape('cube', PAINT, face_normals=True,
            to_world=place((-0.5, 0.5, 0.5), (0, 0.5, 0), turn('y', 30)))),
        'negative-scale-instance': scene(
            with_id('mirrored', shape('shapegroup', sphere(PAINT, at=(-0.6, 0.5, 0), radius=0.4),
                mesh('ball.obj', PAINT, face_normals=True, to_world=place(0.4, (0.6, 0.5, 0))))),
            *stage(shape('instance', ref('mirrored'), to_world=place((-1, 1, 1), (0, 0.1, 0)))), point_light(), depth=4),
        'negative-scale-all': _lit(mesh('fine_ball.obj', PAINT, to_world=place(-0.7, (0, 0.75, 0)))),
        'uneven-scale-sphere': _lit(shape('sphere', PAINT, to_world=place((0.6, 0.4, 0.8), (0, 0.7, 0), turn('z', 30)))),
        'uneven-scale-instance': scene(
            with_id('stretched', shape('shapegroup', sphere(PAINT, at=(0, 0.7, 0), radius=0.6))),
            *stage(shape('instance', ref('stretched'), to_world=place((1.3, 0.8, 0.6), (0, 0, 0)))), point_light(), depth=4),
        'uneven-scale': _lit(mesh('ball.obj', PAINT, to_world=place((1.1, 0.5, 0.4), (0, 0.75, 0), turn('z', 30)))),
        'matrix': _lit(shape('cube', PAINT,
            to_world=transform('<matrix value="0.5 0.2 0 0  0 0.5 0 0.6  0 0.1 0.5 0  0 0 0 1"/>'))),
        'rotation-about-axis': _lit(shape('cube', PAINT, to_world=_about('x="0.6" y="0.8"'))),
        'rotation-about-long-axis': _lit(shape('cube', PAINT, to_world=_about('x="1" y="1" z="0.3"'))),   # it also shears
        'flipped-mesh': _lit(mesh('fine_ball.obj', PAINT, flip_normals=True, to_world=_placed())),
    }


def _about(axis):
    return transform(scale(0.4), f'<rotate {axis} angle="50"/>', move(0, 0.8, 0))


def _normals():
    lamps = {'point': (point_light(),), 'area': (lamp(8, size=0.8),)}
    forms = {
        'obj': lambda: mesh('ball.obj', PAINT, to_world=_placed()),
        'obj-face-normals': lambda: mesh('ball.obj', PAINT, face_normals=True, to_world=_placed()),
        'obj-without-normals': lambda: mesh('ball_flat.obj', PAINT, to_world=_placed()),
        'ply': lambda: mesh('ball.ply', PAINT, to_world=_placed()),
        'ply-without-normals': lambda: mesh('ball_flat.ply', PAINT, to_world=_placed()),
        'wave': lambda: mesh('wave.obj', bsdf('twosided', PAINT), to_world=transform(turn('x', -50), move(0, 0.7, 0))),
        'wave-plastic': lambda: mesh('wave.obj', bsdf('twosided', bsdf('plastic')),
            to_world=transform(turn('x', -50), move(0, 0.7, 0))),
    }
    scenes = {f'{form}/{name}': _lit(make(), lights=lights) for form, make in forms.items() for name,
        lights in lamps.items()}
    return {**scenes, 'metal/area': _lit(mesh('ball.obj', bsdf('roughconductor', material='Al', alpha=0.2),
        to_world=_placed()), lights=lamps['area'])}
