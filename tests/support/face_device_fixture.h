// SPDX-License-Identifier: Apache-2.0
// A fixture for tests that use devices through the library's face, as other programs do.
#pragma once

#include <gtest/gtest.h>

#include "nearlight/device.h"
#include "tests/support/requirement.h"

namespace nearlight::test {

/// Skips the test if there is no device; with NEARLIGHT_REQUIRE_DEVICE=1 it fails.
class FaceDeviceTest : public testing::Test {
  protected:
    void SetUp() override {
        if (!list_devices().empty()) {
            return;
        }
        if (core::test::device_is_required()) {
            FAIL() << "no OpenCL device, and NEARLIGHT_REQUIRE_DEVICE is 1";
        }
        GTEST_SKIP() << "no OpenCL device";
    }
};

}  // namespace nearlight::test
