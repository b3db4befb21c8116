#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A data set for learning: many views of a scene, lit by one set of VPLs, with the layers of each and its camera.

Writes FOLDER/000.npz, … with the arrays beauty, direct, indirect, albedo, N, P and depth, and FOLDER/cameras.json. The
cameras stand around the scene's own and look at what it looks at.

view_data_set.py SCENE FOLDER [--views N]
"""

import argparse
import json
import pathlib
import time

import numpy as np

import nearlight

LAYERS = ("beauty", "direct", "indirect", "albedo", "N", "P", "depth")


def poses(camera, distance, count, seed):
    """Cameras that stand around `camera` and look at the point at `distance` in front of it."""
    random = np.random.default_rng(seed)
    origin = np.asarray(camera.origin)
    forward = np.asarray(camera.target) - origin
    target = origin + distance * forward / np.linalg.norm(forward)
    for _ in range(count):
        yield nearlight.CameraPose(
            origin=origin + random.uniform(-0.15, 0.15, 3) * distance,
            target=target + random.uniform(-0.1, 0.1, 3) * distance,
            up=camera.up,
            fov_x_degrees=camera.fov_x_degrees,
        )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--views", type=int, default=50)
    parser.add_argument("--width", type=int, default=128)
    parser.add_argument("--height", type=int, default=96)
    parser.add_argument("--vpls", type=int, default=4000)
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)

    scene = nearlight.load(arguments.scene)
    session = nearlight.Session(scene)
    size = {"width": arguments.width, "height": arguments.height}
    # Walks of light fill the whole scene with VPLs, whatever a single camera sees.
    middle = session.look(**size)
    vpls = session.sample(middle, sampler="instant_radiosity", vpl_count=arguments.vpls, seed=arguments.seed)

    cameras = []
    start = time.perf_counter()
    for index, pose in enumerate(poses(scene.camera, 0.6 * middle.range, arguments.views, arguments.seed)):
        picture = session.gather(session.look(camera=pose, **size), vpls, seed=arguments.seed + index)
        np.savez_compressed(arguments.folder / f"{index:03}.npz", **{name: picture[name] for name in LAYERS})
        cameras.append({"origin": pose.origin, "target": pose.target, "up": pose.up, "fov_x_degrees": pose.fov_x_degrees})
    (arguments.folder / "cameras.json").write_text(json.dumps(cameras, indent=1))
    print(f"{arguments.views} views by {len(vpls)} VPLs in {time.perf_counter() - start:.1f} s")


if __name__ == "__main__":
    main()
