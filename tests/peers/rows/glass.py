# SPDX-License-Identifier: Apache-2.0
"""Light through glass. A point light does not shine through it in a path tracer; emitters with a surface do."""
from rows.emitters import TO_SKY
from rows.row import table
from scene_text import *


def rows():
    return table('glass', {**_scenes(), **_veils()}, spp=1024)


def _pane(material, at=(0.8, 2.0, 1.0), size=1.2, turned=None):
    return rectangle(material, at=at, size=size, turned=turned or UP)


def _slab(at=(0, 1, 2.2), size=(1.5, 1.5, 0.05)):
    return shape('cube', bsdf('dielectric'), to_world=place(size, at))


def window_room(pane, light, depth=8):
    """A closed room with a window of 1.2 by 1.2 in its right side, glazed with `pane`, where one is given."""
    right = [turn('y', -90)]
    frame = [rectangle(diffuse(0.6), turned=[scale(*size)] + right, at=(2, *at), size=1) for size, at in (
        ((4, 2, 1), (-1.1, 0)), ((4, 2, 1), (4.1, 0)), ((1.7, 0.6, 1), (1.5, -2.3)), ((1.7, 0.6, 1), (1.5, 2.3)))]
    glazing = () if pane is None else (rectangle(pane, turned=right, at=(2, 1.5, 0), size=0.62),)
    return scene(*room(diffuse(0.6), *frame, *glazing, box(diffuse(0.7, 0.4, 0.3), at=(-0.6, 0.5, -1)), light, right=None),
        depth=depth, camera=perspective(to_world=INSIDE))


def _veils():
    """Light straight through panes and masks, which light samples and rays share."""
    thin = bsdf('thindielectric')
    green = diffuse(0.2, 0.6, 0.2)
    leaf = bsdf('mask', bsdf('twosided', green), opacity=bitmap('leaf.png', raw=True))
    half = bsdf('mask', bsdf('twosided', green), opacity=0.5)
    blend = bsdf('blendbsdf', bsdf('null'), bsdf('twosided', green), weight=0.3)
    sun = emitter('sunsky', to_world=TO_SKY, sun_direction=vector(0.8, 0.7, 0.1), turbidity=3.0, sun_aperture=20.0)
    steel = bsdf('roughconductor', material='Cr', alpha=0.25)
    def under(veil, depth=6):
        return scene(*stage(), _pane(veil), lamp(size=0.8), depth=depth)
    return {
        'area-behind-leaf': under(leaf),
        'area-behind-half-mask': under(half),
        'area-behind-blend': under(blend),
        'area-behind-blend-of-panes': under(bsdf('blendbsdf', thin, half, weight=0.5)),
        'area-behind-pane-depth-2': under(thin, depth=2),
        'area-behind-pane-depth-3': under(thin, depth=3),
        'area-behind-mask-in-front-of-pane-depth-4': scene(*stage(), _pane(thin), _pane(half, at=(0.8, 1.8, 1)),
            lamp(size=0.8), depth=4),
        'area-behind-ten-panes': scene(*stage(), *(_pane(thin, at=(0.8, 1.2 + 0.1 * i, 1)) for i in range(10)),
            lamp(size=0.8), depth=16),
        'sky-behind-leaves': scene(*stage(), _pane(leaf), _pane(leaf, at=(-0.6, 1.8, 0.8)), envmap(), depth=6),
        'sun-behind-pane': scene(*stage(), _pane(thin, size=3), sun, depth=6),
        'metal-behind-pane': scene(floor(steel), wall(steel), _pane(thin), lamp(size=0.8), depth=6),
        'room-with-window': window_room(None, envmap()),
        'room-with-pane': window_room(thin, envmap()),
        'room-with-tinted-pane': window_room(bsdf('thindielectric', specular_transmittance=rgb(0.9, 0.5, 0.2)), envmap()),
        'room-with-leaf': window_room(leaf, constant(2)),
        'sunlit-room-with-pane': window_room(thin, sun),
    }


