// SPDX-License-Identifier: Apache-2.0
// Close-range placement: classification against a quadratic programme, placement against its promise.
#pragma once

#include "host/cl/device.h"
#include "host/selftest/check.h"

namespace nearlight {

/// A case is a triangle, which must be selected if it reaches into the close range for sure, and must not if
/// it surely does not.
void check_classifier(Device& device, CheckResult& result);
/// A case is a sample k of K: on a triangle of the k-th part of the area, and on the triangle.
void check_placement(Device& device, CheckResult& result);

}  // namespace nearlight
