// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "python/bindings/bindings.h"
#include "python/bindings/calls.h"
#include "python/bindings/settings.h"

namespace nearlight::python {
namespace {

std::string text_of(const Scene& scene) {
    return "<nearlight.Scene '" + scene.name() + "': " + std::to_string(scene.triangle_count()) +
           " triangles, " + std::to_string(scene.width()) + "x" + std::to_string(scene.height()) + " pixels>";
}

std::string text_of(const SceneNote& note) {
    return note.file.string() + (note.line > 0 ? ":" + std::to_string(note.line) : "") + ": " + note.text;
}

py::object path_object(const std::filesystem::path& path) {
    return py::module_::import("pathlib").attr("Path")(to_python(path));
}

Scene load(const py::object& file, const py::object& options, const py::kwargs& fields) {
    const std::filesystem::path path = to_path(file);
    const LoadOptions chosen = settings_of<LoadOptions>("load", "options", options, fields);
    return without_gil([&] { return Scene::load(path, chosen); });
}

}  // namespace

void add_scenes(py::module_& module) {
    py::class_<SceneNote>(module, "SceneNote",
                          "What was approximated when a scene was loaded, or is odd about its file.")
        .def_property_readonly("file", [](const SceneNote& note) { return path_object(note.file); })
        .def_readonly("line", &SceneNote::line, "counted from 1; 0 if the line is not known")
        .def_property_readonly("text", [](const SceneNote& note) { return decoded(note.text); })
        .def("__str__", [](const SceneNote& note) { return decoded(text_of(note)); })
        .def("__repr__",
             [](const SceneNote& note) { return decoded("<nearlight.SceneNote " + text_of(note) + ">"); });

    py::class_<Scene>(module, "Scene", "A scene, which does not change. load() reads one.")
        .def_property_readonly(
            "name", [](const Scene& scene) { return decoded(scene.name()); },
            "the name of the scene's folder, or of its file")
        .def_property_readonly(
            "source", [](const Scene& scene) { return path_object(scene.source()); },
            "the file that load() was given")
        .def_property_readonly("triangle_count", &Scene::triangle_count)
        .def_property_readonly(
            "bounds",
            [](const Scene& scene) {
                const Box box = scene.bounds();
                return py::make_tuple(to_python(box.min), to_python(box.max));
            },
            "the corners (min, max) of the box around all triangles, m")
        .def_property_readonly("width", &Scene::width, "pixels of the camera's picture")
        .def_property_readonly("height", &Scene::height, "pixels of the camera's picture")
        .def_property_readonly("camera", &Scene::camera,
                               "where the camera stands, as a CameraPose of one's own")
        .def_property_readonly("has_open_exposure", &Scene::has_open_exposure,
                               "whether the file leaves open how bright its pictures are to be, as models do")
        .def_property_readonly("notes", &Scene::notes, "a list of SceneNote")
        .def("hash", &Scene::hash, py::call_guard<py::gil_scoped_release>(),
             "hash(self)\n--\n\nA number that equal scenes share, on any machine.")
        .def("__repr__", [](const Scene& scene) { return decoded(text_of(scene)); });

    module.def("load", &load, py::arg("file"), py::arg("options") = py::none(),
               "load(file, options=None, **fields)\n--\n\n"
               "Reads a scene by its extension: .xml (Mitsuba 0.5 to 3), .gltf, .glb, .obj or .ply.\n\n"
               "file: a path.\n"
               "options: LoadOptions; fields are theirs, as in load(file, strict=True).\n\n"
               "What is approximated is logged as a warning and listed in Scene.notes. Raises Error.");
}

}  // namespace nearlight::python
