# SPDX-License-Identifier: Apache-2.0
"""All scenes of the comparison, one row each."""
from rows.row import Row
from rows import bsdfs, corners, emitters, files, glass, integrators, planted, sensors, shapes, spectra, textures

GROUPS = (emitters, sensors, bsdfs, textures, shapes, integrators, spectra, corners, glass, files, planted)


def all_rows():
    """The rows of all groups. A name that appears twice is a mistake in a table."""
    rows = [row for group in GROUPS for row in group.rows()]
    names = [row.name for row in rows]
    assert len(names) == len(set(names)), [n for n in names if names.count(n) > 1]
    return rows


__all__ = ['Row', 'all_rows']
