// SPDX-License-Identifier: Apache-2.0
// Every triangle against every ray in double precision: the specification that ray casters are tested with.
#pragma once

#include <span>

#include "host/bvh/bvh.h"
#include "host/scene/scene.h"

namespace nearlight::core {

/// Closest hit with t in (t_min, t_max), either side, among the triangles that `ids` names, or all of them
/// where `ids` is empty; of equal ones the first. A triangle without area is never hit.
/// [Möller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997]
BvhHit brute_force_closest_hit(const Scene& scene, std::span<const uint> ids, Vec3 origin, Vec3 direction,
                               float t_min, float t_max);
bool brute_force_occluded(const Scene& scene, std::span<const uint> ids, Vec3 origin, Vec3 direction,
                          float t_min, float t_max);

}  // namespace nearlight::core
