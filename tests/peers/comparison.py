# SPDX-License-Identifier: Apache-2.0
"""One row: both renderers, the comparison of their pictures, and whether the row passes."""
from dataclasses import asdict, dataclass, field, replace
import glob
import hashlib
import json
import os
import shlex

import numpy as np

import agreement
from mitsuba_worker import MitsubaFailure, UnreadableScene
from renderers import Mitsuba, Nearlight, NearlightFailure, NearlightRefusal, add_file, hash_of_scene, without_folders

ROUNDS = ((1, 2, 3, 4), (5, 6, 7, 8), tuple(range(9, 17)))   # seeds; a row whose verdict is clear stops early


@dataclass
class Result:
    """A row after the comparison. `status`: agrees, deviates, noisy, refused, failed, or no peer (Mitsuba does not read it)."""
    name: str
    status: str
    passed: bool
    note: str = ''
    warnings: list = field(default_factory=list)
    agreement: object = None
    clamp_radius: float = 0.0
    seconds: float = 0.0

    @classmethod
    def from_json(cls, members):
        result = cls(**members)
        if result.agreement:
            result.agreement = agreement.Agreement(**result.agreement)
        return result


class Comparison:
    def __init__(self, arguments, version, worker):
        self._factor = arguments.clamp_radius_factor
        self._is_resumed = arguments.resume
        out = os.path.abspath(arguments.out)
        self._scenes, self._results, pictures = (os.path.join(out, name) for name in ('scenes', 'results', 'pictures'))
        for folder in (self._scenes, self._results, pictures):
            os.makedirs(folder, exist_ok=True)
        program, options = os.path.abspath(arguments.nearlight), shlex.split(arguments.options)
        self._mitsuba = Mitsuba(worker, version, os.path.join(out, 'mitsuba'), redo=arguments.redo)
        self._nearlight = Nearlight(program, worker, pictures, options, arguments.reference)
        self._key = repr((version, hash_of_judges(program), options, self._factor, arguments.reference))

    def result(self, row):
        """The row's result. The same program renders the same pictures, so a result that was kept holds."""
        path = self._file_of(row, row.text)
        wrong = self._file_of(row, row.planted) if row.planted else path
        key = hash_of_scene(path)
        key.update(hash_of_scene(wrong).digest() + repr((self._key, replace(row, text='', planted='', path=''))).encode())
        kept = os.path.join(self._results, key.hexdigest()[:24] + '.json')
        if self._is_resumed and os.path.exists(kept):
            with open(kept, encoding='utf-8') as file:
                return Result.from_json(json.load(file))
        result = self._compared(row, path, wrong)
        if result.status != 'failed':
            with open(kept, 'w', encoding='utf-8') as file:
                json.dump(asdict(result), file)
        return result

    def _compared(self, row, path, wrong):
        try:
            theirs = self._mitsuba.pictures(path, row)
        except UnreadableScene as failure:
            return Result(row.name, 'no peer', bool(row.path), without_folders(f'Mitsuba: {failure}'))
        except MitsubaFailure as failure:
            return Result(row.name, 'failed', False, f'Mitsuba: {failure}')
        try:
            return self._judged(row, wrong, theirs)
        except NearlightRefusal as refusal:
            return Result(row.name, 'refused', not row.supported, str(refusal))
        except (NearlightFailure, MitsubaFailure) as failure:
            return Result(row.name, 'failed', False, str(failure))

    def _judged(self, row, path, theirs):
        """Renders seed after seed until the pictures agree, or the seeds are used up."""
        options = self._clamp_options(path, row) if self._factor != 1 else []
        ours = np.empty((0, *theirs.shape[1:]))
        for seeds in ROUNDS:
            pictures, warnings, report = self._nearlight.pictures(path, row, seeds, options)
            if pictures.shape[1:] != theirs.shape[1:]:
                sizes = ['{}x{}'.format(*set_of.shape[2:0:-1]) for set_of in (pictures, theirs)]
                raise NearlightFailure(f"the picture has {sizes[0]} blocks, Mitsuba's has {sizes[1]}")
            ours = np.concatenate([ours, pictures])
            found = agreement.compare(ours, theirs)
            if found.verdict == 'agrees' or found.is_clear:
                break
        expected = 'deviates' if row.planted else 'agrees'
        note = 'planted' if row.planted else ''
        return Result(row.name, found.verdict, found.verdict == expected, note, warnings, found, report['clamp_radius'])

    def _clamp_options(self, path, row):
        """The option for a multiple of the radius that nearlight chooses for itself."""
        _, _, report = self._nearlight.pictures(path, row, (1,))
        return ['--clamp-radius', f'{report["clamp_radius"] * self._factor:g}']

    def _file_of(self, row, text):
        """Writes a scene to its file. A room has one already."""
        if row.path:
            return row.path
        wrong = '-wrong' if row.planted and text == row.planted else ''
        path = os.path.join(self._scenes, row.name.replace('/', '__') + wrong + '.xml')
        with open(path, 'w', encoding='utf-8') as file:
            file.write(text)
        return path


def hash_of_judges(program):
    """A hash of the program, of its modules, which lie in a folder beside it, and of the statistics."""
    digest = hashlib.sha256()
    for file in [program, *sorted(glob.glob(os.path.join(os.path.dirname(program), 'modules', '*'))), agreement.__file__]:
        add_file(digest, file)
    return digest.hexdigest()
