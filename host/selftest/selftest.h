// SPDX-License-Identifier: Apache-2.0
// Every kernel against its oracle on the host, on one device.
#pragma once

#include <functional>
#include <vector>

#include "host/cl/device.h"
#include "host/selftest/check.h"

namespace nearlight::core {

/// Runs all checks in turn, some seconds in all. A check that cannot run (a kernel that the driver does not
/// compile, say) fails with the reason; the others go on. `done` is told of each.
std::vector<CheckResult> run_selftest(Device& device, const std::function<void(const CheckResult&)>& done);

}  // namespace nearlight::core
