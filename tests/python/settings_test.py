# SPDX-License-Identifier: Apache-2.0
"""Settings have the names and defaults of include/nearlight/, and the type stubs have what the module has."""

import ast
import copy
import enum
import inspect
import pickle
import re
import types

import numpy as np
import pytest

import nearlight
from nearlight import _core

STRUCTS = {
    "settings.h": [
        "CameraPose",
        "ViewSettings",
        "SamplingSettings",
        "PixelWindow",
        "GatherSettings",
        "RenderSettings",
        "SessionOptions",
        "AnimationOptions",
        "IrradianceSettings",
    ],
    "scene.h": ["SunPosition", "LoadOptions"],
    "image.h": ["WriteOptions"],
    "device.h": ["DeviceOptions"],
}
ENUMERATIONS = ["SamplerKind", "Policy", "GatherKernel", "BvhQuality", "ToneCurve"]
MEMBERS = {"view": nearlight.ViewSettings, "sampling": nearlight.SamplingSettings, "gather": nearlight.GatherSettings}


def without_comments(text):
    return re.sub(r"//[^\n]*", "", text)


def default_of(kind, value):
    """The value in Python of a default in C++."""
    if kind.startswith("std::optional"):
        return None
    if kind.startswith("std::vector"):
        return []
    if kind.startswith("std::map"):
        return {}
    if kind == "std::filesystem::path":
        return ""
    if kind == "std::string":
        return ""
    if kind == "Vec3":
        return (0.0, 0.0, 0.0)
    if "::" in value:
        return value.split("::")[1]
    return {"true": True, "false": False, "": None}.get(value) if not re.match(r"[\d.]", value) else float(
        value.rstrip("f")
    )


def fields_in_header(source, header, struct):
    """The names and defaults of a struct's fields, in order; the defaults of structs are None."""
    text = without_comments((source / "include/nearlight" / header).read_text())
    body = re.search(rf"struct {struct} {{(.*?)\n}};", text, re.S).group(1)
    body = re.sub(r"\[\[nodiscard\]\].*?\n    }", "", body, flags=re.S)
    pattern = r"^\s*([\w:]+(?:<.*>)?)\s+(\w+)\s*(?:=\s*([^;{]+)|{})\s*;"
    return {
        name: default_of(kind, (value or "").strip()) for kind, name, value in re.findall(pattern, body, re.M)
    }


def fields_of(settings):
    return [name for name in vars(type(settings)) if isinstance(vars(type(settings))[name], property)]


def plain(value):
    return value.name if type(value).__name__ in ENUMERATIONS else value


@pytest.mark.parametrize("header, struct", [(header, name) for header in STRUCTS for name in STRUCTS[header]])
def test_names_and_defaults_are_those_of_the_header(source, header, struct):
    settings = getattr(nearlight, struct)()
    expected = fields_in_header(source, header, struct)
    assert fields_of(settings) == list(expected)
    for name, default in expected.items():
        if struct == "RenderSettings" and name in MEMBERS:
            assert getattr(settings, name) == MEMBERS[name]()
        else:
            assert plain(getattr(settings, name)) == default, name


@pytest.mark.parametrize("name", ENUMERATIONS)
def test_enumerations_are_those_of_the_header(source, name):
    headers = sorted((source / "include/nearlight").glob("*.h"))
    text = "".join(without_comments(header.read_text()) for header in headers)
    body = re.search(rf"enum class {name} {{(.*?)}}", text, re.S).group(1)
    kind = getattr(nearlight, name)
    assert [member.name for member in kind] == re.findall(r"\w+", body)
    for member in kind:
        assert kind(member.name) is kind[member.name] is pickle.loads(pickle.dumps(member)) is member
        assert f"{member.name}: " in kind.__doc__


