# SPDX-License-Identifier: Apache-2.0
"""Pictures and VPLs are arrays on the library's own memory; arrays of any order and type go in."""

import gc

import numpy as np
import pytest

import nearlight


def test_layers_are_views_of_the_picture(picture):
    values = picture.image.values
    assert values.shape == (32, 48, len(nearlight.picture_channels()))
    assert values.dtype == np.float32
    assert picture["beauty"].shape == picture["indirect"].shape == (32, 48, 3)
    assert picture["depth"].shape == (32, 48)
    for layer in picture.image.layers:
        assert np.shares_memory(picture[layer], values)
        assert not picture[layer].flags.owndata
    picture["depth"][3, 5] = 77
    assert values[3, 5, picture.image.channels.index("depth.Z")] == 77


def test_arrays_keep_their_picture_alive(session):
    layer = session.render(width=32, height=32, vpl_count=10, samples_per_pixel=1)["P"]
    copy = layer.copy()
    gc.collect()
    rubbish = [np.full((32, 32, 23), 9, np.float32) for _ in range(50)]
    assert len(rubbish) == 50
    assert np.array_equal(layer, copy)


def test_channels_in_another_order_are_a_view_too():
    image = nearlight.Image(np.arange(12).reshape(1, 2, 6), ["a.B", "R", "a.G", "G", "a.R", "B"])
    assert np.array_equal(image["a"], [[[0, 2, 4], [6, 8, 10]]])
    assert np.shares_memory(image["a"], image.values)
    assert np.array_equal(image["beauty"], [[[1, 3, 5], [7, 9, 11]]])


def test_uneven_channels_are_copied():
    image = nearlight.Image(np.arange(4).reshape(1, 1, 4), ["a.R", "a.G", "Z", "a.B"])
    assert np.array_equal(image["a"], [[[0, 1, 3]]])
    assert not np.shares_memory(image["a"], image.values)


@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.float16, np.int16, np.uint8])
@pytest.mark.parametrize("order", ["C", "F"])
def test_images_take_any_type_and_order(dtype, order):
    given = np.array(np.arange(24).reshape(4, 2, 3), dtype=dtype, order=order)[::2, ::-1]
    image = nearlight.Image(given)
    assert image.channels == ["R", "G", "B"]
    assert np.array_equal(image["beauty"], given)
    assert not np.shares_memory(image.values, given)


def test_images_of_one_channel():
    image = nearlight.Image([[1, 2], [3, 4]])
    assert image.channels == ["Y"]
    assert image.values.shape == (2, 2, 1)
    assert np.array_equal(image["Y"], [[1, 2], [3, 4]])


@pytest.mark.parametrize(
    "values, channels",
    [
        (np.zeros(3), None),
        (np.zeros((2, 2, 2, 2)), None),
        (np.zeros((2, 2, 5)), None),
        (np.zeros((2, 2, 3)), ["R", "G"]),
    ],
)
def test_images_of_wrong_shape_are_refused(values, channels):
    with pytest.raises(nearlight.InvalidArgument):
        nearlight.Image(values, channels)


@pytest.mark.parametrize("shape", [(0, 5, 3), (5, 0), (2, 2, 0)])
def test_images_without_pixels_are_refused(shape):
    with pytest.raises(nearlight.InvalidArgument, match="an image needs at least one pixel") as error:
        nearlight.Image(np.zeros(shape))
    assert str(shape) in str(error.value)


@pytest.mark.parametrize("values", ["text", [["a"]], np.zeros((2, 2, 3), complex), [[None]], [[1], [1, 2]]])
def test_images_of_wrong_type_are_refused(values):
    with pytest.raises((TypeError, ValueError)):
        nearlight.Image(values)


def test_vpls_are_records(vpls):
    lights = vpls.lights()
    assert len(lights) == len(vpls) > 100
    assert not lights.flags.owndata
    assert lights["position"].shape == lights["normal"].shape == lights["power"].shape == (len(vpls), 3)
    assert np.all(lights["normal"] == (0, 0, 1))
    assert np.allclose(lights["position"][:, 2], 0, atol=1e-3)
    assert lights["close"].sum() == vpls.close_count
    # The floor reflects half of what the light sends into its solid angle, 4·atan(1/√3) = 2π/3.
    assert lights["power"].sum(axis=0) == pytest.approx(np.pi / 3 * np.array([1, 2, 3]), rel=0.02)


