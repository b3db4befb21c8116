# SPDX-License-Identifier: Apache-2.0
"""The renderers of the race. Each makes a picture of a scene with a given amount of work and says how long that took.

Renderers with the same `limit` converge to the same picture, those of one `family` by the same code. `denoised_limit` says what their
denoised pictures of a scene are made of.
"""
from dataclasses import dataclass
import hashlib
import importlib.metadata
import importlib.util
import json
import os
import re
import resource
import subprocess
import sys
import time

import numpy as np

import oidn

HERE = os.path.dirname(os.path.abspath(__file__))
EXPORT = os.path.join(HERE, 'scene_export.py')


def hash_of_files(files):
    """The hash of what the files hold, to be added to."""
    digest = hashlib.sha256()
    for name in files:
        with open(name, 'rb') as file:
            digest.update(file.read())
    return digest


def files_of_scene(path):
    """The scene's file, and the meshes and pictures that it names."""
    with open(path, encoding='utf-8', errors='replace') as file:
        names = re.findall(r'<string\s+name="filename"\s+value="([^"]+)"', file.read())
    found = [os.path.join(os.path.dirname(path), name) for name in sorted(set(names))]
    return [path, *filter(os.path.isfile, found)]


def has_box_filter(path):
    """Whether the scene's film has a box filter, and no other."""
    with open(path, encoding='utf-8', errors='replace') as file:
        tags = re.findall(r'<rfilter\b[^>]*>', file.read())
    return bool(tags) and all(re.search(r'type\s*=\s*"box"', tag) for tag in tags)


def hash_of_scripts(*names):
    """Tells versions of our own scripts apart."""
    return hash_of_files(os.path.join(HERE, name) for name in names).hexdigest()[:12]


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
    box_filter: bool = False     # each pixel has noise of its own, as denoisers expect; denoised pictures have it anyway


@dataclass
class Picture:
    pixels: np.ndarray
    seconds: dict        # "render" alone, the "process" from start to end, and all "processor" seconds


def timed(command, max_seconds):
    """Runs a program. Returns its output, and the seconds and processor seconds that it took."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    started = time.perf_counter()
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=max_seconds)
    except subprocess.TimeoutExpired:
        raise RenderFailure(f'it took more than {max_seconds} s') from None
    seconds = time.perf_counter() - started
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        raise RenderFailure((done.stderr.strip().splitlines() or [f'exit code {done.returncode}'])[-1])
    return done.stdout, seconds, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def mitsuba_file(path, folder, max_seconds):
    """A scene as a file that Mitsuba reads: itself, or what gltf_scene.py makes of it in the folder, once."""
    if not path.endswith('.gltf'):
        return path
    converter = os.path.join(HERE, 'gltf_scene.py')
    digest = hash_of_files([path, converter])
    digest.update(os.path.abspath(path).encode())
    name = os.path.splitext(os.path.basename(path))[0]
    out = os.path.join(folder, f'gltf-{digest.hexdigest()[:16]}', name)
    file = os.path.join(out, 'scene.xml')
    if not os.path.exists(file):
        timed([sys.executable, converter, json.dumps({'scene': path, 'folder': out})], max_seconds)
    return file


class Nearlight:
    """nearlight at its defaults. Its work is passes."""
    label = 'nearlight'
    family = 'nearlight'
    limit = 'the scene'

    def __init__(self, program, folder, max_seconds):
        self.program, self.folder, self.max_seconds = program, folder, max_seconds

    def missing(self):
        if not os.path.exists(self.program):
            return f'there is no program {self.program}; build it or give --nearlight'
        if importlib.util.find_spec('mitsuba') is None:
            return 'reading its pictures needs the Python package mitsuba (pip install mitsuba numpy)'
        return None

    def version(self):
        """That of the program and of the modules beside it."""
        modules = os.path.join(os.path.dirname(self.program), 'modules')
        names = sorted(os.listdir(modules)) if os.path.isdir(modules) else []
        files = [self.program, *(os.path.join(modules, name) for name in names)]
        return hash_of_files(filter(os.path.isfile, files)).hexdigest()[:12]

    def render(self, task):
        out = os.path.join(self.folder, 'nearlight.exr')
        command = [self.program, 'render', task.scene, '-o', out, '--json', '--layers', 'beauty', '--passes', str(task.work),
                   '--seed', str(task.seed), '--size', f'{task.size[0]}x{task.size[1]}']
        output, process, processor = timed(command + (['--denoise'] if task.denoise else []), self.max_seconds)
        seconds = json.loads(output)['seconds']
        render = seconds['generate'] + seconds['gather'] + seconds.get('denoise', 0)
        return Picture(read_exr(out), {'render': render, 'process': process, 'processor': processor})

    def denoised_limit(self, _scene):
        return self.limit

    def flip(self, picture, truth):
        """The mean FLIP of two files."""
        output, _, _ = timed([self.program, 'diff', picture, truth, '--json'], self.max_seconds)
        report = json.loads(output)
        return (report['layers'][0] if 'layers' in report else report)['flip']


class Mitsuba:
    """Mitsuba 3's integrator of the scene. Its work is 16 samples a pixel."""

    family = 'Mitsuba 3'
    limit = 'the scene'

    def __init__(self, variant, folder, max_seconds):
        self.variant, self.folder, self.max_seconds = variant, folder, max_seconds
        self.label = 'Mitsuba 3 ' + {'llvm_ad_rgb': 'LLVM', 'scalar_rgb': 'scalar'}[variant]

    def denoised_limit(self, scene):
        return self.limit if has_box_filter(scene) else 'the scene by a box filter'

    def missing(self):
        absent = [name for name in ('numpy', 'mitsuba') if importlib.util.find_spec(name) is None]
        return f"it needs the Python package {' and '.join(absent)} (pip install mitsuba numpy)" if absent else None

    def version(self):
        return importlib.metadata.version('mitsuba') + hash_of_scripts('mitsuba_run.py', 'mitsuba_scene.py')

    def render(self, task):
        out = os.path.join(self.folder, 'mitsuba.npy')
        request = {'scene': task.scene, 'variant': self.variant, 'width': task.size[0], 'height': task.size[1],
                   'spp': 16 * task.work, 'seed': task.seed, 'denoise': task.denoise,
                   'box_filter': task.box_filter or task.denoise, 'out': out}
        program = [sys.executable, os.path.join(HERE, 'mitsuba_run.py'), json.dumps(request)]
        output, process, processor = timed(program, self.max_seconds)
        seconds = json.loads(output.strip().splitlines()[-1])
        return Picture(np.load(out), {'render': seconds['render'], 'process': process, 'processor': processor})


