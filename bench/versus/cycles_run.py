# SPDX-License-Identifier: Apache-2.0
"""Renders one picture with Cycles: cycles_run.py '{"scene", "width", "height", "spp", "seed", "guided", "denoise", "out"}'.

"scene" is a file of scene_export.py. Writes the picture to the EXR file "out", and prints the seconds of its steps as one JSON object.
"""
import json
import os
import sys
import time

MAX_BOUNCES = 1024


def set_up(scene, request, max_edges):
    """As Mitsuba renders: no clamp, no filter of gloss, all bounces, every sample of every pixel."""
    scene.render.engine = 'CYCLES'
    scene.render.resolution_x, scene.render.resolution_y = request['width'], request['height']
    scene.render.resolution_percentage = 100
    scene.render.film_transparent = False
    scene.render.image_settings.file_format = 'OPEN_EXR'
    scene.render.image_settings.color_depth = '32'
    scene.render.filepath = request['out']
    cycles = scene.cycles
    cycles.device = 'CPU'
    cycles.samples, cycles.seed = request['spp'], request['seed'] % (1 << 31)
    cycles.use_adaptive_sampling = False
    cycles.pixel_filter_type = 'BOX'
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.blur_glossy = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.light_sampling_threshold = 0
    bounces = MAX_BOUNCES if max_edges is None else max(max_edges - 2, 0)
    for kind in ('max', 'diffuse', 'glossy', 'transmission', 'transparent_max'):
        setattr(cycles, f'{kind}_bounces', bounces)
    cycles.use_guiding = request['guided']
    cycles.use_denoising = request['denoise']
    cycles.denoiser = 'OPENIMAGEDENOISE'
    cycles.denoising_prefilter = 'ACCURATE'


def main():
    request = json.loads(sys.argv[1])
    started = time.perf_counter()
    import bpy
    import cycles_scene
    description = cycles_scene.build(request['scene'])
    set_up(bpy.context.scene, request, description['max_edges'])
    seconds = {'load': time.perf_counter() - started}
    started = time.perf_counter()
    bpy.ops.render.render(write_still=True)
    seconds['render'] = time.perf_counter() - started
    print(json.dumps(seconds), flush=True)
    os._exit(0)


if __name__ == '__main__':
    main()
