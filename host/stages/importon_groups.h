// SPDX-License-Identifier: Apache-2.0
// Parts of the picture: groups of importons that are close together and face in similar directions.
#pragma once

#include <cstddef>
#include <vector>

#include "kernels/shared/types.h"

namespace nearlight::core {

/// Splits importons into `wanted` groups of nearly equal size, or into fewer if there are fewer importons; no
/// group is empty. It repeatedly halves a group at the median of the coordinate, of position or normal, that
/// spreads most.
std::vector<std::vector<Importon>> group_importons(std::vector<Importon> importons, std::size_t wanted);

}  // namespace nearlight::core
