// SPDX-License-Identifier: Apache-2.0
// Skips or fails tests that run the program on a device if there is none.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "host/cl/devices/device_list.h"
#include "tests/support/requirement.h"

namespace nearlight::core::test {

inline bool has_device() {
    const DeviceList list = list_devices();
    return std::any_of(list.devices.begin(), list.devices.end(),
                       [](const DeviceEntry& entry) { return entry.unusable_because.empty(); });
}

}  // namespace nearlight::core::test

/// Ends the test if no device is usable: it fails if one is required, and is skipped otherwise.
#define NEARLIGHT_NEEDS_DEVICE()                                             \
    if (!nearlight::core::test::has_device()) {                              \
        if (nearlight::core::test::device_is_required()) {                   \
            FAIL() << "no OpenCL device, and NEARLIGHT_REQUIRE_DEVICE is 1"; \
        }                                                                    \
        GTEST_SKIP() << "no OpenCL device";                                  \
    }                                                                        \
    static_assert(true)
