# SPDX-License-Identifier: Apache-2.0
"""How files are written: versions, names, defaults."""
from rows.row import table
from scene_text import *


def rows():
    return table('files', _scenes())


def _scenes():
    plain = scene(*stage(), point_light(), depth=4)
    old = plain.replace('version="3.0.0"', 'version="0.6.0"').replace('to_world', 'toWorld').replace('max_depth', 'maxDepth')
    return {
        'version-0.6': old,
        'version-2': plain.replace('version="3.0.0"', 'version="2.1.0"'),
        'parameters': scene(Element('<default name="brightness" value="8"/>'), *stage(), point_light('$brightness'),
            depth=4),
        'materials-by-reference': scene(with_id('clay', diffuse(0.6, 0.3, 0.2)),
            with_id('metal', bsdf('twosided', bsdf('roughconductor', material='Cu', alpha=0.3))),
                                        *stage(box(ref('clay'), at=(-0.6, 0.5, 0), size=0.4),
                                            box(ref('metal'), at=(0.6, 0.5, 0), size=0.4)), point_light(), depth=4),
        'without-bsdf': scene(floor(), wall(), shape('sphere', center=point(0, 0.7, 0), radius=0.7), point_light(), depth=4),
    }
