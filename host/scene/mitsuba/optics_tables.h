// SPDX-License-Identifier: Apache-2.0
// Indices of refraction that Mitsuba scenes call by name.
#pragma once

#include <optional>
#include <string>

#include "kernels/shared/types.h"

namespace nearlight::core::mitsuba {

struct Metal {
    Vec3 eta, k;  ///< complex index eta + i·k in linear sRGB
};
/// The metal called "Au", "Cu", …; "none" is a perfect mirror. Empty if the name is unknown.
std::optional<Metal> find_metal(const std::string& name);
/// The index of refraction of "bk7", "water", "air", …; empty if the name is unknown.
std::optional<double> find_index_of_refraction(const std::string& name);

}  // namespace nearlight::core::mitsuba
