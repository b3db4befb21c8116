// SPDX-License-Identifier: Apache-2.0
#include "tests/support/device_fixture.h"

#include <cstdlib>
#include <string>

namespace nearlight::core::test {
namespace {

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
}

}  // namespace

std::filesystem::path test_cache_dir() {
    return std::filesystem::path(NEARLIGHT_BINARY_DIR) / "test-cache";
}

void DeviceTest::SetUp() {
    const std::string wanted = environment("NEARLIGHT_TEST_DEVICES");
    std::vector<DeviceEntry> entries;
    try {
        entries = choose_devices(list_devices(), wanted.empty() ? "all" : wanted);
    } catch (const Error& error) {
        if (environment("NEARLIGHT_REQUIRE_DEVICE") == "1") {
            FAIL() << error.what();
        }
        GTEST_SKIP() << error.what();
    }
    DeviceOptions options;
    options.kernel_dir = environment("NEARLIGHT_TEST_KERNELS");
    options.cache_dir = test_cache_dir();
    for (const DeviceEntry& entry : entries) {
        devices_.push_back(std::make_unique<Device>(entry, options));
    }
}

}  // namespace nearlight::core::test
