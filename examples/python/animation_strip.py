#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A strip of pictures of an animated glTF file, from its first moment to its last.

animation_strip.py FILE STRIP.png [--count N] [--width PIXELS] [--exposure STOPS]
"""

import argparse

import numpy as np

import nearlight


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file")
    parser.add_argument("strip")
    parser.add_argument("--count", type=int, default=6)
    parser.add_argument("--width", type=int, default=160)
    parser.add_argument("--vpls", type=int, default=500)
    parser.add_argument("--exposure", type=float, default=0.0)
    arguments = parser.parse_args()

    # With a hundred frames a second, a frame is at most 5 ms away from any moment.
    animation = nearlight.Animation(arguments.file, fps=100)
    pictures = []
    for seconds in np.linspace(animation.begin, animation.end, arguments.count):
        frame = round(100 * seconds)
        picture = animation.render(
            frame, width=arguments.width, height=arguments.width * 3 // 4, vpl_count=arguments.vpls
        )
        pictures.append(picture["beauty"])
        print(f"{frame / 100:.2f} s: mean radiance {pictures[-1].mean():.3g}")
    strip = nearlight.Image(np.concatenate(pictures, axis=1))
    strip.write(arguments.strip, exposure=arguments.exposure)


if __name__ == "__main__":
    main()
