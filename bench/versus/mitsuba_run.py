# SPDX-License-Identifier: Apache-2.0
"""Renders one picture with Mitsuba 3: mitsuba_run.py '{"scene", "variant", "width", "height", "spp", "seed", "denoise", "box_filter", "out"}'.

Writes the picture as an array of RGB to the file "out" and prints the seconds of its steps as one JSON object.
"""
import json
import os
import sys
import time

import mitsuba_scene

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../tests/peers'))
SAMPLES_A_PASS = 64      # the LLVM variants keep all rays of a pass in memory


def loaded(mi, request):
    scene = mitsuba_scene.loaded(mi, request['scene'], request['box_filter'])
    parameters = mi.traverse(scene)
    size, = (name for name in parameters.keys() if name.endswith('film.size'))
    parameters[size] = [request['width'], request['height']]
    parameters.update()
    return scene


def rendered(mi, np, scene, request):
    """The mean of passes of at most SAMPLES_A_PASS, with the auxiliaries of a denoiser behind RGB if they are wanted."""
    integrator = scene.integrator()
    if request['denoise']:
        integrator = mi.load_dict({'type': 'aov', 'aovs': 'albedo:albedo,normal:sh_normal', 'image': integrator})
    left, total = request['spp'], None
    while left > 0:
        spp = min(left, SAMPLES_A_PASS)
        seed = (request['seed'] * 0x9e3779b1 + left) % (1 << 32)
        picture = np.array(mi.render(scene, integrator=integrator, spp=spp, seed=seed), dtype=np.float32) * spp
        total = picture if total is None else total + picture
        left -= spp
    return total / request['spp']


def main():
    request = json.loads(sys.argv[1])
    started = time.perf_counter()
    import mitsuba_worker
    mitsuba_worker.point_to_llvm()
    import mitsuba as mi
    import numpy as np
    mi.set_variant(request['variant'])
    mi.set_log_level(mi.LogLevel.Error)
    scene = loaded(mi, request)
    seconds = {'load': time.perf_counter() - started}
    started = time.perf_counter()
    picture = rendered(mi, np, scene, request)
    seconds['render'] = time.perf_counter() - started
    light = picture[..., :3] if picture.shape[2] >= 3 else np.repeat(picture[..., :1], 3, axis=2)
    if request['denoise']:
        import oidn
        started = time.perf_counter()
        surfaces = picture[..., -6:]     # the auxiliaries come last, after alpha if the film has one
        light = oidn.Denoiser().denoised(light, surfaces[..., :3], surfaces[..., 3:])
        seconds['render'] += time.perf_counter() - started
    np.save(request['out'], light)
    print(json.dumps(seconds), flush=True)
    os._exit(0)          # Mitsuba's threads may hang at exit


if __name__ == '__main__':
    main()
