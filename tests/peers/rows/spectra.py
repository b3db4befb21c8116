# SPDX-License-Identifier: Apache-2.0
"""Colours: how spectra of lights and materials become RGB. Mitsuba itself has no blackbody in its RGB variants."""
from rows.row import table
from scene_text import *

RISING = '400:0.1, 500:0.3, 600:0.6, 700:0.8'


def rows():
    return table('spectra', {**_lights(), **_materials()})


def _light(intensity):
    return scene(*stage(), emitter('point', position=point(1.5, 2.5, 2), intensity=intensity), depth=2)


def _paint(reflectance):
    return scene(*stage(box(bsdf('diffuse', reflectance=reflectance))), point_light(), depth=2)


def _plugin(kind, **properties):
    return spectrum_plugin(kind, **properties)


def _lights():
    lamp_of = lambda radiance: scene(*stage(), rectangle(emitter('area', radiance=radiance), diffuse(0), at=(0.8, 2.6, 1),
        size=0.5, turned=DOWN), depth=2)
    return {
        'light-rgb': _light(rgb(9, 6, 3)),
        'light-spectrum-constant': _light(spectrum(9)),
        'light-spectrum-pairs': _light(spectrum('400:4, 500:8, 600:12, 700:10')),
        'light-uniform': _light(_plugin('uniform', value=9.0)),
        'light-d65': _light(_plugin('d65')),
        'light-d65-scaled': lamp_of(_plugin('d65', scale=5.0)),
        'light-d65-coloured': lamp_of(_plugin('d65', color=rgb(0.9, 0.5, 0.2))),
        'sky-spectrum': scene(*stage(), emitter('constant', radiance=spectrum(RISING)), depth=2),
    }


def _materials():
    return {
        'paint-rgb': _paint(rgb(0.7, 0.4, 0.2)),
        'paint-spectrum-constant': _paint(spectrum(0.4)),
        'paint-spectrum-pairs': _paint(spectrum(RISING)),
        'paint-uniform': _paint(_plugin('uniform', value=0.4)),
        'metal-spectrum': scene(sphere(bsdf('conductor', eta=spectrum('400:1.4, 500:0.9, 600:0.3, 700:0.2'),
            k=spectrum('400:1.9, 500:2.1, 600:3.0, 700:3.8')), radius=1.2), constant(), depth=2),
    }
