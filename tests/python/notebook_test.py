# SPDX-License-Identifier: Apache-2.0
"""Pictures show themselves in notebooks."""

import numpy as np

import nearlight


def test_pictures_are_png(picture, tmp_path):
    file = tmp_path / "a.png"
    file.write_bytes(picture._repr_png_())
    shown = nearlight.read_image(file)
    assert (shown.width, shown.height) == (48, 32)
    picture.write(tmp_path / "b.png")
    assert np.array_equal(shown.values, nearlight.read_image(tmp_path / "b.png").values)
    assert picture.image._repr_png_() == picture._repr_png_()


def test_images_without_colours_show_their_text():
    image = nearlight.Image(np.zeros((2, 3)))
    assert image._repr_png_() is None
    assert repr(image) == "<nearlight.Image 3x2: Y>"
