# SPDX-License-Identifier: Apache-2.0
"""Integrators and how deep paths go."""
from rows.row import table
from scene_text import *


def rows():
    return table('integrators', _scenes())


def _with(path, *more):
    lit = sphere(area(12), at=(0.8, 1.2, 0.5), radius=0.2)
    ball = sphere(bsdf('plastic', diffuse_reflectance=rgb(0.5, 0.2, 0.2)), at=(-0.6, 0.5, 0), radius=0.5)
    return scene(*stage(ball, lit), *more, path=path)


def _inside(depth):
    """A room with a lamp on its far wall."""
    shining = rectangle(area(6), diffuse(0), at=(0.6, 1.6, -2.9), size=0.5)
    return scene(*room(diffuse(0.7), shining), depth=depth, camera=perspective(to_world=INSIDE))


def _scenes():
    depths = {f'max-depth-{depth}': _with(integrator('path', max_depth=depth)) for depth in (1, 2, 3, 8)}
    rooms = {f'room-depth-{depth}': _inside(depth) for depth in (1, 2, 3, 4, 10)}
    return {
        **depths,
        **rooms,
        'max-depth-0': (_with(integrator('path', max_depth=0)), dict(supported=False)),   # a black picture
        'max-depth-endless': _with(integrator('path', max_depth=-1, rr_depth=100)),
        'russian-roulette': _with(integrator('path', max_depth=12, rr_depth=3)),
        'default': _with(integrator('path')),
        'direct': _with(integrator('direct')),
        'direct-in-room': scene(*room(diffuse(0.7)), point_light(4, at=(0.5, 2, 0)), path=integrator('direct'),
            camera=perspective(to_world=INSIDE)),
        'direct-samples': _with(integrator('direct', emitter_samples=4, bsdf_samples=2)),
        'hide-emitters-area': _with(integrator('path', max_depth=5, hide_emitters=True)),
        'hide-emitters-constant': scene(box(diffuse(0.6)), constant(),
            path=integrator('path', max_depth=5, hide_emitters=True)),
        'hide-emitters-envmap': scene(floor(size=1.2), box(diffuse(0.6)), envmap(),
            path=integrator('path', max_depth=5, hide_emitters=True)),
        'hide-emitters-in-mirror': scene(floor(), rectangle(bsdf('conductor', material='none'), at=(0, 0, -1.5), size=4),
            sphere(area(3), at=(0.8, 0.8, 0), radius=0.3), box(diffuse(0.6), at=(-0.6, 0.5, 0)),
                                         path=integrator('path', max_depth=5, hide_emitters=True)),
        'hide-emitters-behind-glass': scene(*stage(), sphere(area(3), at=(0.8, 0.8, 0), radius=0.3),
            rectangle(bsdf('thindielectric'), at=(0, 1, 1), size=1),
            path=integrator('path', max_depth=5, hide_emitters=True)),
        'direct-hide-emitters': _with(integrator('direct', hide_emitters=True)),
        'volpath': (_with(integrator('volpath', max_depth=5)), dict(supported=False)),
        'ptracer': (scene(*stage(), point_light(), path=integrator('ptracer', max_depth=5)),
            dict(supported=False, spp=2048)),
        'depth-through-glass': scene(*stage(), rectangle(bsdf('dielectric'), at=(0, 1, 1.0), size=1.5),
            rectangle(bsdf('dielectric'), at=(0, 1, 0.9), size=1.5, turned=[turn('y', 180)]), lamp(), depth=4),
        'depth-in-mirror': scene(floor(), rectangle(bsdf('conductor', material='none'), at=(0, 0, -1.5), size=4),
            box(diffuse(0.6)), lamp(), depth=3),
    }
