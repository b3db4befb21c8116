# SPDX-License-Identifier: Apache-2.0
"""Sessions give the pictures of the program, from several threads too."""

import gc
import sys
import threading

import numpy as np
import pytest

import nearlight


def test_facts_of_a_scene(floor):
    scene = nearlight.load(floor)
    assert scene.source == floor
    assert scene.triangle_count == 2
    assert (scene.width, scene.height) == (64, 64)
    assert scene.bounds == ((-1, -1, 0), (1, 1, 0))
    assert scene.notes == []
    assert scene.hash() == nearlight.load(str(floor)).hash()
    assert scene.camera.origin == (0, -1.5, 1.5)
    assert scene.camera.fov_x_degrees == pytest.approx(60)


def test_facts_of_devices(floor):
    devices = nearlight.Devices()
    assert len(devices) == len(devices.infos) == 1
    info = devices.infos[0]
    assert info.name in [known.name for known in nearlight.list_devices()]
    assert info.kind in ("cpu", "gpu", "other")
    assert info.name in repr(info) and info.name in repr(devices)
    assert nearlight.Session(floor, info.index).look().width == 64


def test_steps_and_one_call_make_the_same_picture(session):
    view = session.look(width=32, height=32)
    vpls = session.sample(view, vpl_count=100)
    steps = session.gather(view, vpls, samples_per_pixel=1)
    whole = session.render(width=32, height=32, vpl_count=100, samples_per_pixel=1)
    assert np.array_equal(steps.image.values, whole.image.values)
    assert steps.vpl_count == whole.vpl_count == len(vpls)
    assert (whole.passes, whole.interrupted, whole.error) == (1, False, None)
    other = session.render(width=32, height=32, vpl_count=100, samples_per_pixel=1, seed=1)
    assert not np.array_equal(other.image.values, whole.image.values)


def test_passes_and_their_samples(session):
    picture = session.render(width=32, height=32, vpl_count=50, samples_per_pixel=2, passes=3)
    assert picture.passes == 3
    assert picture.pass_samples == [2, 2, 2]
    again = session.render(width=32, height=32, vpl_count=50, pass_samples=picture.pass_samples)
    assert np.array_equal(again.image.values, picture.image.values)


def test_vpls_go_through_a_file(session, tmp_path):
    view = session.look(width=32, height=32)
    vpls = session.sample(view, vpl_count=100)
    file = tmp_path / "vpls.ply"
    session.save_vpls(vpls, file)
    again = session.sample(view, file=file)
    assert np.array_equal(again.lights(), vpls.lights())
    pictures = [session.gather(view, some, samples_per_pixel=1).image.values for some in (vpls, again)]
    assert np.array_equal(*pictures)
    with pytest.raises(nearlight.Error, match="maximum depth"):
        session.sample(session.look(max_depth=3), file=file)


def test_vpls_of_one_view_light_another(session):
    view = session.look(width=33, height=33)
    vpls = session.sample(view, vpl_count=100)
    camera = nearlight.CameraPose(origin=(0, 0, 1), target=(0, 0, 0), up=(0, 1, 0), fov_x_degrees=60)
    above = session.look(camera=camera, width=33, height=33)
    picture = session.gather(above, vpls, samples_per_pixel=1)
    assert picture["P"][16, 16] == pytest.approx([0, 0, 0], abs=0.03)
    assert picture["direct"][16, 16] == pytest.approx(np.array([1, 2, 3]) * 0.5 / np.pi, rel=0.02)


def test_a_window_has_the_pixels_of_the_whole_picture(session):
    settings = nearlight.RenderSettings(width=64, height=48, vpl_count=50, samples_per_pixel=1)
    whole = session.render(settings)
    part = session.render(settings, window=nearlight.PixelWindow(x=10, y=20, width=30, height=8))
    assert np.array_equal(part.image.values, whole.image.values[20:28, 10:40])


def test_progress_goes_up_and_can_stop(session):
    fractions = []
    session.render(width=128, height=128, vpl_count=100, samples_per_pixel=4, passes=8, progress=fractions.append)
    assert fractions == sorted(fractions)
    assert 0 <= fractions[0] < fractions[-1] <= 1
    stopped = session.render(width=256, height=256, progress=lambda fraction: False)
    assert stopped.interrupted
    assert not session.render(width=16, height=16, progress=lambda fraction: 0).interrupted


def test_what_progress_raises_comes_back(session):
    with pytest.raises(ZeroDivisionError):
        session.render(width=64, height=64, progress=lambda fraction: 1 // 0)
    with pytest.raises(nearlight.InvalidArgument, match="callback"):
        session.render(width=64, height=64, progress=lambda fraction: session.look())
    with pytest.raises(TypeError, match="progress must be a function"):
        session.render(progress=1)
    assert session.look().width == 64


def test_threads_take_turns(session):
    expected = session.render(width=48, height=48, vpl_count=100, samples_per_pixel=2).image.values
    pictures = {}

    def work(index):
        for _ in range(3):
            picture = session.render(width=48, height=48, vpl_count=100, samples_per_pixel=2)
            session.sample(session.look(width=8), vpl_count=10)  # is disposed of while others work
            pictures[index] = picture.image.values
            gc.collect()

    threads = [threading.Thread(target=work, args=(index,)) for index in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(pictures) == 4
    assert all(np.array_equal(values, expected) for values in pictures.values())


@pytest.fixture
def threads_stay():
    """Python's threads give way to others only where they wait or release the GIL."""
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e6)
    yield
    sys.setswitchinterval(interval)


def test_python_goes_on_while_a_picture_is_made(session, threads_stay):
    begun = threading.Event()
    wanted = threading.Event()
    pictures = []

    def progress(fraction):
        begun.set()
        return not wanted.is_set()

    def work():
        # Nothing but the main thread ends this picture early.
        pictures.append(session.render(width=1024, height=1024, vpl_count=1000, progress=progress))

    thread = threading.Thread(target=work)
    thread.start()
    begun.wait()
    wanted.set()
    thread.join()
    assert pictures[0].interrupted


def test_products_outlive_their_session(floor):
    other = nearlight.Session(floor)
    vpls = other.sample(other.look(), vpl_count=50)
    del other
    gc.collect()
    assert len(vpls.lights()) == len(vpls)


def test_comparisons_need_a_seed(session, picture):
    with pytest.raises(nearlight.InvalidArgument, match="seeds is 0") as error:
        nearlight.compare(session, session.look(width=48, height=32), picture.image, seeds=0)
    assert error.value.setting == "seeds"


def test_samplers_are_compared(corner):
    session = nearlight.Session(corner)
    view = session.look(width=32, height=32)
    many = session.gather(view, session.sample(view, vpl_count=5000), samples_per_pixel=16, seed=9)
    result = nearlight.compare(session, view, many.image, vpl_counts=(50, 2000), seeds=3, layer="indirect")
    assert [(row.sampler, row.vpl_count) for row in result] == [
        ("close_range", 50),
        ("close_range", 2000),
        ("instant_radiosity", 50),
        ("instant_radiosity", 2000),
    ]
    assert all(row.seeds == 3 and row.gather_seconds > 0 for row in result)
    assert result[3].rmse < result[2].rmse
    assert result[3].mean_ratio == pytest.approx(1, abs=0.05)
    assert "instant_radiosity" in str(result)
    assert result._repr_html_().count("<tr>") == 5
