# SPDX-License-Identifier: Apache-2.0
"""Each material on a ball, in an even white surrounding (a furnace, which shows energy made or lost) and under lamps."""
from rows.row import Row
from scene_text import *


def rows():
    return [_row(name, material, light) for name, (material, lights) in {**_plain(), **_metals(), **_clear(),
        **_layered(), **_mixed()}.items()
            for light in lights.split()]


ALL = 'furnace point area sky'
HARD = dict(area=1024)    # reflected lamps need more samples


def _row(name, material, light):
    return Row(f'bsdfs/{name}/{light}', LIGHTS[light](material), spp=HARD.get(light, 256),
               supported=name != 'pplastic')


def _ball(material):
    return sphere(material, at=(0, 0.72, 0))


LIGHTS = {
    'furnace': lambda material: scene(sphere(material, at=(0, 0.7, 0), radius=1.2), constant(1), depth=12),
    'point': lambda material: scene(*stage(_ball(material)), point_light(), depth=4),
    'area': lambda material: scene(*stage(_ball(material)), lamp(8, size=0.8), depth=5),
    'sky': lambda material: scene(*stage(_ball(material)), envmap(), depth=5),
    'mesh': lambda material: scene(*stage(mesh('fine_ball.obj', material, to_world=place(0.7, (0, 0.72, 0)))),
        lamp(8, size=0.8), depth=5),
    'sheet': lambda material: scene(floor(), wall(), rectangle(material, at=(0, 0.9, 0), size=0.8,
        turned=[turn('x', -25)]), lamp(8, size=0.8), envmap(scale=0.3), depth=6),
    'behind': lambda material: scene(floor(), wall(), rectangle(material, at=(0, 0.9, 0), size=0.8,
        turned=[turn('y', 160)]), lamp(8, size=0.8), point_light(6), depth=5),
}


def _plain():
    red, blue = rgb(0.6, 0.2, 0.1), rgb(0.1, 0.2, 0.5)
    plastic = lambda **p: bsdf('plastic', diffuse_reflectance=red, **p)
    rough = lambda **p: bsdf('roughplastic', diffuse_reflectance=red, **p)
    return {
        'diffuse': (diffuse(0.6, 0.3, 0.2), ALL),
        'diffuse-white': (diffuse(1.0), 'area'),
        'diffuse-black': (diffuse(0.0), 'area'),
        'diffuse-default': (bsdf('diffuse'), 'point'),
        'plastic': (plastic(), ALL),
        'plastic-nonlinear': (plastic(nonlinear=True), 'furnace area'),
        'plastic-index': (plastic(int_ior=1.9, ext_ior=1.1), 'furnace'),
        'plastic-named-index': (plastic(int_ior='diamond', ext_ior='air'), 'point'),
        'plastic-tinted': (bsdf('plastic', diffuse_reflectance=blue, specular_reflectance=rgb(0.9, 0.6, 0.3)), 'sky'),
        'plastic-white': (bsdf('plastic', diffuse_reflectance=rgb(1)), 'furnace'),
        'roughplastic': (rough(alpha=0.15), ALL),
        'roughplastic-ggx': (rough(alpha=0.3, distribution='ggx'), 'furnace point'),
        'roughplastic-smooth': (rough(alpha=0.02), 'area'),
        'roughplastic-very-rough': (rough(alpha=0.8), 'furnace'),
        'roughplastic-nonlinear': (rough(alpha=0.2, nonlinear=True, distribution='ggx'), 'furnace point'),
        'roughplastic-index': (rough(alpha=0.2, int_ior=1.9), 'furnace'),
        'roughplastic-textured': (bsdf('roughplastic', diffuse_reflectance=bitmap('tiles.png'),
            specular_reflectance=rgb(0.5), alpha=0.2), 'area'),
        'pplastic': (bsdf('pplastic', diffuse_reflectance=red, alpha=0.2), 'point'),
    }


def _checks(first, second):
    return texture('checkerboard', to_uv=transform(scale(6)), color0=first, color1=second)


