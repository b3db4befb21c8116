// SPDX-License-Identifier: Apache-2.0
// Indices of refraction that Mitsuba scenes call by name.
#pragma once

#include <optional>
#include <string>

#include "kernels/shared/types.h"

namespace nearlight::core::mitsuba {

struct Metal {
    Vec3 eta, k;  ///< in linear sRGB
};
/// "Au", "Cu", …; "none" is a perfect mirror.
std::optional<Metal> find_metal(const std::string& name);
/// "bk7", "water", "air", …
std::optional<double> find_index_of_refraction(const std::string& name);

}  // namespace nearlight::core::mitsuba
