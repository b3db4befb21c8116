# SPDX-License-Identifier: Apache-2.0
"""How files are written: versions, names, defaults."""
from rows.row import table
from scene_text import *


def rows():
    return table('files', _scenes())


def _scenes():
    plain = scene(*stage(), point_light(), depth=4)
    old = plain.replace('version="3.0.0"', 'version="0.6.0"')
    for name, camel in (('to_world', 'toWorld'), ('max_depth', 'maxDepth'), ('reflectance', 'reflectance')):
        old = old.replace(f'name="{name}"', f'name="{camel}"')
    return {
        'version-0.6': old,
        'version-2': plain.replace('version="3.0.0"', 'version="2.1.0"'),
        'defaults': plain.replace('<integer name="max_depth" value="4"/>', '<integer name="max_depth" value="$depth"/>').replace('<scene version="3.0.0">', '<scene version="3.0.0">\n<default name="depth" value="3"/>'),
        'materials-by-reference': scene(with_id('clay', diffuse(0.6, 0.3, 0.2)), with_id('metal', bsdf('twosided', bsdf('roughconductor', material='Cu', alpha=0.3))),
                                        *stage(box(ref('clay'), at=(-0.6, 0.5, 0), size=0.4), box(ref('metal'), at=(0.6, 0.5, 0), size=0.4)), point_light(), depth=4),
        'without-bsdf': scene(floor(), wall(), shape('sphere', center=point(0, 0.7, 0), radius=0.7), point_light(), depth=4),
        'without-light': scene(floor(), wall(), path=integrator('path', max_depth=3)),
    }
