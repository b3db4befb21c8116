// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "python/bindings/bindings.h"
#include "python/bindings/calls.h"
#include "python/bindings/settings.h"

namespace nearlight::python {
namespace {

using PyAnimation = OnDevices<Animation>;

std::shared_ptr<PyAnimation> make_animation(const py::object& file, const py::object& devices,
                                            const py::object& options, const py::object& load,
                                            const py::object& session, const py::kwargs& fields) {
    const std::filesystem::path path = to_path(file);
    const auto chosen = settings_of<AnimationOptions>("Animation", "options", options, fields);
    const auto loading = settings_of<LoadOptions>("Animation", "load", load, {});
    const auto getting_ready = settings_of<SessionOptions>("Animation", "session", session, {});
    const SharedDevices on = devices_of(devices);
    return std::make_shared<PyAnimation>(
        in_turn(*on.turns, [&] { return Animation(on.devices, path, chosen, loading, getting_ready); }),
        on.turns);
}

std::shared_ptr<Picture> render_frame(PyAnimation& self, const py::object& frame, const py::object& settings,
                                      py::object progress, const py::kwargs& fields) {
    const int number = Convert<int>::from("frame", frame);
    const auto chosen = settings_of<RenderSettings>("render", "settings", settings, fields);
    ProgressCall call(std::move(progress));
    auto picture = std::make_shared<Picture>(
        in_turn(*self.turns(), [&] { return self.get().render(number, chosen, std::ref(call)); }));
    call.rethrow();
    return picture;
}

}  // namespace

void add_animations(py::module_& module) {
    py::class_<PyAnimation, std::shared_ptr<PyAnimation>>(
        module, "Animation",

        "A glTF file whose animations move its camera, its lights or its objects, on devices.\n\n"
        "file: a path.\n"
        "devices: Devices, or a choice as Devices() takes it.\n"
        "options: AnimationOptions; fields are theirs.\n"
        "load, session: LoadOptions and SessionOptions.\n\n"
        "Where only the camera moves, scene and VPLs stay on the devices from one frame to the next, and\n"
        "VPLs hardly flicker. Frames have the bits that `nearlight render --frames` gives them, in\n"
        "whatever order they are made.")
        .def(py::init(&make_animation), py::arg("file"), py::arg("devices") = "auto",
             py::arg("options") = py::none(), py::kw_only(), py::arg("load") = py::none(),
             py::arg("session") = py::none(),
             "__init__(self, file, devices='auto', options=None, *, load=None, session=None, "
             "**fields)\n--\n\n")
        .def_property_readonly(
            "begin", [](const PyAnimation& self) { return self.get().begin(); },
            "the time of the first key, s")
        .def_property_readonly(
            "end", [](const PyAnimation& self) { return self.get().end(); }, "the time of the last key, s")
        .def("render", &render_frame, py::arg("frame"), py::arg("settings") = py::none(), py::kw_only(),
             py::arg("progress") = py::none(),
             "render(self, frame, settings=None, *, progress=None, **fields)\n--\n\n"
             "Renders a frame: a Picture.\n\n"
             "frame: its number, from 0; it shows the time frame / fps.\n"
             "settings: RenderSettings; fields are as those of Session.render().\n"
             "progress: a function that takes how far the picture is, from 0 to 1; it may return False to "
             "stop.")
        .def("__repr__", [](const PyAnimation& self) {
            return "<nearlight.Animation from " + shown(py::float_(self.get().begin())) + " to " +
                   shown(py::float_(self.get().end())) + " s>";
        });
}

}  // namespace nearlight::python
