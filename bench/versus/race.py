# SPDX-License-Identifier: Apache-2.0
"""One scene of the race: converged pictures, then errors over seconds. Everything that was measured is kept in a folder, so
that the race goes on where it stopped."""
from dataclasses import asdict, dataclass
import hashlib
import json
import os

import numpy as np

import measures
from renderers import RenderFailure, Task, read_exr, write_exr

TRUTH_SEEDS = (1_000_001, 1_000_002)     # of the two halves; no measured picture has these


@dataclass
class Race:
    """What all scenes have in common."""
    renderers: list
    nearlight: object        # measures FLIP
    folder: str
    seeds: int
    seconds: float           # a curve ends with the first point that takes longer
    doublings: int           # or with this number of points: work 1, 2, 4, ...
    truth_work: dict         # of each half of a converged picture, by the renderer's label
    denoise: tuple           # (False,), or (False, True)

    def scene(self, path, size, tell):
        """All results of a scene as plain values."""
        truth, agreement = self._truth(path, size, tell)
        truth_file = os.path.join(self.folder, f'truth-{key_of(path, size)}.exr')
        write_exr(truth_file, truth['picture'])
        curves = []
        for renderer in self.renderers:
            for denoise in self.denoise:
                tell(f'{renderer.label}{", denoised" if denoise else ""}')
                curves.append({'renderer': renderer.label, 'denoised': denoise,
                               'points': self._points(renderer, path, size, denoise, truth['picture'], truth_file, tell)})
        return {'scene': os.path.basename(os.path.dirname(os.path.abspath(path))), 'size': list(size), 'agreement': agreement,
                'truth_relative_mse': truth['variance'], 'curves': curves}

    def _truth(self, path, size, tell):
        pictures = {}
        for renderer in self.renderers:
            work = self.truth_work[renderer.label]
            if work == 0:
                continue
            tell(f'{renderer.label}: converged picture')
            pictures[renderer.label] = [self._kept(renderer, Task(path, size, work, seed))[0] for seed in TRUTH_SEEDS]
        picture, variance = measures.combined(list(pictures.values()))
        names = list(pictures)
        agreement = [dict(zip(('ratio', 'error'), map(float, measures.mean_ratio(pictures[names[0]], pictures[other]))),
                          renderers=[names[0], other]) for other in names[1:]]
        return {'picture': picture, 'variance': float(variance)}, agreement

    def _points(self, renderer, path, size, denoise, truth, truth_file, tell):
        points = []
        for work in (1 << i for i in range(self.doublings)):
            runs = []
            for seed in range(1, self.seeds + 1):
                runs.append(self._run(renderer, Task(path, size, work, seed, denoise), truth, truth_file))
            points.append({'work': work, 'runs': runs})
            tell(f"  work {work}: {np.median([r['seconds']['render'] for r in runs]):.2f} s, "
                 f"relMSE {np.median([r['relative_mse'] for r in runs]):.5f}")
            if np.median([r['seconds']['render'] for r in runs]) > self.seconds:
                break
        return points

    def _run(self, renderer, task, truth, truth_file):
        if task.seed == 1 and task.work == 1:
            self._warm_up(renderer, task)
        picture, seconds, file = self._kept(renderer, task)
        return {'seed': task.seed, 'seconds': seconds, 'relative_mse': measures.relative_mse(picture, truth),
                'flip': self.nearlight.flip(file, truth_file), 'spectrum': measures.spectrum(picture, truth)}

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
    """A name for a scene file at a size, which changes with its text."""
    with open(path, 'rb') as file:
        digest = hashlib.sha256(file.read())
    digest.update(repr((os.path.abspath(path), tuple(size))).encode())
    return digest.hexdigest()[:16]
