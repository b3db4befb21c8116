// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <string>

#include "host/cli/exit_code.h"
#include "python/bindings/bindings.h"
#include "python/bindings/convert.h"

namespace nearlight::python {
namespace {

const char* kind_name(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::failure:
            return "failure";
        case ErrorKind::invalid_argument:
            return "invalid_argument";
        case ErrorKind::file:
            return "file";
        case ErrorKind::no_device:
            return "no_device";
        case ErrorKind::kernel_build:
            return "kernel_build";
        case ErrorKind::out_of_memory:
            return "out_of_memory";
    }
    return "failure";
}

void raise(const Error& error) {
    const py::module_ errors = py::module_::import("nearlight._errors");
    const py::object type =
        errors.attr(error.kind() == ErrorKind::invalid_argument ? "InvalidArgument" : "Error");
    const py::object instance =
        type(decoded(error.what()), kind_name(error.kind()), std::string(error.setting()),
             static_cast<int>(core::exit_code(error.kind())));
    PyErr_SetObject(type.ptr(), instance.ptr());
}

}  // namespace

void add_errors(py::module_&) {
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) {
                std::rethrow_exception(thrown);
            }
        } catch (const Error& error) {
            raise(error);
        }
    });
}

}  // namespace nearlight::python
