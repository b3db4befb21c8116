# SPDX-License-Identifier: Apache-2.0
"""Rooms made by chance: features meet that no table puts together. Row chance/N is the same room in every run.

No map lies within another, since nearlight, which warns of that, lacks a part of it. Three things are left out where
Mitsuba 3.9 is wrong: its path integrator drops the light of paths that pass a mask and leave a scene without environment,
so each room has one; its bump map hands on a frame in local coordinates as if it were in world space, which a bump map
within shows; its blends lose light of smooth materials (docs/mitsuba-support.md), so they have none.
"""
from random import Random

from rows.row import Row
from scene_text import *

WRAPPERS = ('twosided', 'mask', 'blendbsdf', 'normalmap', 'bumpmap')
MAPS = ('normalmap', 'bumpmap')
EXCLUDED = {'bumpmap': MAPS, 'normalmap': MAPS, 'blendbsdf': ('plastic',), 'twosided': ('mask',)}   # from what is within
WALLS = ('diffuse', 'diffuse', 'plastic', 'roughplastic', 'roughconductor', 'principled')
THINGS = WALLS + ('conductor', 'dielectric', 'roughdielectric', 'thindielectric', 'principled-glass')
METALS = ('Au', 'Cu', 'Al', 'Cr')
FACETS = ('ggx', 'beckmann')
MESHES = ('ball.obj', 'fine_ball.obj', 'ball_flat.obj', 'wave.obj')


def rows(seeds):
    return [Row(f'chance/{seed}', _scene(Random(seed)), spp=512) for seed in seeds]


def _number(random, low, high):
    return round(random.uniform(low, high), 3)


def _color(random, high=0.8):
    return rgb(*(_number(random, 0.1, high) for _ in range(3)))


def _paint(random):
    """A reflectance: a colour or a texture."""
    return random.choice((_color(random), _color(random), bitmap('tiles.png'), texture('checkerboard', color0=_color(random),
                                                                                      color1=_color(random))))


def _roughness(random):
    return dict(alpha=_number(random, 0.08, 0.6), distribution=random.choice(FACETS))


def _textured(random, low, high):
    """A number, which may be a texture."""
    return random.choice((_number(random, low, high), _number(random, low, high), bitmap('rough.png', raw=True)))


def _leaf(random, kind):
    ior = _number(random, 1.3, 1.8)
    return {
        'diffuse': lambda: bsdf('diffuse', reflectance=_paint(random)),
        'plastic': lambda: bsdf('plastic', diffuse_reflectance=_paint(random), int_ior=ior, nonlinear=random.random() < 0.5),
        'roughplastic': lambda: bsdf('roughplastic', diffuse_reflectance=_paint(random), int_ior=ior, **_roughness(random)),
        'conductor': lambda: bsdf('conductor', material=random.choice(METALS)),
        'roughconductor': lambda: bsdf('roughconductor', material=random.choice(METALS), distribution=random.choice(FACETS),
                                       alpha=_textured(random, 0.08, 0.6)),
        'dielectric': lambda: bsdf('dielectric', int_ior=ior),
        'roughdielectric': lambda: bsdf('roughdielectric', int_ior=ior, **_roughness(random)),
        'thindielectric': lambda: bsdf('thindielectric', int_ior=ior),
        'principled': lambda: bsdf('principled', base_color=_paint(random), roughness=_textured(random, 0.2, 0.9),
                                   metallic=random.choice((0.0, 0.3, 1.0)), specular=_number(random, 0.1, 0.9),
                                   clearcoat=random.choice((0.0, 0.7)), sheen=random.choice((0.0, 0.5))),
        'principled-glass': lambda: bsdf('principled', base_color=_color(random), roughness=_number(random, 0.2, 0.6),
                                         spec_trans=_number(random, 0.3, 1.0)),
    }[kind]()


def _material(random, kinds, nesting=2, wrappers=WRAPPERS):
    """A material, with up to `nesting` of the materials around it that stand for others."""
    kind = random.choice(kinds)
    if nesting == 0 or random.random() < 0.55:
        return _leaf(random, kind)
    wrapper = random.choice(wrappers)
    excluded = EXCLUDED.get(wrapper, ())
    inner = _material(random, tuple(k for k in WALLS if k in kinds and k not in excluded), nesting - 1,
                      tuple(w for w in wrappers if w not in excluded))
    if wrapper == 'mask':
        return bsdf('mask', inner, opacity=random.choice((_number(random, 0.3, 0.9), bitmap('leaf.png', raw=True))))
    if wrapper == 'blendbsdf':
        return bsdf('blendbsdf', inner, _leaf(random, 'diffuse'), weight=_number(random, 0.2, 0.8))
    if wrapper == 'normalmap':
        return bsdf('normalmap', inner, normalmap=bitmap('normals.png', raw=True))
    if wrapper == 'bumpmap':
        return bsdf('bumpmap', bitmap('hills.png', raw=True), inner, scale=_number(random, 0.5, 2.0))
    return bsdf('twosided', inner)


def _light(random):
    at = (_number(random, -1, 1), _number(random, 2.2, 2.7), _number(random, -1, 1.5))
    return random.choice((
        lambda: rectangle(area(_number(random, 4, 12)), diffuse(0), at=at, size=_number(random, 0.2, 0.6), turned=DOWN),
        lambda: sphere(area(_number(random, 5, 15)), at=at, radius=_number(random, 0.1, 0.25)),
        lambda: point_light(_number(random, 3, 8), at=at),
        lambda: emitter('spot', intensity=rgb(_number(random, 10, 30)), cutoff_angle=_number(random, 30, 60),
                        to_world=transform(look(', '.join(map(str, at)), '0, 0.3, -0.5', up='0, 0, 1'))),
    ))()


def _thing(random):
    at = (_number(random, -1.2, 1.2), _number(random, 0.5, 1.2), _number(random, -1.5, 0.5))
    material = _material(random, THINGS)
    return random.choice((
        lambda: sphere(material, at=at, radius=_number(random, 0.3, 0.5)),
        lambda: box(material, at=at, size=_number(random, 0.2, 0.4), degrees=_number(random, 0, 90)),
        lambda: mesh(random.choice(MESHES), material,
                     to_world=place(_number(random, 0.3, 0.5), at, turn('x', random.randint(0, 90)))),
    ))()


def _scene(random):
    sides = {side: _material(random, WALLS, 1) for side in random.sample(sorted(SIDES), 3)}
    things = [_thing(random) for _ in range(random.randint(1, 3))]
    lights = [_light(random) for _ in range(random.randint(1, 2))]
    if random.random() < 0.4:
        sides[random.choice(('right', 'front', 'ceiling'))] = None   # a side that is open
        lights.append(random.choice((constant(_number(random, 0.3, 1.5)), envmap())))
    else:
        lights.append(constant(0.05))
    return scene(*room(diffuse(_number(random, 0.3, 0.8)), *lights, *things, **sides), depth=random.randint(2, 12),
                 camera=_camera(random))


def _camera(random):
    if random.random() < 0.8:
        return perspective(to_world=INSIDE)
    return sensor('thinlens', picture(), to_world=transform(INSIDE), fov=42.0, aperture_radius=_number(random, 0.02, 0.1),
                  focus_distance=_number(random, 2, 4))
