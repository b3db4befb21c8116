# SPDX-License-Identifier: Apache-2.0
"""Frames of an animation are those of the program, whatever was made before."""

import os
import subprocess

import numpy as np
import pytest

import nearlight
from gltf import animated_room

SMALL = {
    "width": 24,
    "height": 16,
    "vpl_count": 60,
    "samples_per_pixel": 2,
    "rays_per_pixel": 2,
    "direct_samples_per_pixel": 4,
}
OPTIONS = ["--size", "24x16", "--vpls", "60", "--spp", "2", "--rays", "2", "--direct-samples", "4"]


@pytest.fixture(scope="module")
def room(tmp_path_factory):
    return animated_room(tmp_path_factory.mktemp("room"))


@pytest.fixture(scope="module")
def program():
    """The program of the same build."""
    return os.environ["NEARLIGHT_PROGRAM"]


def values(animation, frame, **fields):
    return animation.render(frame, **{**SMALL, **fields}).image.values


def test_facts(room):
    animation = nearlight.Animation(room)
    assert (animation.begin, animation.end) == (0, 2)
    assert repr(animation) == "<nearlight.Animation from 0.0 to 2.0 s>"
    assert nearlight.Animation(room, animations=["rise"]).begin == 1.5
    assert nearlight.Animation(room, animations=[2]).begin == 1.5


# Frames 0 to 4 at 4 a second are the walk; in 7 the lamp is on its way.
@pytest.mark.parametrize("keywords, options", [({}, []), ({"vpl_keys": 0}, ["--vpl-keys", "0"])])
def test_frames_have_the_bits_of_the_program(room, program, tmp_path, keywords, options):
    frames = (1, 2, 7)
    for frame in frames:
        command = [program, "render", room, "--frames", str(frame), "--fps", "4", *OPTIONS, *options]
        command += ["--exr-precision", "float", "-o", tmp_path / "f.#.exr", "--quiet"]
        subprocess.run(list(map(str, command)), check=True, timeout=120)
    animation = nearlight.Animation(room, fps=4, **keywords)
    for frame in reversed(frames):
        file = nearlight.read_image(tmp_path / f"f.{frame}.exr")
        picture = animation.render(frame, **SMALL)
        for layer in ("beauty", "direct", "indirect", "depth"):
            assert np.array_equal(picture[layer], file[layer]), (frame, layer)


def test_settings_may_change_from_frame_to_frame(room):
    animation = nearlight.Animation(room, fps=4)
    first = values(animation, 1)
    assert not np.array_equal(values(animation, 1, vpl_count=20), first)
    assert not np.array_equal(values(animation, 2), first)
    assert not np.array_equal(values(animation, 1, sampler="instant_radiosity"), first)
    assert np.array_equal(values(animation, 1), first)


def test_vpls_fade_from_key_view_to_key_view(room):
    own, fading = (nearlight.Animation(room, fps=4, vpl_keys=keys) for keys in (0, 4))
    assert np.array_equal(values(own, 0), values(fading, 0))
    assert not np.array_equal(values(own, 1), values(fading, 1))


def test_progress_stops_a_frame_and_errors_leave_the_animation_as_it_was(room):
    animation = nearlight.Animation(room, fps=4)
    assert animation.render(1, progress=lambda done: False, width=256, height=256).interrupted
    with pytest.raises(nearlight.InvalidArgument, match="frame is -1"):
        animation.render(-1)
    with pytest.raises(nearlight.InvalidArgument, match="vpl_count"):
        animation.render(1, vpl_count=2**31)
    room_json = room.read_text()
    expected = values(animation, 7)
    try:
        room.write_text("{")
        with pytest.raises(nearlight.Error, match="room.gltf"):
            values(animation, 8)
    finally:
        room.write_text(room_json)
    assert np.array_equal(values(animation, 7), expected)


def test_what_cannot_be_animated(room, floor):
    with pytest.raises(nearlight.InvalidArgument, match="has no animations"):
        nearlight.Animation(floor)
    with pytest.raises(nearlight.InvalidArgument, match="has no animation 'wakl'; did you mean 'walk'"):
        nearlight.Animation(room, animations=["wakl"])
    with pytest.raises(nearlight.InvalidArgument, match="fps is 0"):
        nearlight.Animation(room, fps=0)
    with pytest.raises(nearlight.InvalidArgument, match="needs a target too"):
        nearlight.Animation(room, load=nearlight.LoadOptions(origin=(0, 1, 2)))
    with pytest.raises(TypeError, match="animations must be a sequence of names or numbers, not 'walk'"):
        nearlight.Animation(room, animations="walk")
    with pytest.raises(TypeError, match="did you mean 'fps'"):
        nearlight.Animation(room, fpps=25)
