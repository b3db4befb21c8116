# SPDX-License-Identifier: Apache-2.0
"""One scene of the race: converged pictures, then errors over seconds. Everything that was measured is kept in a folder, so
that the race goes on where it stopped."""
from dataclasses import asdict, dataclass
import hashlib
import json
import os

import numpy as np

import measures
from renderers import RenderFailure, Task, files_of_scene, hash_of_files, read_exr, write_exr

TRUTH_SEEDS = (1_000_001, 1_000_002)     # of the two halves; no measured picture has these


@dataclass
class Truth:
    """What the renderers of one limit converge to."""
    picture: np.ndarray
    file: str
    variance: float          # the relative MSE that the picture itself has


@dataclass
class Race:
    """What all scenes have in common."""
    renderers: list
    nearlight: object        # measures FLIP
    folder: str
    seeds: int
    seconds: float           # a curve ends with the first point that takes longer
    doublings: int           # or with this number of points: work 1, 2, 4, ...
    truth_work: tuple        # of each half of a converged picture: passes of nearlight, and the work of others
    denoise: tuple           # of (False, True), those to be raced

    def scene(self, path, size, tell):
        """All results of a scene as plain values. Renderers that cannot read it are left out, with a line that says why."""
        renderers, notes = self._able(path, size, tell)
        halves = self._halves(renderers, path, size, tell)
        key = key_of(path, size)
        truths = {limit: self._truth(limit, [halves[f] for f in dict.fromkeys(r.family for r in renderers if r.limit == limit)], key)
                  for limit in {r.limit for r in renderers}}
        if True in self.denoise:
            truths |= self._denoised_truths(renderers, path, size, key, tell)
        curves = []
        for renderer in renderers:
            for denoise in self.denoise:
                tell(f'{renderer.label}{", denoised" if denoise else ""}')
                truth = truths[renderer.denoised_limit(path) if denoise else renderer.limit]
                points = self._points(renderer, path, size, denoise, truth, tell)
                curves.append({'renderer': renderer.label, 'denoised': denoise, 'points': points})
        names = list(halves)
        agreement = [dict(zip(('ratio', 'error'), map(float, measures.mean_ratio(halves[names[0]], halves[other]))),
                          renderers=[names[0], other]) for other in names[1:]]
        return {'scene': os.path.basename(os.path.dirname(os.path.abspath(path))), 'size': list(size), 'agreement': agreement,
                'truth_relative_mse': {limit: truth.variance for limit, truth in sorted(truths.items(), reverse=True)},
                'curves': curves, 'notes': notes}

    def _able(self, path, size, tell):
        able, notes = [], []
        for renderer in self.renderers:
            try:
                self._kept(renderer, Task(path, size, 1, 0))
                able.append(renderer)
            except RenderFailure as failure:
                if renderer is self.nearlight:
                    raise
                notes.append(f'{renderer.label} is left out: {failure}')
                tell(notes[-1])
        return able, notes

    def _halves(self, renderers, path, size, tell):
        """Two converged pictures by the first renderer of each family."""
        halves = {}
        for renderer in {r.family: r for r in reversed(renderers)}.values():
            tell(f'{renderer.label}: converged picture')
            halves[renderer.family] = self._converged(renderer, path, size, False)
        return dict(sorted(halves.items(), key=lambda item: item[0] != self.nearlight.family))

    def _converged(self, renderer, path, size, box_filter):
        work = self.truth_work[0 if renderer is self.nearlight else 1]
        return [self._kept(renderer, Task(path, size, work, seed, box_filter=box_filter))[0] for seed in TRUTH_SEEDS]

    def _denoised_truths(self, renderers, path, size, key, tell):
        """The limits of denoised pictures that others do not have."""
        truths = {}
        for renderer in renderers:
            limit = renderer.denoised_limit(path)
            if limit != renderer.limit and limit not in truths:
                tell(f'{renderer.label}: converged picture, {limit}')
                truths[limit] = self._truth(limit, [self._converged(renderer, path, size, True)], key)
        return truths

    def _truth(self, limit, halves, key):
        """The mean of all halves, the less noisy ones weighing more."""
        picture, variance = measures.combined(halves)
        file = os.path.join(self.folder, f"truth-{limit.replace(' ', '-')}-{key}.exr")
        write_exr(file, picture)
        return Truth(picture, file, float(variance))

    def _points(self, renderer, path, size, denoise, truth, tell):
        points = []
        for work in (1 << i for i in range(self.doublings)):
            runs = []
            for seed in range(1, self.seeds + 1):
                runs.append(self._run(renderer, Task(path, size, work, seed, denoise), truth))
            points.append({'work': work, 'runs': runs})
            tell(f"  work {work}: {np.median([r['seconds']['render'] for r in runs]):.2f} s, "
                 f"relMSE {np.median([r['relative_mse'] for r in runs]):.5f}")
            if np.median([r['seconds']['render'] for r in runs]) > self.seconds:
                break
        return points

    def _run(self, renderer, task, truth):
        if task.seed == 1 and task.work == 1:
            self._warm_up(renderer, task)
        picture, seconds, file = self._kept(renderer, task)
        return {'seed': task.seed, 'seconds': seconds, 'relative_mse': measures.relative_mse(picture, truth.picture),
                'flip': self.nearlight.flip(file, truth.file), 'spectrum': measures.spectrum(picture, truth.picture)}

    def _warm_up(self, renderer, task):
        """Fills the caches of programs and trees, so that whole processes are measured warm."""
        if not os.path.exists(self._file(renderer, task) + '.json'):
            renderer.render(Task(task.scene, task.size, 1, 0, task.denoise))

    def _file(self, renderer, task):
        text = json.dumps([renderer.label, renderer.version(), asdict(task), key_of(task.scene, task.size)])
        return os.path.join(self.folder, hashlib.sha256(text.encode()).hexdigest()[:24])

    def _kept(self, renderer, task):
        """The pixels, seconds and EXR file of a task, which is rendered unless it was before."""
        file = self._file(renderer, task)
        if not os.path.exists(file + '.json'):
            picture = renderer.render(task)
            if not np.isfinite(picture.pixels).all():
                raise RenderFailure(f'{renderer.label} made pixels that are not finite')
            write_exr(file + '.exr', picture.pixels)
            with open(file + '.json.partial', 'w', encoding='utf-8') as out:
                json.dump(picture.seconds, out)
            os.replace(file + '.json.partial', file + '.json')
        with open(file + '.json', encoding='utf-8') as kept:
            return read_exr(file + '.exr'), json.load(kept), file + '.exr'


def key_of(path, size):
    """A name for a scene file at a size, which changes with its text and the files that it names."""
    digest = hash_of_files(files_of_scene(path))
    digest.update(repr((os.path.abspath(path), tuple(size))).encode())
    return digest.hexdigest()[:16]