def _metals():
    rough = lambda **p: bsdf('roughconductor', **p)
    named = {f'conductor-{m}': (bsdf('conductor', material=m), 'sky') for m in ('Al', 'Ag', 'W', 'none', 'TiO2')}
    return {
        'conductor-Cu': (bsdf('conductor', material='Cu'), 'furnace area'),
        'conductor-Au': (bsdf('conductor', material='Au'), 'sky'),
        **named,
        'conductor-eta-k': (bsdf('conductor', eta=rgb(0.2, 0.9, 1.5), k=rgb(3.9, 2.4, 1.8)), 'furnace'),
        'conductor-tinted': (bsdf('conductor', material='Ag', specular_reflectance=rgb(0.9, 0.5, 0.3)), 'furnace'),
        'conductor-textured': (bsdf('conductor', material='none', specular_reflectance=bitmap('tiles.png')), 'sky'),
        'roughconductor': (rough(material='Al', alpha=0.2), ALL),
        'roughconductor-ggx': (rough(material='Au', alpha=0.3, distribution='ggx'), 'furnace point'),
        'roughconductor-smooth': (rough(material='Cu', alpha=0.03), 'area sky'),
        'roughconductor-very-rough': (rough(material='none', alpha=0.9, distribution='ggx'), 'furnace'),
        'roughconductor-default': (rough(), 'point'),
        'roughconductor-anisotropic': (rough(material='Al', alpha_u=0.05, alpha_v=0.4), 'furnace point area'),
        'roughconductor-anisotropic-ggx': (rough(material='Al', alpha_u=0.4, alpha_v=0.1, distribution='ggx'), 'point mesh'),
        'roughconductor-textured-roughness': (rough(material='Al', alpha=bitmap('rough.png', raw=True),
            distribution='ggx'), 'area'),
        'roughconductor-two-textures': (rough(material='Al', alpha_u=_checks(0.05, 0.3), alpha_v=_checks(0.3, 0.1)), 'mesh'),
        'roughconductor-textured-tint': (rough(material='none', alpha=0.2, specular_reflectance=bitmap('tiles.png')),
            'point'),
        'roughconductor-all-normals': (rough(material='Al', alpha=0.2, sample_visible=False), 'point'),
    }


def _clear():
    return {
        'dielectric': (bsdf('dielectric'), 'furnace area'),
        'dielectric-index': (bsdf('dielectric', int_ior=1.8, ext_ior='water'), 'sky'),
        'dielectric-tinted': (bsdf('dielectric', specular_transmittance=rgb(0.9, 0.5, 0.3),
            specular_reflectance=rgb(0.5, 0.8, 0.9)), 'area'),
        'dielectric-mesh': (bsdf('dielectric'), 'mesh'),
        'roughdielectric': (bsdf('roughdielectric', alpha=0.2), ALL),
        'roughdielectric-ggx': (bsdf('roughdielectric', alpha=0.4, distribution='ggx', int_ior=1.7), 'furnace area'),
        'roughdielectric-smooth': (bsdf('roughdielectric', alpha=0.03), 'sky'),
        'roughdielectric-without-mirror-images': (bsdf('roughdielectric', distribution='ggx', alpha=0.5, specular_reflectance=0.0), 'sky'),
        'roughdielectric-tinted': (bsdf('roughdielectric', alpha=0.2, specular_transmittance=rgb(0.9, 0.5, 0.3)), 'furnace'),
        'roughdielectric-sheet': (bsdf('roughdielectric', alpha=0.2, distribution='ggx'), 'sheet behind'),
        'thindielectric': (bsdf('thindielectric'), 'furnace sheet'),
        'thindielectric-tinted': (bsdf('thindielectric', specular_transmittance=rgb(0.9, 0.5, 0.3),
            specular_reflectance=rgb(0.5, 0.8, 0.9)), 'sheet'),
        'null': (bsdf('null'), 'point area'),
    }


