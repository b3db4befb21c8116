# SPDX-License-Identifier: Apache-2.0
"""The renderers of the race. Each makes a picture of a scene with a given amount of work and says how long that took."""
from dataclasses import dataclass
import importlib.metadata
import importlib.util
import json
import os
import resource
import subprocess
import sys
import time

import numpy as np

import oidn

HERE = os.path.dirname(os.path.abspath(__file__))


class RenderFailure(Exception):
    """A renderer did not make its picture."""


@dataclass(frozen=True)
class Task:
    """One picture. `work` is what the renderer doubles from one point of its curve to the next."""
    scene: str
    size: tuple
    work: int
    seed: int
    denoise: bool = False


@dataclass
class Picture:
    pixels: np.ndarray
    seconds: dict        # "render" alone, the "process" from start to end, and all "processor" seconds


def timed(command, limit):
    """Runs a program. Returns its output, and the seconds and processor seconds that it took."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    started = time.perf_counter()
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        raise RenderFailure(f'it took more than {limit} s') from None
    seconds = time.perf_counter() - started
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        raise RenderFailure((done.stderr.strip().splitlines() or [f'exit code {done.returncode}'])[-1])
    return done.stdout, seconds, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


class Nearlight:
    """nearlight at its defaults. Its work is passes."""
    label = 'nearlight'

    def __init__(self, program, folder, limit):
        self.program, self.folder, self.limit = program, folder, limit

    def missing(self):
        if not os.path.exists(self.program):
            return f'there is no program {self.program}; build it or give --nearlight'
        if importlib.util.find_spec('mitsuba') is None:
            return 'reading its pictures needs the Python package mitsuba (pip install mitsuba numpy)'
        return None

    def version(self):
        with open(self.program, 'rb') as file:
            import hashlib
            return hashlib.sha256(file.read()).hexdigest()[:12]

    def render(self, task):
        out = os.path.join(self.folder, 'nearlight.exr')
        command = [self.program, 'render', task.scene, '-o', out, '--json', '--layers', 'beauty', '--passes', str(task.work),
                   '--seed', str(task.seed), '--size', f'{task.size[0]}x{task.size[1]}']
        output, process, processor = timed(command + (['--denoise'] if task.denoise else []), self.limit)
        seconds = json.loads(output)['seconds']
        render = seconds['generate'] + seconds['gather'] + seconds.get('denoise', 0)
        return Picture(read_exr(out), {'render': render, 'process': process, 'processor': processor})

    def flip(self, picture, truth):
        """The mean FLIP of two files."""
        output, _, _ = timed([self.program, 'diff', picture, truth, '--json'], self.limit)
        report = json.loads(output)
        return (report['layers'][0] if 'layers' in report else report)['flip']


class Mitsuba:
    """Mitsuba 3's integrator of the scene. Its work is 16 samples a pixel."""

    def __init__(self, variant, folder, limit):
        self.variant, self.folder, self.limit = variant, folder, limit
        self.label = 'Mitsuba 3 ' + {'llvm_ad_rgb': 'LLVM', 'scalar_rgb': 'scalar'}[variant]

    def missing(self):
        absent = [name for name in ('numpy', 'mitsuba') if importlib.util.find_spec(name) is None]
        return f"it needs the Python package {' and '.join(absent)} (pip install mitsuba numpy)" if absent else None

    def version(self):
        return importlib.metadata.version('mitsuba')

    def render(self, task):
        out = os.path.join(self.folder, 'mitsuba.npy')
        request = {'scene': task.scene, 'variant': self.variant, 'width': task.size[0], 'height': task.size[1],
                   'spp': 16 * task.work, 'seed': task.seed, 'denoise': task.denoise, 'out': out}
        program = [sys.executable, os.path.join(HERE, 'mitsuba_run.py'), json.dumps(request)]
        output, process, processor = timed(program, self.limit)
        seconds = json.loads(output.strip().splitlines()[-1])
        return Picture(np.load(out), {'render': seconds['render'], 'process': process, 'processor': processor})


class Cycles:
    """Blender's path tracer, which wants scenes in Blender's own form."""
    label = 'Cycles'

    def missing(self):
        return 'it is not covered yet: no converter of scenes for the Python package bpy'


def bitmaps():
    """Mitsuba's pictures of files, which know EXR."""
    import mitsuba as mi
    mi.set_variant('scalar_rgb')
    return mi


def read_exr(file):
    bitmap = bitmaps().Bitmap(file)
    names = [field.name for field in bitmap.struct_()]
    return np.array(bitmap)[..., [names.index(c) for c in 'RGB']].astype(np.float32)


def write_exr(file, pixels):
    bitmaps().Bitmap(np.ascontiguousarray(pixels, dtype=np.float32)).write(file)


def can_denoise():
    return oidn.loaded() is not None
