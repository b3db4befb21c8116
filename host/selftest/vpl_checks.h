// SPDX-License-Identifier: Apache-2.0
// Stages that make VPLs, light them and tell what they bring to the camera.
#pragma once

#include "host/cl/device.h"
#include "host/selftest/check.h"

namespace nearlight {

/// A case is a lane: VPLs as receivers, powers times irradiance, sums of irradiance.
void check_vpl_light(Device& device, CheckResult& result);
/// A case is a side of a sample: a VPL where it reflects and lies in the close range, albedo times area its
/// power.
void check_patch_vpls(Device& device, CheckResult& result);
/// A case is a VPL in one of both norms: its sum over what the camera sees, by Embree's rays.
void check_vpl_contribution(Device& device, CheckResult& result);
/// A case is a ray, which must land where Embree's does and take the albedo there, or the density around that
/// place.
void check_reverse_vpls(Device& device, CheckResult& result);

}  // namespace nearlight
