# SPDX-License-Identifier: Apache-2.0
"""What the tests share: a floor whose light is known in closed form, and a session of it."""

import os
import pathlib

import pytest

import nearlight

SOURCE = pathlib.Path(os.environ["NEARLIGHT_SOURCE_DIR"])


@pytest.fixture(scope="session")
def source():
    """The root of the repository."""
    return SOURCE


@pytest.fixture(scope="session")
def floor():
    """A floor of 2 m × 2 m at z = 0 that reflects one half, under a point light of 1, 2, 3 W/sr at z = 1."""
    return SOURCE / "tests/install/floor.xml"


WALL = """
    <shape type="rectangle">
        <transform name="to_world"><rotate x="1" angle="90"/><translate y="1" z="1"/></transform>
        <bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.5, 0.4"/></bsdf>
    </shape>
</scene>"""


@pytest.fixture(scope="session")
def corner(floor, tmp_path_factory):
    """The same floor with a wall behind it."""
    file = tmp_path_factory.mktemp("corner") / "corner.xml"
    file.write_text(floor.read_text().replace("</scene>", WALL))
    return file


@pytest.fixture(scope="session", autouse=True)
def device():
    """Skips where no device can be used, unless one is required."""
    devices = nearlight.list_devices()
    if not any(info.unusable_because == "" for info in devices):
        found = "; ".join(f"{info.name}: {info.unusable_because}" for info in devices) or "there is none"
        if os.environ.get("NEARLIGHT_REQUIRE_DEVICE") == "1":
            pytest.fail(f"no usable OpenCL device ({found}), and NEARLIGHT_REQUIRE_DEVICE is 1")
        pytest.skip(f"no usable OpenCL device ({found})")


@pytest.fixture(scope="session")
def session(device, floor):
    return nearlight.Session(floor)


@pytest.fixture(scope="session")
def picture(session):
    return session.render(width=48, height=32, vpl_count=100, samples_per_pixel=1)


@pytest.fixture(scope="session")
def vpls(session):
    return session.sample(session.look(), vpl_count=500)
