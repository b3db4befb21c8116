# SPDX-License-Identifier: Apache-2.0
"""What cannot be done is a Python exception with the library's text; messages go to the logger."""

import copy
import logging
import math
import os
import pickle

import pytest

import nearlight

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


def test_files_that_are_missing():
    with pytest.raises(nearlight.Error, match="nosuch.xml") as error:
        nearlight.load("nosuch.xml")
    assert (error.value.kind, error.value.exit_code, error.value.setting) == ("file", 3, "")
    with pytest.raises(nearlight.Error, match="nosuch.exr"):
        nearlight.read_image("nosuch.exr")


def test_devices_that_are_missing(floor):
    with pytest.raises(nearlight.Error, match="nosuch-device") as error:
        nearlight.Session(floor, "nosuch-device")
    assert (error.value.kind, error.value.exit_code) == ("no_device", 4)


def test_devices_have_names_and_numbers():
    by_number = nearlight.Devices(nearlight.list_devices()[0].index)
    assert by_number.infos[0].name == nearlight.list_devices()[0].name
    with pytest.raises(TypeError, match="choice must be a name or a number, not None"):
        nearlight.Devices(None)


def test_the_argument_of_the_wrong_type_is_named(floor):
    with pytest.raises(TypeError, match="options must be a LoadOptions"):
        nearlight.load("nosuch.xml", options=3)
    with pytest.raises(TypeError, match="load must be a LoadOptions"):
        nearlight.Animation("nosuch.glb", load=3)
    with pytest.raises(TypeError, match="devices must be a name or a number, not None"):
        nearlight.Session(floor, None)


@pytest.mark.parametrize("width", [0, -1, 2**40, 65537])
def test_settings_out_of_range(session, width):
    with pytest.raises(ValueError, match=f"width is {width}") as error:
        session.look(width=width)
    assert isinstance(error.value, nearlight.Error)
    assert (error.value.kind, error.value.setting, error.value.exit_code) == ("invalid_argument", "width", 2)


@pytest.mark.parametrize("value", ["64", 64.0, True, None, [64]])
def test_settings_of_wrong_type(session, value):
    with pytest.raises(TypeError, match="vpl_count must be a whole number"):
        session.render(vpl_count=value)


def test_settings_that_do_not_exist(session):
    with pytest.raises(TypeError, match="did you mean 'width'"):
        session.look(widht=64)
    with pytest.raises(TypeError, match="it takes: exposure"):
        nearlight.WriteOptions(zebra=1)
    with pytest.raises(ValueError, match="choose one of: close_range, instant_radiosity"):
        session.sample(session.look(), sampler="nosuch")
    with pytest.raises(TypeError, match="must be a ViewSettings"):
        session.look(nearlight.GatherSettings())


@pytest.mark.parametrize(
    "camera, reason",
    [
        ({"origin": (math.nan, 0, 0)}, "origin"),
        ({"origin": (0, 0, 1), "target": (0, math.inf, 0)}, "target"),
        ({"origin": (0, 0, 1), "target": (0, 0, 1)}, "target is its origin"),
        ({"origin": (0, 0, 1), "up": (0, 0, 1)}, "`up`"),
        ({"origin": (0, 0, 1), "up": (0, 1, 0), "fov_x_degrees": math.nan}, "field of view"),
    ],
)
def test_cameras_that_cannot_stand(session, camera, reason):
    with pytest.raises(nearlight.InvalidArgument, match=reason) as error:
        session.look(camera=nearlight.CameraPose(**camera))
    assert error.value.setting == "camera"


@pytest.mark.parametrize("origin", [(0, 0), "abc", 3, (0, "x", 0)])
def test_vectors_of_wrong_type(origin):
    with pytest.raises(TypeError, match="origin must be"):
        nearlight.CameraPose(origin=origin)


