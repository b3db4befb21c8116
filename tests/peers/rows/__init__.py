# SPDX-License-Identifier: Apache-2.0
"""All scenes of the comparison, one row each."""
from rows import bsdfs, chance, corners, emitters, files, glass, integrators, planted, sensors, shapes, spectra, textures

GROUPS = (emitters, sensors, bsdfs, textures, shapes, integrators, spectra, corners, glass, files, planted)

# The subset that ctest runs: of each group some that take little time.
FAST = ('emitters/area-flipped', 'emitters/directional-to-world', 'emitters/envmap-alone', 'sensors/perspective-fov-x',
        'sensors/orthographic', 'films/plain', 'films/crop', 'filters/box', 'filters/gaussian', 'bsdfs/diffuse/furnace',
        'bsdfs/plastic/furnace', 'bsdfs/roughplastic-ggx/point', 'bsdfs/normalmap/mesh', 'bsdfs/bumpmap/mesh',
        'bsdfs/mask-black/area', 'textures/bitmap-on-disk', 'textures/checkerboard', 'shapes/sphere-inside',
        'shapes/cylinder', 'normals/wave/point', 'integrators/room-depth-2', 'integrators/direct-in-room', 'spectra/paint-rgb',
        'corners/shade', 'metal-rooms/room-plastic', 'glass/null-shadow', 'files/version-0.6',
        'planted/reflectance-3-percent')


def all_rows():
    """The rows of all groups. A name that appears twice is a mistake in a table."""
    rows = [row for group in GROUPS for row in group.rows()]
    names = [row.name for row in rows]
    assert len(names) == len(set(names)), [n for n in names if names.count(n) > 1]
    return rows


def fast_rows():
    return [row for row in all_rows() if row.name in FAST]