def _scenes():
    thin, solid = bsdf('thindielectric'), bsdf('dielectric')
    tinted = bsdf('thindielectric', specular_transmittance=rgb(0.9, 0.5, 0.2))
    inside = perspective(to_world=INSIDE)
    things = (rectangle(area(6), diffuse(0), at=(0, 2.9, 0), size=0.6, turned=DOWN),
        box(diffuse(0.7, 0.4, 0.3), at=(0, 0.5, -1)))
    shining = rectangle(area(2), diffuse(0), at=(0.6, 1.6, -2.9), size=0.5)
    return {
        'point-behind-pane': scene(*stage(), _pane(thin, at=(1, 1.8, 1)), point_light(at=(1.2, 2.8, 1.2)), depth=6),
        'point-behind-slab': scene(*stage(), shape('cube', solid, to_world=place((1.2, 0.03, 1.2), (1, 1.8, 1))),
            point_light(at=(1.2, 2.8, 1.2)), depth=6),
        'point-beside-pane': scene(*stage(), rectangle(thin, at=(0, 0.8, 0.8), size=0.6), point_light(), depth=6),
        'area-behind-pane': scene(*stage(), _pane(thin), lamp(), depth=6),
        'area-behind-tinted-pane': scene(*stage(), _pane(tinted), lamp(), depth=6),
        'area-behind-two-panes': scene(*stage(), _pane(tinted), _pane(thin, at=(0.8, 1.9, 1)), lamp(), depth=8),
        'area-behind-slab': scene(*stage(), shape('cube', solid, to_world=place((1.2, 0.03, 1.2), (0.8, 2, 1))),
            lamp(size=0.8), depth=8),
        'area-behind-rough-pane': scene(*stage(), shape('cube', bsdf('roughdielectric', alpha=0.3),
            to_world=place((1.2, 0.03, 1.2), (0.8, 2, 1))), lamp(size=0.8), depth=8),
        'sky-behind-pane': scene(*stage(), _pane(thin, size=3), envmap(), depth=6),
        'sky-behind-tinted-pane': scene(*stage(), _pane(tinted, size=3), envmap(), depth=6),
        'sky-in-room-with-glass': scene(*room(diffuse(0.6), right=thin), envmap(), depth=6, camera=inside),
        'bulb-in-glass': scene(*stage(sphere(solid, at=(0, 0.9, 0), radius=0.5), sphere(area(6), diffuse(0), at=(0, 0.9, 0),
            radius=0.3)), depth=8),
        'bulb-in-thin-glass': scene(*stage(sphere(thin, at=(0, 0.9, 0), radius=0.5),
            sphere(area(6), diffuse(0), at=(0, 0.9, 0),
            radius=0.3)), depth=8),
        'point-in-glass': scene(*stage(sphere(solid, at=(0, 0.9, 0), radius=0.4)),
            emitter('point', position=point(0, 0.9, 0), intensity=rgb(6)), point_light(2), depth=6),
        'room-through-pane': scene(*room(diffuse(0.6), *things, rectangle(thin, at=(0, 1.5, 2), size=1.6)), depth=6,
            camera=inside),
        'room-through-slab': scene(*room(diffuse(0.6), *things, _slab(at=(0, 1.5, 2))), depth=8, camera=inside),
        'room-through-slab-depth-3': scene(*room(diffuse(0.6), *things, shining, _slab(at=(0, 1.5, 2))), depth=3,
            camera=inside),
        'room-through-slab-depth-4': scene(*room(diffuse(0.6), *things, shining, _slab(at=(0, 1.5, 2))), depth=4,
            camera=inside),
        'glass-ball-caustic': scene(*stage(sphere(solid, at=(0, 0.8, 0), radius=0.5)), lamp(8, size=0.9), depth=8),
        'glass-ball-in-room': scene(*room(diffuse(0.6), *things[:1], sphere(solid, at=(0, 0.7, -0.5), radius=0.6)),
            depth=8, camera=inside),
        'diamond-without-limit': scene(*stage(mesh('fine_ball.obj', bsdf('dielectric', int_ior='diamond'),
            to_world=place((0.9, 0.35, 0.6), (0, 0.7, 0), turn('z', 25)))), lamp(size=0.9), envmap(), depth=-1),
        'water': scene(floor(size=2), wall(), rectangle(bsdf('dielectric', int_ior='water'), at=(0, 0.4, 0), size=2.5,
            turned=UP), box(diffuse(0.7, 0.3, 0.2), at=(0, 0.3, 0), size=0.3), lamp(8, size=0.9), depth=8),
        'alpha-leaf-shadow': scene(*stage(),
            _pane(bsdf('mask', bsdf('twosided', diffuse(0.2, 0.6, 0.2)), opacity=bitmap('leaf.png', raw=True)),
            at=(0.5, 1.7, 0.8), size=0.7), point_light(), depth=5),
        'half-mask-shadow': scene(*stage(), _pane(bsdf('mask', bsdf('twosided', diffuse(0.2, 0.6, 0.2)), opacity=0.5),
            at=(0.5, 1.7, 0.8), size=0.7), point_light(), depth=5),
        'alpha-leaf-in-room': scene(*room(diffuse(0.7), *things,
            rectangle(bsdf('mask', bsdf('twosided', diffuse(0.2, 0.6, 0.2)), opacity=bitmap('leaf.png', raw=True)),
            at=(0.6, 1.0, 0.8), size=0.5)), depth=6, camera=inside),
        'null-shadow': scene(*stage(), _pane(bsdf('null'), at=(0.5, 1.7, 0.8), size=0.7), point_light(), depth=5),
    }
