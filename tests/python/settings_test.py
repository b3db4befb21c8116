# SPDX-License-Identifier: Apache-2.0
"""Settings have the names and defaults of include/nearlight/, and the type stubs have them too."""

import ast
import copy
import inspect
import re

import pytest

import nearlight

STRUCTS = {
    "settings.h": [
        "CameraPose",
        "ViewSettings",
        "SamplingSettings",
        "PixelWindow",
        "GatherSettings",
        "RenderSettings",
        "SessionOptions",
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
    text = "".join(without_comments((source / "include/nearlight" / header).read_text()) for header in STRUCTS)
    body = re.search(rf"enum class {name} {{(.*?)}}", text, re.S).group(1)
    assert list(getattr(nearlight, name).__members__) == re.findall(r"\w+", body)


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


def test_settings_are_changed_by_keywords_of_a_call(session):
    settings = nearlight.ViewSettings(width=32, height=16)
    view = session.look(settings, height=8)
    assert (view.width, view.height) == (32, 8)
    assert settings.height == 16


def stub_classes(source):
    tree = ast.parse((source / "python/nearlight/__init__.pyi").read_text())
    return tree, {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}


def keywords_of(function):
    """The names and defaults of the keyword arguments of a function in the stubs."""
    return {
        argument.arg: None if isinstance(default, ast.Constant) and default.value is ... else ast.literal_eval(default)
        for argument, default in zip(function.args.kwonlyargs, function.args.kw_defaults)
    }


def constructor_defaults(name):
    return {
        parameter.name: parameter.default
        for parameter in inspect.signature(getattr(nearlight, name)).parameters.values()
        if parameter.kind == parameter.KEYWORD_ONLY
    }


def method(node, name):
    return next(item for item in node.body if isinstance(item, ast.FunctionDef) and item.name == name)


def test_stubs_name_everything(source):
    tree, classes = stub_classes(source)
    functions = [node.name for node in tree.body if isinstance(node, ast.FunctionDef)]
    imported = [alias.asname for node in tree.body if isinstance(node, ast.ImportFrom) for alias in node.names]
    known = {*classes, *functions, *imported, "__version__"}
    assert set(nearlight.__all__) == {name for name in known if name and (name[0] != "_" or name == "__version__")}
    for name, node in classes.items():
        cls = getattr(nearlight, name)
        stubbed = {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
        stubbed |= {item.target.id for item in node.body if isinstance(item, ast.AnnAssign)}
        assert all(hasattr(cls, attribute) for attribute in stubbed), name
        public = {attribute for attribute in vars(cls) if attribute[0] != "_"}
        if not issubclass(cls, tuple) and name not in ENUMERATIONS:
            assert public <= stubbed, name


@pytest.mark.parametrize("struct", [name for names in STRUCTS.values() for name in names])
def test_stubs_have_the_defaults_of_settings(source, struct):
    _, classes = stub_classes(source)
    expected = constructor_defaults(struct)
    if struct == "RenderSettings":
        for member in MEMBERS.values():
            expected |= constructor_defaults(member.__name__)
    assert keywords_of(method(classes[struct], "__init__")) == expected


@pytest.mark.parametrize(
    "name, structs, more",
    [
        ("__init__", ["SessionOptions"], set()),
        ("look", ["ViewSettings"], {"seed"}),
        ("sample", ["SamplingSettings"], {"seed"}),
        ("gather", ["GatherSettings"], {"seed", "progress"}),
        ("render", ["RenderSettings", "ViewSettings", "SamplingSettings", "GatherSettings"], {"progress"}),
        ("irradiance", ["IrradianceSettings"], {"seed"}),
    ],
)
def test_stubs_have_the_keywords_of_methods(source, name, structs, more):
    _, classes = stub_classes(source)
    expected = {}
    for struct in structs:
        expected |= constructor_defaults(struct)
    stub = keywords_of(method(classes["Session"], name))
    assert {key: value for key, value in stub.items() if key not in more} == expected
    assert more <= set(stub)


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
