// SPDX-License-Identifier: Apache-2.0
// 30-bit Morton codes: ten bits for each axis, interleaved, with x highest.
#ifndef NEARLIGHT_LIB_MORTON
#define NEARLIGHT_LIB_MORTON

#include "shared/morton.h"

/// The low ten bits of x, with two zero bits before each.
static inline uint spread_bits(uint x) {
    x = (x | (x << 16)) & 0x030000ffu;
    x = (x | (x << 8)) & 0x0300f00fu;
    x = (x | (x << 4)) & 0x030c30c3u;
    return (x | (x << 2)) & 0x09249249u;
}

/// The Morton code of a cell. Coordinates outside [0, NEARLIGHT_MORTON_CELLS) count as the cell at that end,
/// and NaN counts as 0.
static inline uint morton_code(float3 cell) {
    const float last = NEARLIGHT_MORTON_CELLS - 1.0f;
    const uint x = (uint)fmin(fmax(cell.x, 0.0f), last);
    const uint y = (uint)fmin(fmax(cell.y, 0.0f), last);
    const uint z = (uint)fmin(fmax(cell.z, 0.0f), last);
    return spread_bits(x) << 2 | spread_bits(y) << 1 | spread_bits(z);
}

#endif
