// SPDX-License-Identifier: Apache-2.0
// The module nearlight._core: include/nearlight/ as Python sees it. The package python/nearlight shows it to
// users.
#include "python/bindings/bindings.h"
#include "python/bindings/calls.h"
#include "python/bindings/settings.h"

PYBIND11_MODULE(_core, module) {
    namespace py = pybind11;
    namespace bindings = nearlight::python;
    // The docstrings begin with signatures of their own, which say more than those that pybind11 makes.
    pybind11::options options;
    options.disable_function_signatures();
    // Classes and functions call themselves nearlight.NAME, which is where users find them.
    module.attr("__module__") = "nearlight";
    module.attr("__version__") = NEARLIGHT_VERSION;
    bindings::collect_messages();
    bindings::add_errors(module);
    bindings::add_settings(module);
    bindings::add_images(module);
    bindings::add_devices(module);
    bindings::add_scenes(module);
    bindings::add_sessions(module);
    bindings::add_animations(module);
    py::delattr(module, "__module__");
}
