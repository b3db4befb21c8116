# SPDX-License-Identifier: Apache-2.0
"""The scripts in examples/python/ do what they say."""

import json
import re
import subprocess
import sys

import numpy as np
import pytest

import nearlight
from gltf import animated_room


@pytest.fixture
def run(source):
    """Runs an example with arguments, and returns what it prints."""

    def run_example(name, *arguments):
        command = [sys.executable, "-B", str(source / "examples/python" / name), *map(str, arguments)]
        result = subprocess.run(command, capture_output=True, text=True)
        assert result.returncode == 0, result.stderr
        return result.stdout

    return run_example


def test_heat_map_shows_where_vpls_lie(run, corner, tmp_path):
    text = run("vpl_heat_map.py", corner, tmp_path / "map.png", "--vpls", 3000, "--width", 64)
    count, close = map(int, re.match(r"(\d+) VPLs, (\d+) of them", text).groups())
    assert 2000 < count < 4500
    assert 0 < close <= count
    image = nearlight.read_image(tmp_path / "map.png")
    assert image.width == 64
    # Wherever the camera sees the floor or the wall, there are VPLs of the close range; the sky stays dark.
    red = image["beauty"][..., 0]
    assert red.max() > 0.5
    assert (red > 0.2).mean() > 0.3


def test_illuminance_follows_the_law_where_the_wall_is_black(run):
    rows = np.array([line.split()[:3] for line in run("desk_illuminance.py", "--wall", 0).splitlines()[1:]], float)
    assert rows.shape == (9, 3)
    assert rows[:, 1] == pytest.approx(rows[:, 2], rel=0.005)
    white = np.array([line.split()[:3] for line in run("desk_illuminance.py", "--wall", 0.7).splitlines()[1:]], float)
    assert np.all(white[:, 1] > 1.02 * white[:, 2])


def test_vpls_that_stay_put_do_not_flicker(run, corner, tmp_path):
    arguments = (corner, tmp_path / "frames", "--frames", 8, "--width", 64, "--height", 48, "--vpls", 200, "--degrees", 6)

    def change(text):
        return float(re.search(r"changes by ([\d.]+) %", text).group(1))

    steady = change(run("steady_animation.py", *arguments))
    fresh = change(run("steady_animation.py", *arguments, "--fresh"))
    assert steady < 0.5 * fresh
    assert len(list((tmp_path / "frames").glob("*.png"))) == 8


def test_strips_of_an_animation_show_it_move(run, tmp_path):
    text = run("animation_strip.py", animated_room(tmp_path), tmp_path / "strip.png", "--count", 3, "--width", 32)
    assert [line.split(":")[0] for line in text.splitlines()] == ["0.00 s", "1.00 s", "2.00 s"]
    strip = nearlight.read_image(tmp_path / "strip.png")["beauty"]
    assert strip.shape == (24, 96, 3)
    begin, middle, end = np.split(strip, 3, axis=1)
    assert abs(begin - middle).mean() > 0.01  # the camera has walked
    assert 1e-3 < abs(middle - end).mean()  # and then the lamp has risen


def test_data_set_has_views_and_cameras(run, corner, tmp_path):
    run("view_data_set.py", corner, tmp_path, "--views", 5, "--width", 32, "--height", 24, "--vpls", 200)
    cameras = json.loads((tmp_path / "cameras.json").read_text())
    assert len(cameras) == 5
    means = []
    for index, camera in enumerate(cameras):
        with np.load(tmp_path / f"{index:03}.npz") as view:
            assert view["beauty"].shape == view["N"].shape == (24, 32, 3)
            assert view["depth"].shape == (24, 32)
            assert view["beauty"] == pytest.approx(view["direct"] + view["indirect"], abs=1e-4)
            seen = view["depth"] > 0
            distance = np.linalg.norm(view["P"] - camera["origin"], axis=-1)
            assert distance[12, 16] == pytest.approx(view["depth"][12, 16], rel=0.05)
            means.append(view["beauty"][seen].mean())
    assert len(set(means)) == 5