class Cycles:
    """Blender's path tracer. Its work is 16 samples a pixel. It wants scenes in Blender's own form, with materials of which some
    differ from Mitsuba's, and it weighs samples by a filter of its own: it has a limit of its own."""
    family = 'Cycles'
    limit = 'Cycles'

    def __init__(self, guided, folder, max_seconds):
        self.guided, self.folder, self.max_seconds = guided, folder, max_seconds
        self.label = 'Cycles, guided' if guided else 'Cycles'

    def denoised_limit(self, _scene):
        return self.limit

    def missing(self):
        absent = [name for name in ('numpy', 'mitsuba', 'bpy') if importlib.util.find_spec(name) is None]
        return f"it needs the Python package {' and '.join(absent)} (pip install mitsuba numpy bpy)" if absent else None

    def version(self):
        scripts = ('cycles_run.py', 'cycles_scene.py', 'scene_export.py', 'mitsuba_scene.py')
        return importlib.metadata.version('bpy') + hash_of_scripts(*scripts)

    def render(self, task):
        out = os.path.join(self.folder, 'cycles.exr')
        request = {'scene': self._exported(task.scene), 'width': task.size[0], 'height': task.size[1], 'spp': 16 * task.work,
                   'seed': task.seed, 'guided': self.guided, 'denoise': task.denoise, 'out': out}
        program = [sys.executable, os.path.join(HERE, 'cycles_run.py'), json.dumps(request)]
        output, process, processor = timed(program, self.max_seconds)
        seconds = json.loads(output.strip().splitlines()[-1])
        return Picture(read_exr(out), {'render': seconds['render'], 'process': process, 'processor': processor})

    def _exported(self, scene):
        """The scene in a neutral form, which is not part of what is measured."""
        digest = hash_of_files([*files_of_scene(scene), EXPORT, os.path.join(HERE, 'mitsuba_scene.py')])
        digest.update(os.path.abspath(scene).encode())
        out = os.path.join(self.folder, f'scene-{digest.hexdigest()[:16]}.npz')
        if not os.path.exists(out):
            timed([sys.executable, EXPORT, json.dumps({'scene': scene, 'out': out})], self.max_seconds)
        return out


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
