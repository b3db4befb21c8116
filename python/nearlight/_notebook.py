# SPDX-License-Identifier: Apache-2.0
"""How pictures show themselves in notebooks."""

from __future__ import annotations

import os
import tempfile
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from . import Image


def png(image: Image) -> bytes | None:
    """The bytes of the image as a PNG file, or None if it has no R, G and B."""
    if not {"R", "G", "B"} <= set(image.channels):
        return None
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "picture.png")
        image.write(file)
        with open(file, "rb") as stream:
            return stream.read()