def test_fields_can_be_set():
    settings = nearlight.RenderSettings(width=64, sampler="local", samples_per_pixel=4, pass_samples=(4, 2))
    assert settings.view.width == 64
    assert settings.sampling.sampler == nearlight.SamplerKind.local
    assert settings.gather == nearlight.GatherSettings(samples_per_pixel=4)
    assert settings.pass_samples == [4, 2]
    settings.view.width = None
    settings.sampling = nearlight.SamplingSettings(vpl_count=7)
    assert settings.view == nearlight.ViewSettings()
    assert settings.sampling.vpl_count == 7
    with pytest.raises(TypeError):
        settings.sampling = nearlight.ViewSettings()
    with pytest.raises(AttributeError):
        settings.nosuch = 1


def test_whole_members_are_set_before_their_fields():
    view = nearlight.ViewSettings(width=8, height=9)
    for settings in (nearlight.RenderSettings(height=5, view=view), nearlight.RenderSettings(view=view, height=5)):
        assert (settings.view.width, settings.view.height) == (8, 5)


def test_texts_are_python():
    names = {name: getattr(nearlight, name) for name in nearlight.__all__}
    camera = nearlight.CameraPose(origin=(1, 2, 3))
    settings = nearlight.RenderSettings(camera=camera, sampler="metropolis", clamp_radius=0.5)
    assert eval(repr(settings), names) == settings
    assert settings != nearlight.RenderSettings()
    other = copy.deepcopy(settings)
    other.view.width = 3
    assert settings.view.width is None


def test_definitions_are_names_with_texts_or_numbers():
    options = nearlight.LoadOptions(definitions=types.MappingProxyType({"a": "x", "b": 2, "c": 0.5, "d": np.int32(3)}))
    assert options.definitions == {"a": "x", "b": "2", "c": "0.5", "d": "3"}
    for definitions in ([("a", "x")], {1: "x"}, {"a": None}, {"a": True}, "a=x"):
        with pytest.raises(TypeError, match="definitions must be a mapping of names to str or numbers"):
            nearlight.LoadOptions(definitions=definitions)


def test_cameras_are_names_or_numbers(corner):
    for camera in (2, "2", np.int32(2)):
        assert nearlight.LoadOptions(camera=camera).camera == "2"
    options = nearlight.LoadOptions()
    options.camera = 1
    assert nearlight.load(corner, options).camera == nearlight.load(corner, camera=1).camera
    with pytest.raises(nearlight.InvalidArgument, match="2"):
        nearlight.load(corner, camera=2)
    for camera in (True, None, 1.0, b"eye"):
        with pytest.raises(TypeError, match="camera must be a name or a number"):
            nearlight.LoadOptions(camera=camera)
    with pytest.raises(TypeError, match="environment must be a str"):
        nearlight.LoadOptions(environment=2)


def test_settings_are_changed_by_keywords_of_a_call(session):
    settings = nearlight.ViewSettings(width=32, height=16)
    view = session.look(settings, height=8)
    assert (view.width, view.height) == (32, 8)
    assert settings.height == 16


@pytest.fixture(scope="module")
def stubs(source):
    """The classes and functions in the type stubs, by name."""
    tree = ast.parse((source / "python/nearlight/_core.pyi").read_text())
    return {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}


def names_in(node):
    """What a class in the stubs has: methods and annotated names, in order."""
    members = [item for item in node.body if isinstance(item, (ast.FunctionDef, ast.AnnAssign))]
    return [item.name if isinstance(item, ast.FunctionDef) else item.target.id for item in members]


def keywords_in(function):
    """The dictionary of keywords that a function in the stubs takes, as "_ViewSettings"."""
    return function.args.kwarg and ast.unparse(function.args.kwarg.annotation)[len("Unpack[") : -1]


def test_stubs_name_the_classes_and_functions_of_the_module_and_no_others(stubs):
    module = {name for name, value in vars(_core).items() if callable(value)}
    assert {name for name in stubs if name[0] != "_"} == module
    python = {"Comparison", "ComparisonRow", "compare", "Error", "InvalidArgument", "__version__"}
    assert set(nearlight.__all__) == module | python
    for name in module:
        assert inspect.isclass(getattr(_core, name)) == isinstance(stubs[name], ast.ClassDef), name


