// SPDX-License-Identifier: Apache-2.0
// The normal by which a VPL is seen, as kernels/lib/vpl.cl has it.
#pragma once

#include "host/base/packed_direction.h"

namespace nearlight::core {

/// The normal by whose side and angle a VPL is seen: unit length, its shading normal where that is tilted.
inline Vec3 seen_normal(const Vpl& vpl) {
    return (vpl.flags & NEARLIGHT_VPL_TILTED) != 0 ? unpack_direction(vpl.shading) : vpl.normal;
}

}  // namespace nearlight::core
