# SPDX-License-Identifier: Apache-2.0
"""Open Image Denoise for the pictures of other renderers. Its library is where `nearlight render --denoise` finds it."""
import ctypes
import os

import numpy as np

CPU_DEVICE, FLOAT3 = 1, 3


def files():
    if os.environ.get('NEARLIGHT_OIDN'):
        return [os.environ['NEARLIGHT_OIDN']]
    data = os.environ.get('XDG_DATA_HOME') or os.path.expanduser('~/.local/share')
    name = 'libOpenImageDenoise.so.2'
    return [name, os.path.join(data, 'nearlight/oidn/lib', name)]


def loaded():
    """The library, or None."""
    for file in files():
        try:
            return ctypes.CDLL(file)
        except OSError:
            pass
    return None


class Denoiser:
    """Denoises light with albedo and normals that are denoised first, all at the library's best quality."""

    def __init__(self):
        self._oidn = loaded()
        if self._oidn is None:
            raise RuntimeError('no library of Open Image Denoise; run scripts/setup --denoise')
        pointer, text, size = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_size_t
        signatures = {
            'NewDevice': (pointer, [ctypes.c_int]), 'CommitDevice': (None, [pointer]),
            'NewFilter': (pointer, [pointer, text]), 'ReleaseFilter': (None, [pointer]),
            'SetFilterBool': (None, [pointer, text, ctypes.c_bool]),
            'SetSharedFilterImage': (None, [pointer, text, pointer, ctypes.c_int] + [size] * 5),
            'CommitFilter': (None, [pointer]), 'ExecuteFilter': (None, [pointer]),
            'GetDeviceError': (ctypes.c_int, [pointer, ctypes.POINTER(text)]),
        }
        for name, (result, parameters) in signatures.items():
            function = getattr(self._oidn, 'oidn' + name)
            function.restype, function.argtypes = result, parameters
        self._device = self._oidn.oidnNewDevice(CPU_DEVICE)
        self._oidn.oidnCommitDevice(self._device)

    def _filtered(self, hdr, **images):
        images = {name: np.ascontiguousarray(image, dtype=np.float32) for name, image in images.items()}
        first = next(iter(images.values()))
        images['output'] = np.zeros_like(first)
        oidn = self._oidn
        task = oidn.oidnNewFilter(self._device, b'RT')
        for name, image in images.items():
            oidn.oidnSetSharedFilterImage(task, name.encode(), image.ctypes.data, FLOAT3, first.shape[1], first.shape[0], 0, 0, 0)
        oidn.oidnSetFilterBool(task, b'hdr', hdr)
        oidn.oidnSetFilterBool(task, b'cleanAux', hdr)
        oidn.oidnCommitFilter(task)
        oidn.oidnExecuteFilter(task)
        message = ctypes.c_char_p()
        failed = oidn.oidnGetDeviceError(self._device, ctypes.byref(message))
        oidn.oidnReleaseFilter(task)
        if failed:
            raise RuntimeError(f'Open Image Denoise failed: {message.value}')
        return images['output']

    def denoised(self, light, albedo, normal):
        return self._filtered(True, color=light, albedo=self._filtered(False, albedo=albedo),
                              normal=self._filtered(False, normal=normal))
