# SPDX-License-Identifier: Apache-2.0
"""All scenes of the comparison, one row each."""
from rows import bsdfs, corners, emitters, files, glass, integrators, planted, sensors, shapes, spectra, textures

GROUPS = (emitters, sensors, bsdfs, textures, shapes, integrators, spectra, corners, glass, files, planted)

# The subset that ctest runs.
FAST = ('emitters/area-sphere-in-view', 'sensors/perspective-fov-x', 'films/plain', 'filters/box', 'bsdfs/diffuse/furnace',
        'bsdfs/plastic/furnace', 'textures/bitmap', 'shapes/sphere-inside', 'integrators/room-depth-2',
        'integrators/room-depth-3', 'spectra/paint-rgb', 'corners/shade', 'planted/reflectance-3-percent')


def all_rows():
    """The rows of all groups. A name that appears twice is a mistake in a table."""
    rows = [row for group in GROUPS for row in group.rows()]
    names = [row.name for row in rows]
    assert len(names) == len(set(names)), [n for n in names if names.count(n) > 1]
    return rows


def fast_rows():
    return [row for row in all_rows() if row.name in FAST]
