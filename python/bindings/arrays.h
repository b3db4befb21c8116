// SPDX-License-Identifier: Apache-2.0
// Arrays of numbers from Python objects.
#pragma once

#include <pybind11/numpy.h>

#include "python/bindings/convert.h"

namespace nearlight::python {

using FloatArray = py::array_t<float, py::array::c_style | py::array::forcecast>;

/// Takes what NumPy makes an array of real numbers of, in any order and of any type.
FloatArray to_floats(const char* name, const py::object& values);

}  // namespace nearlight::python
