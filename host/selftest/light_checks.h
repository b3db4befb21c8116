// SPDX-License-Identifier: Apache-2.0
// Stages that need a whole scene: direct light, light tracing, Metropolis chains and camera pass.
#pragma once

#include "host/cl/device.h"
#include "host/selftest/check.h"

namespace nearlight {

/// A case is a receiver under point and spot lights, whose irradiance must be Embree's unless a shadow ray
/// touches an edge.
void check_direct_light(Device& device, CheckResult& result);
/// A case is a colour channel at a depth: in a closed room of albedo ρ walks deposit Φ·ρ^depth.
void check_light_tracing(Device& device, CheckResult& result);
/// A case is a depth: chains that follow power alone must come to have depths in proportion to the power
/// there, whatever the depths of their seeds.
void check_metropolis_chains(Device& device, CheckResult& result);
/// A case is a receiver, or a lane that must be absent.
void check_camera_pass(Device& device, CheckResult& result);

}  // namespace nearlight
