// SPDX-License-Identifier: Apache-2.0
// The parts of the module, each of which adds its classes and functions.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "nearlight/nearlight.h"
#include "python/bindings/device_turns.h"

namespace nearlight::python {

namespace py = pybind11;

/// Devices, and the turns that threads take on them.
struct SharedDevices {
    Devices devices;
    std::shared_ptr<DeviceTurns> turns = std::make_shared<DeviceTurns>();
};

/// Opens what `choice` names; the caller holds the GIL, because drivers read the environment meanwhile, which
/// Python's os.environ changes.
SharedDevices choose_devices(const std::string& choice, const DeviceOptions& options);
/// The same for an argument `devices`: Devices, or a choice.
SharedDevices devices_of(const py::object& devices);

void add_errors(py::module_& module);
void add_devices(py::module_& module);
void add_scenes(py::module_& module);
void add_images(py::module_& module);
void add_sessions(py::module_& module);
void add_animations(py::module_& module);

}  // namespace nearlight::python
