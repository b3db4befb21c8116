// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "host/base/words.h"
#include "python/bindings/bindings.h"
#include "python/bindings/calls.h"
#include "python/bindings/settings.h"

namespace nearlight::python {
namespace {

const char* kind_name(DeviceKind kind) {
    return kind == DeviceKind::cpu ? "cpu" : kind == DeviceKind::gpu ? "gpu" : "other";
}

std::string text_of(const DeviceInfo& info) {
    return "<nearlight.DeviceInfo " + std::to_string(info.index) + ": " + info.name +
           (info.part.empty() ? "" : ", " + info.part) +
           (info.unusable_because.empty() ? "" : ", unusable: " + info.unusable_because) + ">";
}

std::string text_of(const Devices& devices) {
    const auto name_of = [](const DeviceInfo& info) {
        return info.name + (info.part.empty() ? "" : ", " + info.part);
    };
    return "<nearlight.Devices: " + core::joined(devices.infos(), ", ", name_of) + ">";
}

void add_device_info(py::module_& module) {
    py::class_<DeviceInfo>(module, "DeviceInfo", "Facts about a device, as its driver gives them.")
        .def_readonly("index", &DeviceInfo::index, "its number, for Devices() and Session()")
        .def_readonly("name", &DeviceInfo::name)
        .def_readonly("platform", &DeviceInfo::platform)
        .def_readonly("version", &DeviceInfo::version, "the version of OpenCL")
        .def_readonly("driver", &DeviceInfo::driver, "the version of the driver")
        .def_property_readonly(
            "kind", [](const DeviceInfo& info) { return kind_name(info.kind); }, "'cpu', 'gpu' or 'other'")
        .def_readonly("compute_units", &DeviceInfo::compute_units)
        .def_readonly("memory_bytes", &DeviceInfo::memory_bytes)
        .def_readonly("part", &DeviceInfo::part, "which part of a split device, else ''")
        .def_readonly("unusable_because", &DeviceInfo::unusable_because, "'' if the device can be used")
        .def("__repr__", [](const DeviceInfo& info) { return text_of(info); });
}

}  // namespace

SharedDevices choose_devices(const std::string& choice, const DeviceOptions& options) {
    return {with_messages([&] { return Devices::choose(choice, options); })};
}

SharedDevices devices_of(const py::object& devices) {
    return py::isinstance<SharedDevices>(devices) ? devices.cast<SharedDevices>()
                                                  : choose_devices(to_name("devices", devices), {});
}

void add_devices(py::module_& module) {
    add_device_info(module);
    py::class_<SharedDevices>(
        module, "Devices",

        "One OpenCL device or several that work together, opened and ready.\n\n"
        "choice: 'auto', 'cpu', 'gpu', an index, a part of a name, 'all', 'X/N' for N parts of X,\n"
        "'X/N.K' for one of them, or several of these with commas between them.\n"
        "options: the fields of DeviceOptions.\n\n"
        "Sessions that share devices take turns; for work at the same time in several threads,\n"
        "choose devices for each, or parts of one device ('0/2.0' and '0/2.1').")
        .def(py::init([](const py::object& choice, const py::kwargs& options) {
                 return choose_devices(
                     to_name("choice", choice),
                     settings_of<DeviceOptions>("Devices", "settings", py::none(), options));
             }),
             py::arg("choice") = "auto", "__init__(self, choice='auto', **options)\n--\n\n")
        .def_property_readonly(
            "infos", [](const SharedDevices& self) { return self.devices.infos(); },
            "a DeviceInfo for each, in the order of the choice")
        .def("__len__", [](const SharedDevices& self) { return self.devices.infos().size(); })
        .def("__repr__", [](const SharedDevices& self) { return text_of(self.devices); });
    module.def(
        "list_devices", [] { return with_messages(&nearlight::list_devices); },
        "list_devices()\n--\n\nAll devices of all drivers, unusable ones included.");
}

}  // namespace nearlight::python
