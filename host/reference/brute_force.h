// SPDX-License-Identifier: Apache-2.0
// Every triangle against every ray in double precision: the specification that ray casters are tested with.
#pragma once

#include <span>

#include "host/bvh/bvh.h"
#include "host/scene/scene.h"

namespace nearlight::core {

/// Closest hit on either side with t in (t_min, t_max) among the triangles `ids`, or among all triangles
/// where `ids` is empty. Of hits at the same t, the first triangle's counts. A triangle without area is never
/// hit. [Möller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997]
BvhHit brute_force_closest_hit(const Scene& scene, std::span<const uint> ids, Vec3 origin, Vec3 direction,
                               float t_min, float t_max);
/// Whether any triangle of `ids`, or of the scene where `ids` is empty, is hit with t in (t_min, t_max).
bool brute_force_occluded(const Scene& scene, std::span<const uint> ids, Vec3 origin, Vec3 direction,
                          float t_min, float t_max);

}  // namespace nearlight::core
