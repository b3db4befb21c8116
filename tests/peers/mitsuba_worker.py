# SPDX-License-Identifier: Apache-2.0
"""Mitsuba in a process of its own, since its threads may hang at exit and a scene may crash it.

As a program this file reads one JSON request a line from standard input and answers with one JSON object a line:
  {"render": scene, "seeds": [...], "spp": n, "size": [w, h] or null, "block": n, "into": file.npy}   block means of each seed
  {"read": [picture, ...], "block": n, "into": file.npy}   block means of each picture
  {"write": folder}   the files that scenes refer to
`Worker` is the other end. A request that takes too long, or ends the process, is an error; the next starts a new process.
"""
import glob
import json
import os
import queue
import subprocess
import sys
import threading


class MitsubaFailure(Exception):
    """Mitsuba could not do what it was asked for."""


class UnreadableScene(MitsubaFailure):
    """Mitsuba does not read the scene."""


class Worker:
    """Sends requests to the process, which is started when it is needed. What Mitsuba complains of goes to the log."""

    def __init__(self, log):
        self._log = log
        self._process = None
        self._answers = None

    def ask(self, request, seconds):
        if self._process is None or self._process.poll() is not None:
            self._start()
        try:
            self._process.stdin.write(json.dumps(request) + '\n')
            self._process.stdin.flush()
            answer = self._answers.get(timeout=seconds)
        except queue.Empty:
            self.stop()
            raise MitsubaFailure(f'Mitsuba took more than {seconds} s') from None
        except BrokenPipeError:
            answer = None
        if answer is None:
            self.stop()
            raise MitsubaFailure(f'Mitsuba ended, see {self._log}')
        if 'error' in answer:
            raise (UnreadableScene if answer['is_unreadable'] else MitsubaFailure)(answer['error'])
        return answer

    def stop(self):
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            self._process = None

    def _start(self):
        with open(self._log, 'a', encoding='utf-8') as log:
            self._process = subprocess.Popen([sys.executable, os.path.abspath(__file__)], stdin=subprocess.PIPE,
                                             stdout=subprocess.PIPE, stderr=log, text=True)
        self._answers = queue.Queue()
        threading.Thread(target=_pass_on, args=(self._process.stdout, self._answers), daemon=True).start()


def _pass_on(lines, answers):
    """Mitsuba prints notes of its own; answers are the lines that hold an object. None says that the process has ended."""
    for line in lines:
        if line.startswith('{'):
            answers.put(json.loads(line))
    answers.put(None)


def point_to_llvm():
    """Dr.Jit looks for LLVM under the names of its developers; Debian's package libllvm19 needs a hint."""
    found = sorted(glob.glob('/usr/lib/*/libLLVM.so.19*') + glob.glob('/usr/lib/llvm-19/lib/libLLVM.so*'))
    if found and 'DRJIT_LIBLLVM_PATH' not in os.environ:
        os.environ['DRJIT_LIBLLVM_PATH'] = found[0]


def render(mi, np, request):
    """Several independent pictures of a scene, as block means."""
    from agreement import block_means
    try:
        # Mitsuba 3.9.1 merges the meshes that share a BSDF when it optimizes a scene, and the merged meshes of open
        # rooms get wrong light: a room behind a window is 20 % too bright.
        scene = mi.load_file(request['render'], optimize=False)
    except Exception as failure:
        raise UnreadableScene(failure) from None
    if request['size']:
        parameters = mi.traverse(scene)
        size, = (name for name in parameters.keys() if name.endswith('film.size'))   # scenes with one sensor only
        parameters[size] = request['size']
        parameters.update()
    pictures = []
    for seed in request['seeds']:
        picture = np.array(mi.render(scene, spp=request['spp'], seed=seed))
        picture = picture[..., :3] if picture.shape[2] >= 3 else np.repeat(picture[..., :1], 3, axis=2)
        pictures.append(block_means(picture, request['block']))
    np.save(request['into'], np.array(pictures))
    return {'shape': list(picture.shape)}


def read(mi, np, request):
    """Pictures from files. A picture of one channel is grey."""
    from agreement import block_means
    pictures = []
    for name in request['read']:
        bitmap = mi.Bitmap(name)
        channels = [f.name for f in bitmap.struct_()]
        picture = np.array(bitmap).reshape(bitmap.height(), bitmap.width(), -1)
        wanted = ('R', 'G', 'B') if 'R' in channels else ('Y', 'Y', 'Y')
        picture = picture[..., [channels.index(c) for c in wanted]]
        pictures.append(block_means(picture, request['block']))
    np.save(request['into'], np.array(pictures))
    return {'shape': list(picture.shape)}


def choose_variant(mi):
    """Compiled kernels are several times faster where LLVM is found. Pictures have the same expectation."""
    try:
        mi.set_variant('llvm_ad_rgb')
        import drjit
        drjit.eval(mi.Float(1) + drjit.opaque(mi.Float, 1))
    except Exception as failure:
        print(f'rendering without LLVM: {failure}', file=sys.stderr)
        mi.set_variant('scalar_rgb')


def main():
    point_to_llvm()
    import mitsuba as mi
    import numpy as np
    choose_variant(mi)
    mi.set_log_level(mi.LogLevel.Error)
    for line in sys.stdin:
        request = json.loads(line)
        try:
            if 'render' in request:
                answer = render(mi, np, request)
            elif 'read' in request:
                answer = read(mi, np, request)
            else:
                import assets
                assets.write(request['write'])
                answer = {}
        except Exception as failure:
            is_unreadable = isinstance(failure, UnreadableScene)
            while failure.__cause__ is not None:
                failure = failure.__cause__
            answer = {'error': ' '.join(str(failure).split()), 'is_unreadable': is_unreadable}
        print(json.dumps(answer), flush=True)
    os._exit(0)


if __name__ == '__main__':
    main()