def _layered():
    """Disney's model: one parameter after another."""
    color = dict(base_color=rgb(0.6, 0.3, 0.15))
    principled = lambda **p: bsdf('principled', **{**color, **p})
    return {
        'principled': (principled(), ALL),
        'principled-smooth': (principled(roughness=0.15, specular=0.8), 'area'),
        'principled-metal': (principled(metallic=1.0, roughness=0.3), 'furnace point sky'),
        'principled-half-metal': (principled(metallic=0.5, roughness=0.4, spec_tint=0.5), 'point'),
        'principled-anisotropic': (principled(metallic=1.0, roughness=0.4, anisotropic=0.8), 'point'),
        'principled-glass': (principled(spec_trans=1.0, roughness=0.2, eta=1.4), 'furnace sky'),
        'principled-half-glass': (principled(spec_trans=0.5, roughness=0.3, eta=1.5), 'area'),
        'principled-sheen': (principled(sheen=1.0, sheen_tint=0.5, roughness=0.8), 'point'),
        'principled-flat': (principled(flatness=0.8, roughness=0.5), 'furnace'),
        'principled-clearcoat': (principled(clearcoat=1.0, clearcoat_gloss=0.7, roughness=0.6), 'point'),
        'principled-clearcoat-thinner': (principled(eta=0.8, clearcoat=1.0, clearcoat_gloss=0.2, roughness=0.6), 'point'),
        'principled-half-metal-without-specular': (principled(metallic=0.5, specular=0.0, roughness=0.4), 'point'),
        'principled-eta': (principled(eta=1.8, roughness=0.3), 'furnace'),
        'principled-textured': (bsdf('principled', base_color=bitmap('tiles.png'),
            roughness=bitmap('rough.png', raw=True), metallic=bitmap('grey.png', raw=True)), 'area'),
        'principledthin': (bsdf('principledthin', base_color=rgb(0.6, 0.3, 0.15), diff_trans=1.0, roughness=0.4), 'sheet'),
        'principledthin-textured': (bsdf('principledthin', base_color=rgb(0.6, 0.3, 0.15), diff_trans=_checks(0.4, 1.6)), 'sheet'),
    }


def _mixed():
    red, metal = diffuse(0.7, 0.2, 0.1), bsdf('roughconductor', material='Al', alpha=0.25)
    bump = lambda inner, **p: bsdf('bumpmap', bitmap('hills.png', raw=True), inner, **p)
    normal = lambda inner: bsdf('normalmap', inner, normalmap=bitmap('normals.png', raw=True))
    return {
        'mask': (bsdf('mask', red, opacity=0.4), 'furnace area'),
        'mask-coloured': (bsdf('mask', red, opacity=rgb(0.8, 0.5, 0.2)), 'area'),
        'mask-black': (bsdf('mask', red, opacity=0.0), 'furnace area'),
        'mask-leaf': (bsdf('mask', bsdf('twosided', red), opacity=bitmap('leaf.png', raw=True)), 'sheet'),
        'mask-metal': (bsdf('mask', metal, opacity=0.5), 'sky'),
        'blendbsdf': (bsdf('blendbsdf', red, metal, weight=0.3), 'furnace area'),
        'blendbsdf-textured': (bsdf('blendbsdf', red, bsdf('plastic'), weight=bitmap('grey.png', raw=True)), 'point'),
        'blendbsdf-smooth': (bsdf('blendbsdf', bsdf('conductor', material='Au'), red, weight=0.6), 'area'),
        'twosided': (bsdf('twosided', red), 'point behind'),
        'twosided-two': (bsdf('twosided', red, diffuse(0.1, 0.2, 0.7)), 'behind'),
        'twosided-metal': (bsdf('twosided', metal), 'behind'),
        'onesided': (red, 'behind'),
        'bumpmap': (bump(red, scale=2.0), 'furnace area mesh'),
        'bumpmap-plastic': (bump(bsdf('roughplastic', alpha=0.2), scale=1.0), 'point'),
        'bumpmap-metal': (bump(metal, scale=1.0), 'sky'),
        'bumpmap-mask': (bump(bsdf('mask', red, opacity=0.4), scale=2.0), 'area sheet'),
        'mask-bumpmap': (bsdf('mask', bump(red, scale=2.0), opacity=0.4), 'area sheet'),
        'normalmap': (normal(red), 'furnace point area mesh'),
        'normalmap-constant': (bsdf('normalmap', red, normalmap=texture('rawconstant', value=vector(0.35, 0.45, 0.9))), 'mesh'),
        'normalmap-plastic': (normal(bsdf('plastic')), 'area'),
        'normalmap-metal': (normal(metal), 'sky'),
        'normalmap-twosided': (bsdf('twosided', normal(red)), 'sheet'),
    }
