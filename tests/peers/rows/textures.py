# SPDX-License-Identifier: Apache-2.0
"""Textures on a sheet that fills most of the picture, in direct light."""
from rows.row import table
from scene_text import *


def rows():
    return table('textures', {**_bitmaps(), **_others()}, block=4)


def _on_sheet(reflectance):
    return scene(floor(), wall(), rectangle(bsdf('diffuse', reflectance=reflectance), at=(0, 1, 0), size=1.1),
        point_light(), depth=2)


def _on_mesh(name, reflectance):
    sheet = mesh(name, bsdf('twosided', bsdf('diffuse', reflectance=reflectance)), to_world=place(1.1, (0, 1, 0)))
    return scene(floor(), wall(), sheet, point_light(), depth=2)


def _bitmaps():
    beyond = transform(move(-0.3, -0.3, 0), scale(1.9))
    tiles = lambda **p: _on_sheet(bitmap('tiles.png', **p))
    wraps = {f'bitmap-wrap-{mode}': tiles(wrap_mode=mode, to_uv=beyond) for mode in ('repeat', 'mirror', 'clamp')}
    return {
        'bitmap': tiles(),
        'bitmap-nearest': tiles(filter_type='nearest'),
        'bitmap-bilinear': tiles(filter_type='bilinear'),
        **wraps,
        'bitmap-wrap-clamp-nearest': tiles(wrap_mode='clamp', filter_type='nearest', to_uv=beyond),
        'bitmap-to-uv-turned': tiles(to_uv=transform(scale(2), turn('z', 30))),
        'bitmap-raw': tiles(raw=True),
        'bitmap-grey': _on_sheet(bitmap('grey.png')),
        'bitmap-smooth': _on_sheet(bitmap('wood.png')),
        'bitmap-exr': _on_sheet(bitmap('linear.exr')),
        'bitmap-exr-above-one': _on_sheet(bitmap('bright.exr')),
        'bitmap-exr-above-one-raw': _on_sheet(bitmap('bright.exr', raw=True)),
        'bitmap-exr-grey': _on_sheet(bitmap('grey.exr', raw=True)),
        'bitmap-on-sphere': scene(*stage(sphere(bsdf('diffuse', reflectance=bitmap('tiles.png')))), point_light(), depth=2),
        'bitmap-on-cylinder': scene(*stage(shape('cylinder', bsdf('diffuse', reflectance=bitmap('tiles.png')),
            p0=point(0, 0, 0), p1=point(0, 1.4, 0), radius=0.5)), point_light(), depth=2),
        'bitmap-on-disk': scene(*stage(shape('disk', bsdf('diffuse', reflectance=bitmap('tiles.png')),
            to_world=transform(move(0, 0.9, 0)))), point_light(), depth=2),
        'bitmap-on-cube': scene(*stage(box(bsdf('diffuse', reflectance=bitmap('tiles.png')))), point_light(), depth=2),
        'bitmap-on-obj': scene(*stage(mesh('fine_ball.obj', bsdf('diffuse', reflectance=bitmap('tiles.png')),
            to_world=place(0.7, (0, 0.72, 0)))), point_light(), depth=2),
        'bitmap-on-obj-unflipped': scene(*stage(mesh('fine_ball.obj', bsdf('diffuse', reflectance=bitmap('tiles.png')),
            flip_tex_coords=False, to_world=place(0.7, (0, 0.72, 0)))), point_light(), depth=2),
        'bitmap-on-ply': _on_mesh('wave_colors.ply', bitmap('tiles.png')),
    }


def _others():
    checks = lambda *c, **p: texture('checkerboard', *c, **p)
    fine = transform(scale(6))
    return {
        'checkerboard': _on_sheet(checks(to_uv=fine, color0=rgb(0.1, 0.2, 0.3), color1=rgb(0.8, 0.7, 0.5))),
        'checkerboard-default': _on_sheet(checks()),
        'checkerboard-of-bitmaps': _on_sheet(checks(to_uv=fine, color0=bitmap('tiles.png'), color1=bitmap('wood.png'))),
        'checkerboard-turned': _on_sheet(checks(to_uv=transform(scale(5), turn('z', 25)), color0=rgb(0.1), color1=rgb(0.8))),
        'mesh-attribute-vertex': _on_mesh('wave_colors.ply', texture('mesh_attribute', name_property('vertex_color'))),
        'mesh-attribute-vertex-scaled': _on_mesh('wave_colors.ply',
            texture('mesh_attribute', name_property('vertex_color'), scale=0.5)),
        'mesh-attribute-vertex-bytes': _on_mesh('wave_color_bytes.ply', texture('mesh_attribute', name_property('vertex_color'))),
        'mesh-attribute-face': _on_mesh('wave_face_colors.ply', texture('mesh_attribute', name_property('face_color'))),
        'reference-by-id': scene(with_id('paint', bitmap('tiles.png')),
            with_id('painted', bsdf('diffuse', reflectance=ref('paint'))), floor(), wall(),
                                 rectangle(ref('painted'), at=(0, 1, 0), size=1.1), point_light(), depth=2),
    }


def name_property(value):
    return Element(f'<string name="name" value="{value}"/>')
