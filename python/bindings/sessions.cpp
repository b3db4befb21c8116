// SPDX-License-Identifier: Apache-2.0
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstddef>

#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/calls.h"
#include "python/bindings/settings.h"

namespace nearlight::python {
namespace {

using PySession = OnDevices<Session>;
using PyView = OnDevices<View>;
using PyVplSet = OnDevices<VplSet>;
using SharedPicture = std::shared_ptr<Picture>;

/// An array of `count` values of the vector, which lives as long as the array.
template <typename T>
py::array array_of(std::vector<T> values, const py::dtype& type, const std::vector<py::ssize_t>& shape) {
    auto* const owned = new std::vector<T>(std::move(values));
    const py::capsule owner(owned, [](void* vector) { delete static_cast<std::vector<T>*>(vector); });
    return {type, shape, owned->data(), owner};
}

py::dtype light_type() {
    using Light = VirtualPointLight;
    py::list names, formats, offsets;
    const auto add = [&](const char* name, const char* format, std::size_t offset) {
        names.append(name);
        formats.append(format);
        offsets.append(offset);
    };
    add("position", "(3,)f4", offsetof(Light, position));
    add("normal", "(3,)f4", offsetof(Light, normal));
    add("power", "(3,)f4", offsetof(Light, power));
    add("depth", "u4", offsetof(Light, depth));
    add("close", "?", offsetof(Light, close));
    return {names, formats, offsets, sizeof(Light)};
}

/// Vectors from an array of numbers whose last axis has three.
std::vector<Vec3> vectors_of(const char* name, const FloatArray& array) {
    if (array.ndim() == 0 || array.shape(array.ndim() - 1) != 3) {
        throw Error(ErrorKind::invalid_argument,
                    std::string(name) + " have the shape " + shown(array.attr("shape")) +
                        "; the last axis must have 3 numbers",
                    name);
    }
    std::vector<Vec3> vectors(static_cast<std::size_t>(array.size() / 3));
    const float* value = array.data();
    for (Vec3& vector : vectors) {
        vector = {value[0], value[1], value[2]};
        value += 3;
    }
    return vectors;
}

std::shared_ptr<PySession> make_session(const py::object& scene, const py::object& devices,
                                        const py::object& options, const py::kwargs& fields) {
    const SessionOptions chosen = settings_of<SessionOptions>("Session", "options", options, fields);
    const Scene loaded = py::isinstance<Scene>(scene)
                             ? scene.cast<Scene>()
                             : py::module_::import("nearlight").attr("load")(scene).cast<Scene>();
    const SharedDevices on = devices_of(devices);
    return std::make_shared<PySession>(
        in_turn(*on.turns, [&] { return Session(on.devices, loaded, chosen); }), on.turns);
}

std::shared_ptr<PyView> look(PySession& self, const py::object& settings, const py::object& seed,
                             const py::kwargs& fields) {
    const ViewSettings chosen = settings_of<ViewSettings>("look", "settings", settings, fields);
    const std::uint32_t number = to_seed(seed);
    return std::make_shared<PyView>(in_turn(*self.turns(), [&] { return self.get().look(chosen, number); }),
                                    self.turns());
}

std::shared_ptr<PyVplSet> sample(PySession& self, const PyView& view, const py::object& settings,
                                 const py::object& seed, const py::kwargs& fields) {
    const SamplingSettings chosen = settings_of<SamplingSettings>("sample", "settings", settings, fields);
    const std::uint32_t number = to_seed(seed);
    return std::make_shared<PyVplSet>(
        in_turn(*self.turns(), [&] { return self.get().sample(view.get(), chosen, number); }), self.turns());
}

void save_vpls(PySession& self, const PyVplSet& vpls, const py::object& file) {
    const std::filesystem::path path = to_path(file);
    in_turn(*self.turns(), [&] { self.get().save_vpls(vpls.get(), path); });
}

SharedPicture gather(PySession& self, const PyView& view, const PyVplSet& vpls, const py::object& settings,
                     const py::object& seed, py::object progress, const py::kwargs& fields) {
    const GatherSettings chosen = settings_of<GatherSettings>("gather", "settings", settings, fields);
    const std::uint32_t number = to_seed(seed);
    ProgressCall call(std::move(progress));
    auto picture = std::make_shared<Picture>(in_turn(*self.turns(), [&] {
        return self.get().gather(view.get(), vpls.get(), chosen, number, std::ref(call));
    }));
    call.rethrow();
    return picture;
}

SharedPicture render(PySession& self, const py::object& settings, py::object progress,
                     const py::kwargs& fields) {
    const RenderSettings chosen = settings_of<RenderSettings>("render", "settings", settings, fields);
    ProgressCall call(std::move(progress));
    auto picture = std::make_shared<Picture>(
        in_turn(*self.turns(), [&] { return self.get().render(chosen, std::ref(call)); }));
    call.rethrow();
    return picture;
}

py::array irradiance(PySession& self, const py::object& points, const py::object& normals,
                     const PyVplSet& vpls, const py::object& settings, const py::object& seed,
                     const py::kwargs& fields) {
    const IrradianceSettings chosen =
        settings_of<IrradianceSettings>("irradiance", "settings", settings, fields);
    const std::uint32_t number = to_seed(seed);
    const FloatArray places = to_floats("points", points);
    const FloatArray directions = to_floats("normals", normals);
    const std::vector<Vec3> at = vectors_of("points", places);
    std::vector<Vec3> towards = vectors_of("normals", directions);
    if (directions.ndim() == 1) {  // one normal for all points
        towards.assign(at.size(), Vec3(towards.front()));
    } else if (!places.attr("shape").equal(directions.attr("shape"))) {
        throw Error(ErrorKind::invalid_argument,
                    "normals of the shape " + shown(directions.attr("shape")) +
                        " do not fit points of the shape " + shown(places.attr("shape")),
                    "normals");
    }
    std::vector<Vec3> light = in_turn(
        *self.turns(), [&] { return self.get().irradiance(at, towards, vpls.get(), chosen, number); });
    return array_of(std::move(light), py::dtype::of<float>(),
                    {places.shape(), places.shape() + places.ndim()});
}

py::array lights(const PyVplSet& self) {
    std::vector<VirtualPointLight> all = in_turn(*self.turns(), [&] { return self.get().lights(); });
    const auto count = std::ssize(all);
    return array_of(std::move(all), light_type(), {count});
}

void add_products(py::module_& module) {
    py::class_<PyView, std::shared_ptr<PyView>>(
        module, "View", "A view of a scene whose settings Session.look() has decided.")
        .def_property_readonly(
            "width", [](const PyView& view) { return view.get().width(); }, "pixels")
        .def_property_readonly(
            "height", [](const PyView& view) { return view.get().height(); }, "pixels")
        .def_property_readonly(
            "range", [](const PyView& view) { return view.get().range(); },
            "the distance from the camera at which the close range ends, m")
        .def_property_readonly(
            "clamp_radius", [](const PyView& view) { return view.get().clamp_radius(); },
            "radius of the bounded geometry term, m; a set of VPLs may have one of its own")
        .def_property_readonly(
            "max_depth", [](const PyView& view) { return view.get().max_depth(); },
            "length of the longest light path; 2 is direct light")
        .def("__repr__", [](const PyView& view) {
            return "<nearlight.View " + std::to_string(view.get().width()) + "x" +
                   std::to_string(view.get().height()) + ">";
        });
    py::class_<PyVplSet, std::shared_ptr<PyVplSet>>(
        module, "VplSet",
        "The virtual point lights (VPLs) that Session.sample() made. They stay on the device.")
        .def("__len__", [](const PyVplSet& vpls) { return vpls.get().size(); })
        .def_property_readonly(
            "close_count", [](const PyVplSet& vpls) { return vpls.get().close_count(); },
            "how many count as those of the close range: patches, and with the policy `complete` deposits "
            "there too")
        .def("lights", &lights,
             "lights(self)\n--\n\n"
             "Fetches the VPLs: an array of records with the fields position (m) and normal (unit vectors), "
             "power\n"
             "(W of red, green and blue), depth (1: lit by an emitter, 2: after one more bounce; 0: by light "
             "of all\n"
             "depths) and close (in the close range), as in lights()['position'], which is an array (n, 3).")
        .def("__repr__", [](const PyVplSet& vpls) {
            return "<nearlight.VplSet of " + std::to_string(vpls.get().size()) + ">";
        });
}

void add_picture(py::module_& module) {
    const auto image = [](const SharedPicture& picture) {
        return std::shared_ptr<Image>(picture, &picture->image);
    };
    py::class_<Picture, SharedPicture>(
        module, "Picture", "A finished picture. picture['indirect'] is a layer as an array; see Image.")
        .def_property_readonly("image", image, "the pixels, as an Image")
        .def_readonly("passes", &Picture::passes, "number of passes that it is the mean of")
        .def_readonly("vpl_count", &Picture::vpl_count, "number of VPLs in all passes together")
        .def_readonly("interrupted", &Picture::interrupted,
                      "whether the callback stopped it; missing rows are 0")
        .def_property_readonly(
            "pass_samples", [](const Picture& picture) { return to_python(picture.pass_samples); },
            "samples per pixel of each pass; empty for the picture of a gather")
        .def_readonly("error", &Picture::error, "the relative error, if the settings asked for one")
        .def(
            "__getitem__",
            [image](const SharedPicture& picture, const py::object& layer) {
                return py::object(py::cast(image(picture))[layer]);
            },
            "__getitem__(self, layer)\n--\n\nA layer as an array on the picture's own memory; see Image.")
        .def(
            "write",
            [image](const SharedPicture& picture, const py::args& arguments, const py::kwargs& fields) {
                py::cast(image(picture)).attr("write")(*arguments, **fields);
            },
            "write(self, file, options=None, **fields)\n--\n\nWrites the picture, as Image.write() does.")
        .def("_repr_png_",
             [image](const SharedPicture& picture) { return py::cast(image(picture)).attr("_repr_png_")(); })
        .def("__repr__", [](const Picture& picture) {
            return "<nearlight.Picture " + std::to_string(picture.image.width) + "x" +
                   std::to_string(picture.image.height) + " by " + std::to_string(picture.vpl_count) +
                   " VPLs>";
        });
}

}  // namespace

void add_sessions(py::module_& module) {
    add_products(module);
    add_picture(module);
    module.def("picture_channels", &picture_channels,
               "picture_channels()\n--\n\nThe names of the channels of every picture, in order.");
    py::class_<PySession, std::shared_ptr<PySession>>(
        module, "Session",

        "A scene on devices, ready for any number of views, sets of VPLs and pictures.\n\n"
        "scene: a Scene, or the path of one.\n"
        "devices: Devices, or a choice as Devices() takes it.\n"
        "options: SessionOptions; fields are theirs.\n\n"
        "Building the tree and compiling kernels takes seconds, so make one session for all pictures of a "
        "scene.\n"
        "Several threads may use it; they take turns.")
        .def(py::init(&make_session), py::arg("scene"), py::arg("devices") = "auto",
             py::arg("options") = py::none(),
             "__init__(self, scene, devices='auto', options=None, **fields)\n--\n\n")
        .def("look", &look, py::arg("settings") = py::none(), py::kw_only(), py::arg("seed") = 0,
             "look(self, settings=None, *, seed=0, **fields)\n--\n\n"
             "Decides what the settings leave open: a View.\n\nsettings: ViewSettings; fields are theirs, as "
             "in look(width=320, height=240). A width\nalone leaves the scene's height.")
        .def("sample", &sample, py::arg("view"), py::arg("settings") = py::none(), py::kw_only(),
             py::arg("seed") = 0,
             "sample(self, view, settings=None, *, seed=0, **fields)\n--\n\n"
             "Places virtual point lights for a view: a VplSet.\n\nsettings: SamplingSettings; fields are "
             "theirs.")
        .def("save_vpls", &save_vpls, py::arg("vpls"), py::arg("file"),
             "save_vpls(self, vpls, file)\n--\n\n"
             "Writes VPLs to a PLY file, from which sample(view, file=...) takes them again.")
        .def("gather", &gather, py::arg("view"), py::arg("vpls"), py::arg("settings") = py::none(),
             py::kw_only(), py::arg("seed") = 0, py::arg("progress") = py::none(),
             "gather(self, view, vpls, settings=None, *, seed=0, progress=None, **fields)\n--\n\n"
             "Renders a view with VPLs, which may have been made for another view of the session: a "
             "Picture.\n\n"
             "settings: GatherSettings; fields are theirs.\n"
             "progress: a function that takes how far the picture is, from 0 to 1; it may return False to "
             "stop.")
        .def("render", &render, py::arg("settings") = py::none(), py::kw_only(),
             py::arg("progress") = py::none(),
             "render(self, settings=None, *, progress=None, **fields)\n--\n\n"
             "Looks, samples and gathers, in one pass or several: a Picture.\n\n"
             "settings: RenderSettings; fields are theirs and those of ViewSettings, SamplingSettings and\n"
             "GatherSettings, as in render(width=320, height=240, vpl_count=500). A width alone leaves the\n"
             "scene's height.\n"
             "progress: a function that takes how far the picture is, from 0 to 1; it may return False to "
             "stop.")
        .def("irradiance", &irradiance, py::arg("points"), py::arg("normals"), py::arg("vpls"),
             py::arg("settings") = py::none(), py::kw_only(), py::arg("seed") = 0,
             "irradiance(self, points, normals, vpls, settings=None, *, seed=0, **fields)\n--\n\n"
             "The irradiance (W/m² of red, green and blue) at points, on the side of their normals.\n\n"
             "points: an array whose last axis has 3 numbers, m.\n"
             "normals: unit vectors, an array of the same shape, or one for all points.\n"
             "settings: IrradianceSettings; fields are theirs.\n\n"
             "Returns an array of the shape of points: direct light, the light of the VPLs, and what the "
             "clamp\n"
             "radius of their view takes away.")
        .def("__repr__", [](const PySession&) { return "<nearlight.Session>"; });
}

}  // namespace nearlight::python
