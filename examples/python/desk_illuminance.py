#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The illuminance on a desk under a lamp, in lux, beside the inverse-square law.

The law knows the lamp alone: E = I·cosθ/d² = I·h/(h² + r²)^1.5 at the distance r from the point below a lamp of the
intensity I at the height h. With a black wall (--wall 0), only the desk itself could reflect light to the desk, and it is
flat; so renderer and law agree. A white wall adds its light.

desk_illuminance.py [--wall REFLECTANCE] [--points N]
"""

import argparse
import pathlib

import numpy as np

import nearlight

INTENSITY = 100.0  # cd
DESK_HEIGHT = 0.75  # m
LAMP_HEIGHT = 0.6  # m over the desk
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # of linear sRGB


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--wall", type=float, default=0.7, help="reflectance of the wall behind the desk, 0 to 1")
    parser.add_argument("--points", type=int, default=9)
    arguments = parser.parse_args()

    file = pathlib.Path(__file__).with_name("lamp_over_desk.xml")
    session = nearlight.Session(nearlight.load(file, definitions={"wall": arguments.wall}))
    # VPLs of instant radiosity are spread over the whole scene, wherever the camera looks.
    vpls = session.sample(session.look(), sampler="instant_radiosity", vpl_count=2000)

    x = np.linspace(-0.7, 0.7, arguments.points)
    points = np.stack([x, np.zeros_like(x), np.full_like(x, DESK_HEIGHT)], axis=-1)
    lux = session.irradiance(points, [0, 0, 1], vpls, direct_samples=64, paths=64) @ LUMINANCE
    law = INTENSITY * LAMP_HEIGHT / (LAMP_HEIGHT**2 + x**2) ** 1.5

    print("   x m   lux  law lux  from the wall")
    for place, value, expected in zip(x, lux, law):
        print(f"{place:6.2f} {value:5.1f} {expected:8.1f} {100 * (value - expected) / value:12.1f} %")


if __name__ == "__main__":
    main()
