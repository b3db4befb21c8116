# SPDX-License-Identifier: Apache-2.0
"""Scenes that nearlight is given wrong on purpose. The comparison must say that they deviate."""
from rows.row import Row
from scene_text import *


def rows():
    right = scene(*stage(), point_light(), depth=4)
    paler = scene(floor(diffuse(*(round(1.03 * c, 6) for c in (0.5, 0.45, 0.4)))), wall(diffuse(*(round(1.03 * c, 6) for c in (0.4, 0.45, 0.5)))),
                  box(diffuse(*(round(1.03 * c, 6) for c in (0.6, 0.3, 0.2)))), point_light(), depth=4)
    in_color = right.replace('value="0.5, 0.45, 0.4"', 'value="0.485, 0.4635, 0.4"')
    mirrored = right.replace('<perspective', '<perspective').replace(VIEW, '<scale x="-1" y="1" z="1"/>' + VIEW)
    shadow = right.replace('<rotate y="1" angle="30"/>', '<rotate y="1" angle="75"/>')
    plants = {'reflectance-3-percent': paler, 'colour-3-percent': in_color, 'mirrored': mirrored, 'box-turned': shadow}
    return [Row(f'planted/{name}', right, fast=name == 'reflectance-3-percent', planted=wrong) for name, wrong in plants.items()]
