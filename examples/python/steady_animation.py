#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""An animation that hardly flickers: the camera moves, and the VPLs stay where they are.

Makes frames FOLDER/0000.png, … of a camera that turns about the middle of what it sees. VPLs are placed once and light
every frame. What flickers is measured: a surface that scatters light evenly looks alike from everywhere, so a point that
two frames see should have the same indirect light in both. With --fresh, every frame has VPLs of its own, as a renderer
without memory would.

steady_animation.py SCENE FOLDER [--frames N] [--degrees ANGLE] [--fresh]
"""

import argparse
import pathlib

import numpy as np

import nearlight


def frame_of(pose):
    """The camera's axes: right, down and forward."""
    forward = np.subtract(pose.target, pose.origin)
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, pose.up)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(forward, right), forward])


def turned(pose, distance, degrees):
    """The pose, turned about its upward axis through the point at `distance` in front of it."""
    right, down, forward = frame_of(pose)
    angle = np.radians(degrees)
    middle = np.asarray(pose.origin) + distance * forward
    origin = middle - distance * (np.cos(angle) * forward + np.sin(angle) * right)
    return nearlight.CameraPose(origin=origin, target=middle, up=-down, fov_x_degrees=pose.fov_x_degrees)


def whole(picture):
    """Whether a pixel shows a single smooth surface: averages of different normals are shorter than 1."""
    return np.linalg.norm(picture["N"], axis=-1) > 0.999


def flicker(before, after, pose):
    """The median change of indirect light at points of one picture that the next one sees too, as a share of it."""
    height, width = after["depth"].shape
    points = before["P"][whole(before)]
    light = before["indirect"][whole(before)].mean(axis=-1)
    local = (points - np.asarray(pose.origin)) @ frame_of(pose).T
    scale = width / (2 * np.tan(np.radians(pose.fov_x_degrees) / 2)) / np.maximum(local[:, 2], 1e-6)
    column = np.floor(local[:, 0] * scale + width / 2).astype(int)
    row = np.floor(local[:, 1] * scale + height / 2).astype(int)
    inside = (local[:, 2] > 0) & (0 <= column) & (column < width) & (0 <= row) & (row < height)
    column, row = column[inside], row[inside]
    moved = np.linalg.norm(points[inside] - after["P"][row, column], axis=-1)
    same = whole(after)[row, column] & (moved < 2 / scale[inside]) & (light[inside] > 0)
    old = light[inside][same]
    return np.median(np.abs(after["indirect"][row, column][same].mean(axis=-1) - old) / old)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--frames", type=int, default=24)
    parser.add_argument("--degrees", type=float, default=20)
    parser.add_argument("--width", type=int, default=320)
    parser.add_argument("--height", type=int, default=240)
    parser.add_argument("--vpls", type=int, default=1000)
    parser.add_argument("--fresh", action="store_true", help="new VPLs for every frame")
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)

    scene = nearlight.load(arguments.scene)
    session = nearlight.Session(scene)
    size = {"width": arguments.width, "height": arguments.height}
    first = session.look(**size)
    vpls = session.sample(first, vpl_count=arguments.vpls)
    before = None
    changes = []
    for index, degrees in enumerate(np.linspace(-0.5, 0.5, arguments.frames) * arguments.degrees):
        pose = turned(scene.camera, 0.6 * first.range, degrees)
        # The first view's clamp radius, for otherwise the light near corners would change with the view.
        view = session.look(camera=pose, range=first.range, clamp_radius=first.clamp_radius, **size)
        if arguments.fresh:
            vpls = session.sample(view, vpl_count=arguments.vpls, seed=index)
        # With one stratum every sample asks all VPLs. Then nothing but VPLs decides about the indirect light.
        picture = session.gather(view, vpls, samples_per_pixel=4, strata=1, compensate=False)
        picture.write(arguments.folder / f"{index:04}.png")
        if before is not None:
            changes.append(flicker(before, picture, pose))
        before = picture
    print(f"{arguments.frames} frames, {len(vpls)} VPLs; from frame to frame indirect light changes by "
          f"{100 * np.mean(changes):.2f} %")


if __name__ == "__main__":
    main()
