// SPDX-License-Identifier: Apache-2.0
// Stages that follow paths from receivers: bounce tracer and local lights.
#pragma once

#include "host/cl/device.h"
#include "host/selftest/check.h"

namespace nearlight {

/// A case is a receiver on the inside of a sphere, where indirect light of each depth, and the part of it
/// that a clamp radius takes away, are known.
void check_bounce_tracer(Device& device, CheckResult& result);
/// A case is a local light, whose power and receivers must be those of Embree's rays, or what a receiver gets
/// from all of its packet's lights.
void check_local_lights(Device& device, CheckResult& result);

}  // namespace nearlight