def test_files_keep_every_bit(picture, tmp_path):
    picture.write(tmp_path / "a.exr")
    read = nearlight.read_image(str(tmp_path / "a.exr"))
    assert sorted(read.layers) == sorted(picture.image.layers)
    assert all(np.array_equal(read[layer], picture[layer]) for layer in read.layers)


def test_screen_pictures_are_compared_linear(tmp_path):
    image = nearlight.Image(np.full((2, 3, 3), 0.25, np.float32))
    image.write(tmp_path / "a.png")
    assert nearlight.diff(nearlight.read_linear_image(tmp_path / "a.png"), image).rmse < 0.003
    assert nearlight.read_image(tmp_path / "a.png")["beauty"].max() == pytest.approx(137 / 255)


def test_models_are_exposed_automatically(tmp_path):
    (tmp_path / "model.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert nearlight.load(tmp_path / "model.obj").has_open_exposure
    image = nearlight.Image(np.full((8, 8, 3), 0.05, np.float32))
    stops = nearlight.automatic_exposure(image)
    brighter = nearlight.Image(np.full((8, 8, 3), 0.2, np.float32))
    assert nearlight.automatic_exposure(brighter) == pytest.approx(stops - 2, abs=1e-3)


def test_irradiance_follows_the_inverse_square_law(session, vpls):
    points = np.array([[0, 0, 0], [0.75, 0, 0], [0, 0, 0.5]])
    light = session.irradiance(points, [0, 0, 1], vpls, direct_samples=16, paths=16)
    expected = np.array([1, 0.8 / 1.5625, 4])
    assert light.dtype == np.float32
    assert light == pytest.approx(expected[:, None] * [1, 2, 3], rel=0.02)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("order", ["C", "F"])
def test_irradiance_has_the_shape_of_the_points(session, vpls, dtype, order):
    x, y = np.meshgrid(np.linspace(-0.5, 0.5, 5), np.linspace(-0.5, 0.5, 4))
    points = np.array(np.stack([x, y, 0 * x], axis=-1), dtype=dtype, order=order)
    normals = np.broadcast_to(np.array([0, 0, 1], dtype), points.shape)
    grid = session.irradiance(points, normals, vpls)
    assert grid.shape == (4, 5, 3)
    line = session.irradiance(points.reshape(-1, 3), normals.reshape(-1, 3), vpls)
    assert np.array_equal(grid.reshape(-1, 3), line)
    assert session.irradiance(points[1, 2], [0, 0, 1], vpls).shape == (3,)
    assert session.irradiance(np.zeros((0, 3)), [0, 0, 1], vpls).shape == (0, 3)


@pytest.mark.parametrize(
    "points, normals, setting",
    [
        (np.zeros((4, 2)), [0, 0, 1], "points"),
        (1.0, [0, 0, 1], "points"),
        (np.zeros((4, 3)), np.zeros((3, 3)), "normals"),
        (np.zeros((4, 3)), [0, 1], "normals"),
        (np.zeros((1, 3)), [0, 0, 2], "normals"),
        (np.full((1, 3), np.nan), [0, 0, 1], "points"),
        (np.full((1, 3), 1e300), [0, 0, 1], "points"),
        (np.zeros((1, 3)), [0, 0, np.nan], "normals"),
    ],
)
@pytest.mark.filterwarnings("ignore:overflow")
def test_points_and_normals_of_wrong_shape_are_refused(session, vpls, points, normals, setting):
    with pytest.raises(nearlight.InvalidArgument) as error:
        session.irradiance(points, normals, vpls)
    assert error.value.setting == setting


@pytest.mark.parametrize("points", ["here", [["a", "b", "c"]], np.zeros((1, 3), complex), None])
def test_points_of_wrong_type_are_refused(session, vpls, points):
    with pytest.raises(TypeError):
        session.irradiance(points, [0, 0, 1], vpls)


def test_differences(picture):
    same = nearlight.diff(picture.image, picture.image)
    assert (same.rmse, same.relative_mse, same.mean_ratio, same.flip, same.non_finite) == (0, 0, 1, 0, 0)
    brighter = nearlight.Image(2 * picture["direct"])
    reference = nearlight.Image(picture["direct"])
    difference = nearlight.diff(brighter, reference)
    assert difference.mean_ratio == pytest.approx(2)
    assert difference.rmse == pytest.approx(np.sqrt(np.mean(np.square(picture["direct"], dtype=np.float64))))
    assert nearlight.diff_map(brighter, reference)["beauty"].shape == picture["direct"].shape
    with pytest.raises(nearlight.InvalidArgument, match="48x32 and 2x2"):
        nearlight.diff(picture.image, nearlight.Image(np.zeros((2, 2, 3))))
