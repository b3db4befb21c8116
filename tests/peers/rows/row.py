# SPDX-License-Identifier: Apache-2.0
from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    name: str                # group/feature
    text: str                # the scene
    spp: int = 256           # Mitsuba's samples per pixel for one seed; it takes as many seeds as it needs
    supported: bool = True   # False: nearlight may refuse it by name
    block: int = 8           # side in pixels of the blocks that are compared
    options: tuple = ()      # for nearlight, besides its defaults
    path: str = ''           # a file that exists already, instead of one made from the text
    size: tuple = ()         # of the picture, where it is not the film's
    planted: str = ''        # a scene that is wrong on purpose and that nearlight renders; the comparison must see it

    @property
    def group(self):
        return self.name.split('/')[0]


def table(group, scenes, **options):
    """Rows from {name: text} or {name: (text, options of that row)}."""
    rows = []
    for name, entry in scenes.items():
        text, own = entry if isinstance(entry, tuple) else (entry, {})
        rows.append(Row(f'{group}/{name}', text, **{**options, **own}))
    return rows
