// SPDX-License-Identifier: Apache-2.0
// The kernels' traversal against brute force and Embree.
#pragma once

#include "host/cl/device.h"
#include "host/selftest/check.h"

namespace nearlight {

/// A case is a ray and one of both oracles; ties at edges (ray_comparison.h) count as right.
void check_closest_hit(Device& device, CheckResult& result);
/// A case is a ray: occluded where it has a closest hit.
void check_any_hit(Device& device, CheckResult& result);

}  // namespace nearlight
