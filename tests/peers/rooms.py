# SPDX-License-Identifier: Apache-2.0
"""Whole scenes as rows: every XML file under some folders that has a sensor, at a small size."""
import os
import re

from rows.row import Row


def rows(folders, largest):
    width, height = (int(n) for n in largest.split('x'))
    found = []
    for folder in folders:
        for place, _, files in sorted(os.walk(folder)):
            for file in sorted(files):
                if file.endswith('.xml'):
                    found += _row(folder, os.path.join(place, file), width, height)
    return found


def _row(folder, path, width, height):
    with open(path, encoding='utf-8') as file:
        text = file.read()
    if '<sensor' not in text:
        return []
    name = os.path.relpath(path, folder)[:-len('.xml')].removesuffix('/scene')
    return [Row(f'rooms/{name}', text, spp=64, path=os.path.abspath(path), size=_fitted(text, width, height))]


def _fitted(text, width, height):
    """The shape of the scene's own film, as large as fits, in whole blocks."""
    own = [_number(text, 'width', 768), _number(text, 'height', 576)]
    factor = min(width / own[0], height / own[1])
    return [max(8, round(n * factor / 8) * 8) for n in own]


def _number(text, name, fallback):
    """A number of the film, or Mitsuba's own where the file says nothing."""
    found = re.search(rf'<integer name="{name}" value="([^"]+)"', text)
    value = found.group(1) if found else str(fallback)
    if value.startswith('$'):
        value = re.search(rf'<default name="{value[1:]}" value="([^"]+)"', text).group(1)
    return int(value)
