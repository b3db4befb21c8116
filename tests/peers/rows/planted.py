# SPDX-License-Identifier: Apache-2.0
"""Scenes that nearlight is given wrong on purpose. The comparison must say that they deviate."""
from rows.row import Row
from scene_text import *


def rows():
    right = _scene()
    plants = {
        'reflectance-3-percent': _scene(paler=(1.03, 1.03, 1.03)),
        'colour-5-percent': _scene(paler=(0.95, 1.05, 1)),
        'mirrored': _scene(view=scale(-1, 1, 1) + VIEW),
        'box-turned': _scene(degrees=75),
    }
    return [Row(f'planted/{name}', right, planted=wrong) for name, wrong in plants.items()]


def _scene(paler=(1, 1, 1), view=VIEW, degrees=30):
    def paint(*color):
        return diffuse(*(round(c * factor, 6) for c, factor in zip(color, paler)))
    things = (floor(paint(0.5, 0.45, 0.4)), wall(paint(0.4, 0.45, 0.5)), box(paint(0.6, 0.3, 0.2), degrees=degrees))
    return scene(*things, point_light(), depth=4, camera=perspective(to_world=view))
