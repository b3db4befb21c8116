// SPDX-License-Identifier: Apache-2.0
// For tests that run the program on a device: what to do where there is none.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "host/cl/devices/device_list.h"

namespace nearlight::core::test {

inline bool has_device() {
    const DeviceList list = list_devices();
    return std::any_of(list.devices.begin(), list.devices.end(),
                       [](const DeviceEntry& entry) { return entry.unusable_because.empty(); });
}

/// NEARLIGHT_REQUIRE_DEVICE=1, as CI sets it: a missing device is a failure.
inline bool device_is_required() {
    const char* const required = std::getenv("NEARLIGHT_REQUIRE_DEVICE");
    return required != nullptr && std::string_view(required) == "1";
}

}  // namespace nearlight::core::test

/// Ends the test where no device is usable: skipped, or failed where one is required.
#define NEARLIGHT_NEEDS_DEVICE()                                             \
    if (!nearlight::core::test::has_device()) {                              \
        if (nearlight::core::test::device_is_required()) {                   \
            FAIL() << "no OpenCL device, and NEARLIGHT_REQUIRE_DEVICE is 1"; \
        }                                                                    \
        GTEST_SKIP() << "no OpenCL device";                                  \
    }                                                                        \
    static_assert(true)
