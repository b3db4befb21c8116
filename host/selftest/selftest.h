// SPDX-License-Identifier: Apache-2.0
// The comparison of every kernel with its oracle on the host, on one device.
#pragma once

#include <functional>
#include <vector>

#include "host/cl/device.h"
#include "host/selftest/check.h"

namespace nearlight::core {

/// Runs all checks in turn, which takes some seconds. A check that cannot run, for example because a kernel
/// does not compile, fails with the reason; the other checks still run. `done` receives each result.
std::vector<CheckResult> run_selftest(Device& device, const std::function<void(const CheckResult&)>& done);

}  // namespace nearlight::core
