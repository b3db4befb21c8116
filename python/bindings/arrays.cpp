// SPDX-License-Identifier: Apache-2.0
#include "python/bindings/arrays.h"

namespace nearlight::python {

FloatArray to_floats(const char* name, const py::object& values) {
    const py::array given = py::array::ensure(values);
    if (!given || std::string_view("fiu").find(given.dtype().kind()) == std::string_view::npos) {
        fail_type(name, "an array of real numbers", given ? py::object(given.dtype()) : values);
    }
    return FloatArray(given);
}

}  // namespace nearlight::python
