#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Where a sampler puts its VPLs: paints their density (VPLs per m³) on the surfaces that the camera sees.

vpl_heat_map.py SCENE OUT.png [--sampler NAME] [--vpls N] [--cell METRES]
"""

import argparse

import numpy as np

import nearlight


def cells_of(points, cell):
    """Names the cubes of a grid that hold the points, each by one number."""
    x, y, z = np.floor(points / cell).astype(np.int64).T
    return (x * 2_097_152 + y) * 2_097_152 + z


def density_at(points, positions, cell):
    """The VPLs per m³ in the grid's cube of each point."""
    cubes, counts = np.unique(cells_of(positions, cell), return_counts=True)
    wanted = cells_of(points, cell)
    index = np.minimum(np.searchsorted(cubes, wanted), len(cubes) - 1)
    return np.where(cubes[index] == wanted, counts[index], 0) / cell**3


def colors_of(shares):
    """Colours from dark blue (0) through red to white (1)."""
    stops = np.array([[0.0, 0.0, 0.08], [0.1, 0.0, 0.5], [0.8, 0.05, 0.1], [1.0, 0.6, 0.0], [1.0, 1.0, 1.0]])
    at = np.linspace(0, 1, len(stops))
    return np.stack([np.interp(shares, at, stops[:, channel]) for channel in range(3)], axis=-1)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("output")
    parser.add_argument("--sampler", default="close_range")
    parser.add_argument("--vpls", type=int, default=20_000)
    parser.add_argument("--cell", type=float, help="side of the cubes in which VPLs are counted, m")
    parser.add_argument("--width", type=int)
    arguments = parser.parse_args()

    scene = nearlight.load(arguments.scene)
    session = nearlight.Session(scene)
    width = arguments.width or scene.width
    view = session.look(width=width, height=max(1, round(width * scene.height / scene.width)))
    cell = arguments.cell or view.range / 40
    vpls = session.sample(view, sampler=arguments.sampler, vpl_count=arguments.vpls)
    positions = vpls.lights()["position"]

    # A single sample through the middle of each pixel says which point it shows.
    seen = session.gather(view, session.sample(view, vpl_count=0), samples_per_pixel=1)
    points = seen["P"].reshape(-1, 3)
    density = density_at(points, positions, cell).reshape(seen["depth"].shape)
    density[seen["depth"] == 0] = 0

    shares = np.log1p(density) / np.log1p(max(density.max(), 1))
    facing = 0.4 + 0.6 * np.abs(seen["N"] @ np.array([0.3, 0.5, 0.8]))  # so that shapes stay visible
    nearlight.Image(colors_of(shares) * facing[..., None]).write(arguments.output)
    print(f"{len(vpls)} VPLs, {vpls.close_count} of them in the close range of {view.range:.3g} m")
    print(f"up to {density.max():.3g} per m³ in cubes of {cell:.3g} m")


if __name__ == "__main__":
    main()
