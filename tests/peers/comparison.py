# SPDX-License-Identifier: Apache-2.0
"""One row: both renderers, the comparison of their pictures, and whether the row passes."""
from dataclasses import dataclass, field
import os
import shlex

import numpy as np

from agreement import compare
from mitsuba_worker import MitsubaFailure
from renderers import Mitsuba, Nearlight, NearlightFailure, NearlightRefusal

ROUNDS = ((1, 2, 3, 4), (5, 6, 7, 8), tuple(range(9, 17)))   # seeds; a row that agrees early stops early


@dataclass
class Result:
    """A row after the comparison. `status`: agrees, deviates, noisy, refused, failed, or no peer (Mitsuba cannot read it)."""
    name: str
    status: str
    passed: bool
    note: str = ''
    warnings: list = field(default_factory=list)
    agreement: object = None
    clamp_radius: float = 0.0
    seconds: float = 0.0


class Comparison:
    def __init__(self, arguments, version, worker):
        out = os.path.abspath(arguments.out)
        self._factor = arguments.clamp_radius_factor
        self._scenes = os.path.join(out, 'scenes')
        pictures = os.path.join(out, 'pictures')
        os.makedirs(self._scenes, exist_ok=True)
        os.makedirs(pictures, exist_ok=True)
        self._mitsuba = Mitsuba(worker, version, os.path.join(out, 'mitsuba'), redo=arguments.redo)
        self._nearlight = Nearlight(os.path.abspath(arguments.nearlight), worker, pictures, shlex.split(arguments.options))

    def result(self, row):
        try:
            theirs = self._mitsuba.pictures(self._path(row, row.text), row)
        except MitsubaFailure as failure:
            return Result(row.name, 'no peer' if row.path else 'failed', bool(row.path), f'Mitsuba: {failure}')
        try:
            return self._judged(row, theirs)
        except NearlightRefusal as refusal:
            return Result(row.name, 'refused', not row.supported, str(refusal))
        except (NearlightFailure, MitsubaFailure) as failure:
            return Result(row.name, 'failed', False, str(failure))

    def _judged(self, row, theirs):
        """Renders seed after seed until the pictures agree, or the seeds are used up."""
        path = row.path or self._path(row, row.planted or row.text)
        ours, options = None, []
        for seeds in ROUNDS:
            if ours is None and self._factor != 1:
                options = self._clamp_options(path, row)
            pictures, warnings, report = self._nearlight.pictures(path, row, seeds, options)
            if pictures.shape[1:] != theirs.shape[1:]:
                sizes = ['{}x{}'.format(*set_of.shape[2:0:-1]) for set_of in (pictures, theirs)]
                raise NearlightFailure(f"the picture has {sizes[0]} blocks, Mitsuba's has {sizes[1]}")
            ours = pictures if ours is None else np.concatenate([ours, pictures])
            agreement = compare(ours, theirs)
            is_confirmed = agreement.verdict == 'deviates' and len(ours) > len(ROUNDS[0])
            if agreement.verdict == 'agrees' or agreement.is_clear or is_confirmed:
                break
        expected = 'deviates' if row.planted else 'agrees'
        note = '(planted)' if row.planted else ''
        return Result(row.name, agreement.verdict, agreement.verdict == expected, note, warnings, agreement,
                      report['clamp_radius'])

    def _clamp_options(self, path, row):
        """The option for a multiple of the radius that nearlight chooses for itself."""
        _, _, report = self._nearlight.pictures(path, row, (1,))
        return ['--clamp-radius', f'{report["clamp_radius"] * self._factor:g}']

    def _path(self, row, text):
        """The file of a scene. A room has one already."""
        if row.path:
            return row.path
        wrong = '-wrong' if row.planted and text == row.planted else ''
        path = os.path.join(self._scenes, row.name.replace('/', '__') + wrong + '.xml')
        with open(path, 'w', encoding='utf-8') as file:
            file.write(text)
        return path
