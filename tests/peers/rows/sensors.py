# SPDX-License-Identifier: Apache-2.0
"""Sensors, films and reconstruction filters before the same stage in direct light."""
from rows.row import table
from scene_text import *


def rows():
    return table('sensors', _sensors(), block=4) + table('films', _films()) + table('filters', _filters(), spp=2048, block=1,
        options=('--spp', '256'))


def _seen(camera, *more):
    """A textured floor and a small box show where each pixel looks."""
    things = (floor(bsdf('diffuse', reflectance=texture('checkerboard', to_uv=transform(scale(16)),
        color0=rgb(0.2, 0.3, 0.4), color1=rgb(0.7, 0.6, 0.4)))),
              wall(), box(diffuse(0.6, 0.3, 0.2)))
    return scene(*things, point_light(), *more, camera=camera, depth=2)


def _sensors():
    lens = dict(to_world=transform(VIEW), fov=42.0)
    near = box(diffuse(0.8), at=(-0.3, 0.9, 2.5), size=0.25)
    fov = {f'perspective-fov-{axis}': _seen(perspective(fov=35.0, fov_axis=axis))
        for axis in ('x', 'y', 'diagonal', 'smaller', 'larger')}
    return {
        **fov,
        'perspective-fov-smaller-portrait': _seen(perspective(fov=35.0, fov_axis='smaller',
            the_film=picture(width=48, height=64))),
        'perspective-fov-larger-portrait': _seen(perspective(fov=35.0, fov_axis='larger',
            the_film=picture(width=48, height=64))),
        'perspective-focal-length': _seen(sensor('perspective', picture(), to_world=transform(VIEW), focal_length='40mm')),
        'perspective-principal-point': _seen(perspective(principal_point_offset_x=0.15, principal_point_offset_y=-0.2)),
        'perspective-near-clip': _seen(perspective(near_clip=3.8)),
        'perspective-far-clip': _seen(perspective(far_clip=5.0)),
        'perspective-clips-with-sky': _seen(perspective(near_clip=3.8, far_clip=5.2), constant(0.2)),
        'perspective-rolled': _seen(perspective(to_world=look('0, 1.2, 4.2', '0, 0.7, 0', '1, 2, 0'))),
        'perspective-mirrored': _seen(sensor('perspective', picture(), fov=42.0, to_world=transform(scale(-1, 1, 1), VIEW))),
        'thinlens': _seen(sensor('thinlens', picture(), aperture_radius=0.15, focus_distance=4.2, **lens), near),
        'thinlens-near-focus': _seen(sensor('thinlens', picture(), aperture_radius=0.1, focus_distance=1.7, **lens), near),
        'thinlens-pinhole': _seen(sensor('thinlens', picture(), aperture_radius=0.0001, focus_distance=3.0, **lens), near),
        'orthographic': _seen(sensor('orthographic', picture(), to_world=transform(scale(1.5), VIEW))),
        'orthographic-stretched': _seen(sensor('orthographic', picture(), to_world=transform(scale(2, 1.2, 1), VIEW))),
        'orthographic-clips': _seen(sensor('orthographic', picture(), near_clip=3.8, far_clip=5.2,
            to_world=transform(scale(1.5), VIEW))),
    }


def _films():
    def with_film(*filters, **properties):
        return _seen(perspective(the_film=picture(*(filters or [rfilter('box')]), **properties)))

    crop = dict(width=128, height=96, crop_offset_x=24, crop_offset_y=16, crop_width=64, crop_height=48)
    return {
        'plain': with_film(),
        'crop': with_film(**crop),
        'crop-gaussian': with_film(rfilter('gaussian'), **crop),
        'rgba': with_film(pixel_format='rgba'),
        'luminance': with_film(pixel_format='luminance'),
    }


def _filters():
    """Few and large pixels with many samples, compared one by one, so that what a filter does to edges stands out."""
    def filtered(*kind, **properties):
        filters = [rfilter(*kind, **properties)] if kind else []
        return _seen(perspective(the_film=film('hdrfilm', *filters, width=24, height=16)))

    wide = picture(rfilter('gaussian', stddev=1.0), width=24, height=16, sample_border=True)
    return {
        'box': filtered('box'),
        'tent': filtered('tent'),
        'tent-wide': filtered('tent', radius=2.0),
        'gaussian': filtered('gaussian'),
        'gaussian-wide': filtered('gaussian', stddev=1.0),
        'mitchell': filtered('mitchell'),
        'mitchell-sharp': filtered('mitchell', B=0.0, C=0.75),
        'catmullrom': filtered('catmullrom'),
        'lanczos': filtered('lanczos', lobes=3),
        'default': filtered(),
        'gaussian-sample-border': _seen(perspective(the_film=wide)),
    }
