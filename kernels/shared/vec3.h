// SPDX-License-Identifier: Apache-2.0
// The types that all shared structs are made of.
#ifndef NEARLIGHT_SHARED_VEC3_H
#define NEARLIGHT_SHARED_VEC3_H

#ifdef __cplusplus
#include <cstdint>
namespace nearlight::core {
using uint = std::uint32_t;
#define NEARLIGHT_SHARED_FUNCTION constexpr
#else
#define NEARLIGHT_SHARED_FUNCTION static inline
#endif

/// Three packed floats: a point or a vector in world space, in metres, or a linear sRGB colour.
typedef struct Vec3 {
    float x, y, z;
} Vec3;

#ifdef __cplusplus
}  // namespace nearlight::core
#endif

#endif