def test_layers_and_files_that_cannot_be(picture, tmp_path):
    with pytest.raises(ValueError, match="there are: beauty, direct, indirect"):
        picture["nosuch"]
    with pytest.raises(ValueError, match="jpg"):
        picture.write(tmp_path / "a.jpg")
    with pytest.raises(nearlight.Error, match="there is no folder '.*nosuch'; create it first") as error:
        picture.write(tmp_path / "nosuch" / "a.exr")
    assert error.value.kind == "file"
    with pytest.raises(ValueError, match="null"):
        picture.write("a\0.exr")


def test_open_and_closed_files_are_no_paths(picture, tmp_path):
    with open(tmp_path / "a.exr", "wb") as stream:
        with pytest.raises(TypeError, match="expected str, bytes or os.PathLike"):
            picture.write(stream)
    with pytest.raises(TypeError, match="expected str, bytes or os.PathLike"):
        picture.write(stream)
    with pytest.raises(TypeError, match="expected str, bytes or os.PathLike"):
        nearlight.load(stream)


def test_products_of_another_session_are_refused(session, floor):
    other = nearlight.Session(floor)
    with pytest.raises(nearlight.InvalidArgument, match="another session"):
        session.sample(other.look())


def test_errors_survive_pickling_and_copies():
    error = nearlight.InvalidArgument("text", "invalid_argument", "width", 2)
    for other in (pickle.loads(pickle.dumps(error)), copy.copy(error)):
        assert isinstance(other, nearlight.InvalidArgument)
        assert (str(other), other.kind, other.setting, other.exit_code) == ("text", "invalid_argument", "width", 2)


def test_warnings_go_to_the_logger(tmp_path, caplog):
    plain = tmp_path / "plain.obj"
    plain.write_text(TRIANGLE)
    with caplog.at_level(logging.WARNING, "nearlight"):
        scene = nearlight.load(plain)
    assert any("no light" in record.message for record in caplog.records)
    assert any("no light" in note.text and note.file == plain for note in scene.notes)


def test_warnings_come_before_the_error_that_ends_loading(tmp_path, caplog):
    file = tmp_path / "half.xml"
    file.write_text(
        '<scene version="3.0.0">'
        '<shape type="rectangle"><bsdf type="roughconductor"><float name="alpha" value="0"/></bsdf></shape>'
        '<shape type="obj"><string name="filename" value="nosuch.obj"/></shape></scene>'
    )
    with caplog.at_level(logging.WARNING, "nearlight"):
        with pytest.raises(nearlight.Error, match="nosuch.obj"):
            nearlight.load(file)
    assert any("roughness of 0" in record.message for record in caplog.records)


def test_names_of_files_that_are_not_utf8(floor, tmp_path, caplog):
    folder = tmp_path / os.fsdecode(b"caf\xe9")
    folder.mkdir()
    scene_file = folder / "scene.xml"
    scene_file.write_bytes(floor.read_bytes())
    scene = nearlight.load(scene_file)
    assert scene.source == scene_file
    assert scene.name == "caf\ufffd" and "caf\ufffd" in repr(scene)
    with pytest.raises(nearlight.Error, match="caf\ufffd"):
        nearlight.load(folder / "nosuch.xml")
    (folder / "plain.obj").write_text(TRIANGLE)
    with caplog.at_level(logging.WARNING, "nearlight"):
        note = nearlight.load(folder / "plain.obj").notes[0]
    assert note.file == folder / "plain.obj"
    assert "caf\ufffd" in str(note) and "caf\ufffd" in repr(note)
    assert any("caf\ufffd" in record.message for record in caplog.records)
    options = nearlight.LoadOptions(environment=str(folder / "nosuch.exr"))
    assert options.environment == str(folder / "nosuch.exr")
    with pytest.raises(nearlight.Error, match="caf\ufffd"):
        nearlight.load(scene_file, options)
    cache = nearlight.DeviceOptions(cache_dir=bytes(folder))
    assert cache.cache_dir == str(folder)
    assert "caf" in repr(cache) and "caf" in repr(options)


def test_debug_messages_are_logged_where_they_are_asked_for(session, caplog):
    with caplog.at_level(logging.DEBUG, "nearlight"):
        session.look()
    assert any("clamp radius" in record.message for record in caplog.records)
