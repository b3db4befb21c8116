# SPDX-License-Identifier: Apache-2.0
"""Each emitter above the same stage."""
from rows.row import table
from scene_text import *

DAY = dict(latitude=48.0, longitude=11.0, timezone=2.0, year=2020, month=6, day=21, hour=14.0)
TO_SKY = transform(turn('x', -90))   # Mitsuba's skies have their zenith at +z


def rows():
    return table('emitters', {**_points(), **_areas(), **_skies()})


def _lit(*lights, **options):
    return scene(*stage(), *lights, **options)


def _spot(*children, at=(1.2, 2.8, 2.5), **properties):
    return emitter('spot', *children, to_world=transform(look(', '.join(map(str, at)), '0, 0.3, 0')), **properties)


def _points():
    return {
        'point': _lit(point_light()),
        'point-coloured': _lit(emitter('point', position=point(1, 2, 2), intensity=rgb(9, 4, 1))),
        'point-to-world': _lit(emitter('point', to_world=transform(move(1, 2, 2)), intensity=rgb(9))),
        'point-near-wall': _lit(emitter('point', position=point(0.9, 1.2, -1.2), intensity=rgb(3))),
        'points-five': _lit(*(emitter('point', position=point(x, 1.8 + 0.2 * x, 1), intensity=rgb(3 + x, 3, 3 - x))
            for x in (-2, -1, 0, 1, 2))),
        'spot': _lit(_spot(intensity=rgb(40))),
        'spot-wide': _lit(_spot(intensity=rgb(20), cutoff_angle=60.0, beam_width=5.0)),
        'spot-hard-edge': _lit(_spot(intensity=rgb(40), cutoff_angle=18.0, beam_width=17.9)),
        'spot-textured': _lit(_spot(texture=bitmap('slide.png'), intensity=rgb(60), cutoff_angle=25.0, beam_width=25.0)),
        'projector': _lit(emitter('projector', to_world=transform(look('1.2, 2.2, 3', '0, 0.5, 0')),
            irradiance=bitmap('slide.png'), scale=60.0, fov=40.0)),
        'projector-constant': _lit(emitter('projector', to_world=transform(look('1.2, 2.2, 3', '0, 0.5, 0')),
            irradiance=rgb(1, 0.8, 0.5), scale=40.0, fov=30.0)),
        'directional': _lit(emitter('directional', direction=vector(-0.4, -1, -0.5), irradiance=rgb(2, 1.8, 1.5))),
        'directional-to-world': _lit(emitter('directional', to_world=transform(look('1, 3, 2', '0, 0, 0')),
            irradiance=rgb(2))),
        'directional-and-sky': _lit(emitter('directional', direction=vector(0.4, -1, -0.5), irradiance=rgb(2)),
            constant(0.3)),
    }


