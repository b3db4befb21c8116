// SPDX-License-Identifier: Apache-2.0
// Parts of the picture: importons that are near one another and face alike.
#pragma once

#include <cstddef>
#include <vector>

#include "kernels/shared/types.h"

namespace nearlight::core {

/// Splits them into `wanted` groups of nearly equal size (fewer if there are fewer importons; none is empty),
/// again and again at the median of what spreads most, position or normal.
std::vector<std::vector<Importon>> group_importons(std::vector<Importon> importons, std::size_t wanted);

}  // namespace nearlight::core
