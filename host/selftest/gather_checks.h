// SPDX-License-Identifier: Apache-2.0
// The gather against Embree, pair by pair and sum by sum.
#pragma once

#include "host/cl/device.h"
#include "host/selftest/check.h"
#include "host/stages/gatherer.h"

namespace nearlight {

/// A case is a shadow ray, whose visibility must be Embree's unless it touches an edge, or the irradiance of
/// a receiver all of whose rays agree.
void check_gather(Device& device, GatherKernel kernel, CheckResult& result);

}  // namespace nearlight