def _areas():
    above = dict(to_world=place(0.4, (0.8, 2.6, 1), turn('x', 90)))
    return {
        'area-rectangle': _lit(lamp()),
        'area-rectangle-near': _lit(rectangle(area(4), diffuse(0), at=(0.3, 1.3, 0.2), size=0.6, turned=DOWN)),
        'area-by-reference': _lit(with_id('lamp', area(14)), shape('rectangle', ref('lamp'), diffuse(0), **above)),
        'area-disk': _lit(shape('disk', area(14), **above)),
        'area-sphere': _lit(sphere(area(5), at=(1, 2.4, 1), radius=0.4)),
        'area-sphere-in-view': _lit(sphere(area(3), at=(0.8, 0.8, 0.8), radius=0.25)),
        'area-cylinder': _lit(shape('cylinder', area(6), p0=point(-1, 2.4, 1), p1=point(1, 2.4, 1), radius=0.15)),
        'area-cylinder-in-view': _lit(shape('cylinder', area(4), p0=point(0.5, 0.15, 0.9), p1=point(1.1, 1.5, 0.2),
            radius=0.12)),
        'area-cube': _lit(shape('cube', area(4), to_world=place(0.3, (1, 2.4, 1), turn('y', 20)))),
        'area-obj': _lit(mesh('ball.obj', area(5), to_world=place(0.4, (1, 2.4, 1)))),
        'area-ply': _lit(mesh('ball_flat.ply', area(5), to_world=place(0.4, (1, 2.4, 1)))),
        'area-mesh-many-triangles': _lit(mesh('fine_ball.obj', area(5), to_world=place(0.4, (1, 2.4, 1)))),
        'area-wave': _lit(mesh('wave.obj', area(8), to_world=place(0.6, (0.5, 2.4, 1), turn('x', 90)))),
        'area-ply-face-normals': _lit(mesh('ball_flat.ply', area(5), to_world=place(0.4, (1, 2.4, 1)), face_normals=True)),
        'area-wave-face-normals': _lit(mesh('wave.obj', area(8), to_world=place(0.6, (0.5, 2.4, 1), turn('x', 90)),
            face_normals=True)),
        'area-many-spheres': _lit(*(sphere(area(4 + 3 * (i % 3)), at=(-1.5 + i % 4, 2.2, -0.3 + 0.9 * (i // 4)),
            radius=0.05 + 0.03 * (i % 2)) for i in range(12)), lamp(2)),
        'area-textured': _lit(rectangle(emitter('area', radiance=bitmap('lamp.exr', raw=True)), diffuse(0),
            at=(0.4, 2.2, 0.8), size=0.7, turned=DOWN)),
        'area-textured-in-view': _lit(rectangle(emitter('area', radiance=bitmap('slide.png')), diffuse(0),
            at=(0, 1.6, -1.2), size=0.7), lamp(3)),
        'area-textured-sphere': _lit(sphere(emitter('area', radiance=bitmap('lamp.exr', raw=True)), at=(1, 2.4, 1),
            radius=0.4)),
        'area-mirrored-by-scale': _lit(shape('rectangle', area(10), diffuse(0),
            to_world=place((0.5, 0.5, -0.5), (0.8, 2.6, 1), turn('x', 90))), point_light(3)),
        'area-cube-mirrored': _lit(shape('cube', area(4), to_world=place((0.3, 0.3, -0.3), (1, 2.4, 1)))),
        'area-sphere-mirrored': _lit(shape('sphere', area(4), to_world=place((-0.4, 0.4, 0.4), (1, 2.4, 1))),
            point_light(3)),
        'area-flipped': _lit(rectangle(area(10), diffuse(0), at=(0.8, 2.6, 1), size=0.5, turned=UP, flip_normals=True)),
        'area-back-side': _lit(rectangle(area(10), diffuse(0.5), at=(0, 1.5, 0.3), size=0.3, turned=[turn('y', 180)]),
            point_light(2)),
        'area-many': _lit(*(rectangle(area(6 + 3 * (i % 3)), diffuse(0),
            at=(-1.75 + 0.5 * (i % 8), 2.4, -0.5 + 0.5 * (i // 8)), size=0.05, turned=DOWN) for i in range(48))),
        'area-without-bsdf': scene(*room(diffuse(0.5), rectangle(area(1), at=(0, 2.9, 0), size=1.5, turned=DOWN)),
            depth=6, camera=perspective(to_world=INSIDE)),
        'area-reflects': _lit(rectangle(area(3), diffuse(0.8), at=(0, 1, -1.2), size=0.6), lamp(6)),
        'area-weights': _lit(lamp(), rectangle(emitter('area', radiance=rgb(5), sampling_weight=0.1), diffuse(0),
            at=(-1, 2.2, 0.5), size=0.3, turned=DOWN)),
        'directionalarea': (_lit(rectangle(emitter('directionalarea', radiance=rgb(2)), diffuse(0), at=(0.2, 2.6, 0.2),
            size=1, turned=DOWN), point_light(3)), dict(supported=False)),
    }


def _skies():
    def sky(kind, **properties):
        return emitter(kind, **{**dict(to_world=TO_SKY, turbidity=3.0, albedo=rgb(0.3)), **properties})
    sun = vector(0.4, 0.7, 0.5)
    return {
        'constant': _lit(constant()),
        'constant-coloured': _lit(emitter('constant', radiance=rgb(0.9, 0.5, 0.2))),
        'envmap': _lit(envmap()),
        'envmap-turned': _lit(envmap(to_world=transform(turn('y', 70)))),
        'envmap-tilted': _lit(envmap(to_world=transform(turn('x', 40), turn('y', 200)))),
        'envmap-scaled': _lit(envmap(scale=2.5)),
        'envmap-mirrored': _lit(envmap(to_world=transform(scale(-1, 1, 1), turn('y', 30)))),
        'envmap-sun': _lit(envmap('sunny.exr')),
        'envmap-odd-size': _lit(envmap('odd.exr')),
        'envmap-alone': scene(envmap('sky.exr')),
        'envmap-and-point': _lit(envmap(), point_light()),
        'envmap-through-window': scene(*room(diffuse(0.6), right=None), envmap(), depth=6,
            camera=perspective(to_world=INSIDE)),
        'sky': _lit(sky('sunsky', sun_scale=0.0, sun_direction=sun)),
        'sun': _lit(sky('sunsky', sky_scale=0.0, sun_direction=sun)),
        'sunsky': _lit(sky('sunsky', sun_direction=sun)),
        'sunsky-low-sun': _lit(sky('sunsky', sun_direction=vector(0.5, 0.12, 0.8))),
        'sunsky-after-sunset': _lit(sky('sunsky', sun_direction=vector(0.5, -0.2, 0.8)), point_light(3)),
        'sunsky-hazy': _lit(sky('sunsky', sun_direction=sun, turbidity=8.0, albedo=rgb(0.1, 0.4, 0.2))),
        'sunsky-large-sun': _lit(sky('sunsky', sun_direction=sun, sun_aperture=5.0)),
        'sunsky-complex-sun': _lit(sky('sunsky', sun_direction=sun, complex_sun=True)),
        'sunsky-place-and-time': _lit(sky('sunsky', **DAY)),
        'sunsky-turned': _lit(sky('sunsky', sun_direction=sun, to_world=transform(turn('x', -90), turn('y', 120)))),
    }