# What every class of pybind11 has, or gets from `object` in the stubs.
COMMON = {"__init__", "__repr__", "__str__", "__eq__", "__hash__", "__copy__", "__deepcopy__", "__doc__", "__module__"}


@pytest.mark.parametrize("name", [name for name, value in vars(_core).items() if inspect.isclass(value)])
def test_stubs_name_the_members_of_classes_and_no_others(stubs, name):
    kind = getattr(_core, name)
    if issubclass(kind, enum.Enum):
        members = {item.targets[0].id: ast.literal_eval(item.value) for item in stubs[name].body}
        assert members == {member.name: member.value for member in kind}
    else:
        members = {member for member in vars(kind) if not member.startswith("_pybind11")}
        assert set(names_in(stubs[name])) - COMMON == members - COMMON


@pytest.mark.parametrize(
    "name",
    [
        "load",
        "read_image",
        "read_linear_image",
        "automatic_exposure",
        "diff",
        "diff_map",
        "list_devices",
        "picture_channels",
    ],
)
def test_stubs_have_the_arguments_of_functions(stubs, name):
    arguments = stubs[name].args
    named = [argument.arg for argument in arguments.args] + ([arguments.kwarg.arg] if arguments.kwarg else [])
    assert named == list(inspect.signature(getattr(nearlight, name)).parameters)


@pytest.mark.parametrize("struct", [name for names in STRUCTS.values() for name in names])
def test_stubs_have_the_fields_of_settings(stubs, struct):
    fields = fields_of(getattr(nearlight, struct)())
    if "_" + struct not in stubs:  # the constructor follows from the fields
        assert names_in(stubs[struct]) == fields
        assert [ast.unparse(base) for base in stubs[struct].bases] == ["_Settings"]
        assert all(field.value is not None for field in stubs[struct].body)
        return
    assert names_in(stubs["_" + struct]) == fields
    assert names_in(stubs[struct]) == ["__init__", *fields]
    assert keywords_in(stubs[struct].body[0]) == "_" + struct
    if struct == "RenderSettings":
        bases = [ast.unparse(base) for base in stubs["_RenderSettings"].bases]
        assert bases == [f"_{member.__name__}" for member in MEMBERS.values()]


@pytest.mark.parametrize(
    "owner, name, keywords",
    [
        ("Session", "__init__", "_SessionOptions"),
        ("Session", "look", "_ViewSettings"),
        ("Session", "sample", "_SamplingSettings"),
        ("Session", "gather", "_GatherSettings"),
        ("Session", "render", "_RenderSettings"),
        ("Session", "irradiance", "_IrradianceSettings"),
        ("Animation", "__init__", "_AnimationOptions"),
        ("Animation", "render", "_RenderSettings"),
        ("Devices", "__init__", "_DeviceOptions"),
        ("Image", "write", "_WriteOptions"),
        ("Picture", "write", "_WriteOptions"),
    ],
)
def test_stubs_have_the_keywords_of_methods(stubs, owner, name, keywords):
    method = next(item for item in stubs[owner].body if getattr(item, "name", "") == name)
    assert keywords_in(method) == keywords
    runtime = list(inspect.signature(getattr(getattr(nearlight, owner), name)).parameters)
    arguments = method.args
    named = [argument.arg for argument in (*arguments.args, *arguments.kwonlyargs)] + [arguments.kwarg.arg]
    assert named == runtime


@pytest.mark.parametrize("name", nearlight.__all__)
def test_everything_is_documented(name):
    thing = getattr(nearlight, name)
    assert name == "__version__" or len(thing.__doc__) > 20
    if inspect.isclass(thing) and not issubclass(thing, Exception) and name not in ENUMERATIONS:
        for attribute, value in vars(thing).items():
            if attribute[0] != "_" and callable(value):
                assert value.__doc__, f"{name}.{attribute}"


def test_help_has_signatures():
    assert str(inspect.signature(nearlight.load)) == "(file, options=None, **fields)"
    assert str(inspect.signature(nearlight.Session)) == "(scene, devices='auto', options=None, **fields)"
    assert list(inspect.signature(nearlight.Session.look).parameters) == ["self", "settings", "seed", "fields"]
