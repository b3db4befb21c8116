# SPDX-License-Identifier: Apache-2.0
"""Pictures of a scene by either renderer, as sets of block means; Mitsuba's are kept in files."""
from dataclasses import dataclass, field
import hashlib
import json
import os
import re
import subprocess

import numpy as np

from agreement import mean_error
from mitsuba_worker import MitsubaFailure

SEEDS_A_ROUND = 8
MAX_ROUNDS = 4
ENOUGH = 0.001           # relative standard error of the mean of Mitsuba's pictures at which it stops
SCENE_FILE = 3           # nearlight's exit code for a scene that it refuses


class NearlightFailure(Exception):
    """nearlight ended with an error other than a refusal, or took too long."""


class NearlightRefusal(Exception):
    """nearlight said that it cannot render the scene."""


def hash_of_scene(path):
    """A hash of a scene's text and of the files that it names."""
    with open(path, 'rb') as file:
        text = file.read()
    digest = hashlib.sha256(text)
    for name in sorted(set(re.findall(rb'name="filename"\s+value="([^"]+)"', text))):
        add_file(digest, os.path.join(os.path.dirname(path), name.decode()))
    return digest


def add_file(digest, path):
    if os.path.exists(path):
        with open(path, 'rb') as file:
            digest.update(file.read())


@dataclass
class Mitsuba:
    """Converged pictures, kept in `folder` under a hash of the scene, the files it names, and the version."""
    worker: object
    version: str
    folder: str
    seconds: float = 300
    redo: bool = False

    def pictures(self, path, row):
        kept = os.path.join(self.folder, self._key(path, row) + '.npy')
        if os.path.exists(kept) and not self.redo:
            return np.load(kept)
        os.makedirs(self.folder, exist_ok=True)
        rounds = []
        while len(rounds) < MAX_ROUNDS:
            part = f'{kept}.{len(rounds)}.partial.npy'
            seeds = [len(rounds) * SEEDS_A_ROUND + s for s in range(SEEDS_A_ROUND)]
            request = {'render': path, 'seeds': seeds, 'spp': row.spp, 'size': row.size, 'block': row.block, 'into': part}
            self.worker.ask(request, self.seconds)
            rounds.append(np.load(part))
            os.remove(part)
            if mean_error(np.concatenate(rounds)) < ENOUGH:
                break
        pictures = np.concatenate(rounds)
        if not np.isfinite(pictures).all():
            raise MitsubaFailure('Mitsuba made NaN')
        np.save(kept + '.partial.npy', pictures)
        os.replace(kept + '.partial.npy', kept)
        return pictures

    def _key(self, path, row):
        digest = hash_of_scene(path)
        digest.update(repr((self.version, 'not merged', row.spp, row.size, row.block)).encode())
        return digest.hexdigest()[:24]


@dataclass
class Nearlight:
    """The program at its defaults, with these options besides. With `spp`, its reference path tracer makes the pictures,
    with so many samples a pixel."""
    program: str
    worker: object
    folder: str
    options: list = field(default_factory=list)
    spp: int = 0
    seconds: float = 300

    def pictures(self, path, row, seeds, options=()):
        """Block means of a picture for each seed, what nearlight warned about, and its report of the last picture."""
        files, warnings, report = [], [], {}
        stem = os.path.join(self.folder, row.name.replace('/', '__'))
        for seed in seeds:
            files.append(f'{stem}-{seed}.exr')
            warnings, report = self._render(path, files[-1], seed, row.size, (*row.options, *options))
        into = stem + '.npy'
        self.worker.ask({'read': files, 'block': row.block, 'into': into}, 60)
        pictures = np.load(into)
        for file in (*files, into):
            os.remove(file)
        if not np.isfinite(pictures).all():
            raise NearlightFailure('the picture has pixels that are not finite')
        return pictures, warnings, report

    def _render(self, path, out, seed, size, options):
        kind, options = ('reference', ('--spp', str(self.spp))) if self.spp else ('render', options)    # rows have options of `render`
        command = [self.program, kind, path, '-o', out, '--json', '--seed', str(seed), *self.options, *options]
        if size:
            command += ['--size', f'{size[0]}x{size[1]}']
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=self.seconds)
        except subprocess.TimeoutExpired:
            raise NearlightFailure(f'it took more than {self.seconds} s') from None
        errors = _messages(done.stderr, 'error')
        if done.returncode == SCENE_FILE:
            raise NearlightRefusal(' '.join(errors))
        if done.returncode != 0:
            raise NearlightFailure(f'exit code {done.returncode}: ' + ' '.join(errors))
        return _messages(done.stderr, 'warning'), json.loads(done.stdout)


def _messages(text, kind):
    """Messages of one kind."""
    return [without_folders(m) for m in re.findall(rf'^(?:nearlight: )?{kind}: (.*)$', text, flags=re.MULTILINE)]


def without_folders(message):
    """A message about a file that reads the same on every machine."""
    return re.sub(r'/\S*/', '', message)
