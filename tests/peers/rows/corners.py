# SPDX-License-Identifier: Apache-2.0
"""Where surfaces meet: the clamp takes most of its light there, and the remainder must bring it back."""
from rows.row import table
from scene_text import *

CAMERA = perspective(to_world=INSIDE)
CLOSE = perspective(to_world=look('-0.2, 0.8, 0.6', '-1, 0.2, -1'))


def rows():
    return table('corners', _diffuse()) + table('metal-rooms', _metal(), spp=1024)


def _lamp(radiance=6.0, size=0.6):
    return rectangle(area(radiance), diffuse(0), at=(0, 2.9, 0), size=size, turned=DOWN)


def _room(material, *things, depth=8, camera=CAMERA):
    return scene(*room(material, *(things or (_lamp(),))), depth=depth, camera=camera)


def _diffuse():
    corner = [rectangle(diffuse(0.8), at=(-1, 0, -1), size=1.2, turned=UP),
        rectangle(diffuse(0.8, 0.3, 0.2), at=(-1, 0, -1), size=1.2),
              rectangle(diffuse(0.2, 0.8, 0.3), at=(-1, 0, -1), size=1.2, turned=[turn('y', 90)])]
    groove = [rectangle(bsdf('twosided', diffuse(0.8)), at=(x, 0.3, 0), size=0.6,
        turned=[turn('y', y), turn('z', -y / 90 * 20)]) for x,
        y in ((-0.25, 90), (0.25, -90))]
    return {
        'room-grey': _room(diffuse(0.5)),
        'room-white': _room(diffuse(0.85)),
        'room-white-deep': _room(diffuse(0.95), depth=30),
        'room-point': _room(diffuse(0.7), point_light(4, at=(0.8, 2.2, 0.5))),
        'room-light-in-corner': _room(diffuse(0.7), point_light(1, at=(-1.8, 0.2, -2.8))),
        'room-indirect-only': _room(diffuse(0.8), rectangle(area(20), diffuse(0.5), at=(0, 2.6, 0), size=0.3, turned=UP)),
        'corner': scene(*corner, point_light(3, at=(1, 2, 1)), depth=6, camera=CLOSE),
        'corner-sky': scene(*corner, envmap(), depth=6, camera=CLOSE),
        'groove': scene(floor(diffuse(0.8)), *groove, point_light(5, at=(0.1, 2.5, 0.3)), depth=6,
            camera=perspective(to_world=look('0, 1.8, 1.4', '0, 0.2, 0'))),
        'box-on-floor': scene(floor(diffuse(0.8)), box(diffuse(0.8, 0.2, 0.2)), point_light(), depth=6,
            camera=perspective(to_world=look('0.3, 0.6, 1.6', '0.1, 0.15, 0.4'))),
        'ball-on-floor': scene(floor(diffuse(0.8)), sphere(diffuse(0.8, 0.2, 0.2), at=(0, 0.5, 0), radius=0.5),
            point_light(), depth=6, camera=perspective(to_world=look('0, 0.5, 1.8', '0, 0.2, 0'))),
        'sheets-close': scene(floor(diffuse(0.8)), rectangle(bsdf('twosided', diffuse(0.8)), at=(0, 0.15, 0), size=0.7,
            turned=UP), point_light(), depth=8, camera=perspective(to_world=look('0, 0.5, 1.8', '0, 0.1, 0'))),
        'shade': scene(floor(), wall(), shape('cylinder', bsdf('twosided', diffuse(0.8, 0.6, 0.3)), p0=point(0, 0.5, 0),
            p1=point(0, 1.3, 0), radius=0.5), point_light(1, at=(0, 0.9, 0)), depth=8),
        'textured-room': _room(bsdf('diffuse', reflectance=bitmap('tiles.png'))),
        'room-normal-map': _room(bsdf('normalmap', diffuse(0.7), normalmap=bitmap('normals.png', raw=True))),
        'room-bump-map': _room(bsdf('bumpmap', bitmap('hills.png', raw=True), diffuse(0.7), scale=2.0)),
        'room-normal-map-on-plastic': _room(bsdf('normalmap', bsdf('plastic'), normalmap=bitmap('normals.png', raw=True)),
            _lamp(), sphere(diffuse(0.7, 0.3, 0.2), at=(0, 0.7, -1), radius=0.6)),
    }


def _metal():
    steel = bsdf('roughconductor', material='Cr', alpha=0.3)
    gold = bsdf('roughconductor', material='Au', alpha=0.2, distribution='ggx')
    smooth = bsdf('conductor', material='Al')
    white = bsdf('roughconductor', material='none', alpha=0.4)
    things = (_lamp(), box(diffuse(0.7, 0.4, 0.3), at=(0, 0.5, -1)))

    def with_side(**side):
        return scene(*room(diffuse(0.6), *things, **side), depth=8, camera=CAMERA)

    return {
        'room-steel': _room(steel, *things),
        'room-gold': _room(gold, *things),
        'room-white-metal': _room(white, *things, depth=12),
        'room-plastic': _room(bsdf('plastic', diffuse_reflectance=rgb(0.6)), *things),
        'room-roughplastic': _room(bsdf('roughplastic', diffuse_reflectance=rgb(0.6), alpha=0.2), *things),
        'ceiling-gold': with_side(ceiling=gold),
        'floor-steel': with_side(ground=steel),
        'floor-mirror': with_side(ground=smooth),
        'wall-mirror': with_side(left=smooth),
        'wall-roughplastic': with_side(right=bsdf('roughplastic', alpha=0.1)),
        'two-mirrors': scene(*stage(), rectangle(smooth, at=(-1.6, 0, 0), size=3, turned=[turn('y', 90)]),
            rectangle(smooth, at=(1.6, 0, 0), size=3, turned=[turn('y', -90)]), lamp(), depth=8),
        'two-mirrors-facing': scene(floor(), rectangle(smooth, at=(0, 1, -1.5), size=2),
            rectangle(smooth, at=(0, 1, 5), size=3, turned=[turn('y', 180)]), box(diffuse(0.7, 0.4, 0.3)), lamp(),
            depth=8),
        'metal-under-spot': scene(*stage(sphere(bsdf('roughconductor', material='Al', alpha=0.15))),
            emitter('spot', intensity=rgb(60), to_world=transform(look('1.2, 2.8, 2.5', '0, 0.5, 0'))), depth=4),
        'caustic-of-metal-ball': scene(*stage(sphere(smooth, at=(0, 0.71, -0.2))), lamp(8, size=0.8), depth=5),
        'caustic-of-metal-ring': scene(floor(), shape('cylinder', bsdf('twosided', smooth), p0=point(0, 0, 0),
            p1=point(0, 0.6, 0), radius=0.9), lamp(8, size=0.6), depth=6,
            camera=perspective(to_world=look('0, 2.5, 2.5', '0, 0, 0'))),
    }
