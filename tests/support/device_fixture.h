// SPDX-License-Identifier: Apache-2.0
// A fixture for tests that run on every OpenCL device of the machine.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "host/cl/buffer.h"
#include "host/cl/device.h"

namespace nearlight::core::test {

/// Opens every usable device, or those that NEARLIGHT_TEST_DEVICES names (an index, part of a name, cpu, gpu,
/// all). If there is none, the test is skipped; with NEARLIGHT_REQUIRE_DEVICE=1 it fails. Kernels are those of
/// the binary, or of the folder NEARLIGHT_TEST_KERNELS (scripts/mutants breaks kernels without a build).
class DeviceTest : public ::testing::Test {
  protected:
    void SetUp() override;

    /// Runs `check(device)` on each device, naming it in failures.
    template <typename Check>
    void on_each_device(Check&& check) {
        for (const std::unique_ptr<Device>& device : devices_) {
            SCOPED_TRACE("device " + device->name());
            check(*device);
        }
    }
    /// Runs `check(device)` on each device, and a second time with the binary tree if single rays use the
    /// wide tree.
    template <typename Check>
    void on_each_ray_tree(Check&& check) {
        on_each_device([&](Device& device) {
            check(device);
            if (device.has_wide_rays()) {
                SCOPED_TRACE("single rays through the binary tree");
                DeviceOptions options = device.options();
                options.wide_rays = false;
                Device other(device.entry(), options);
                check(other);
            }
        });
    }
    [[nodiscard]] const std::vector<std::unique_ptr<Device>>& devices() const { return devices_; }

  private:
    std::vector<std::unique_ptr<Device>> devices_;
};

/// Folder inside the build tree in which programs compiled by tests are kept.
std::filesystem::path test_cache_dir();

/// A buffer of `count` elements, followed by guard elements that kernels must leave alone.
template <typename T>
class GuardedBuffer {
  public:
    GuardedBuffer(Device& device, std::size_t count)
        : count_(count), buffer_(device, std::vector<T>(count + kGuards, guard())) {}

    [[nodiscard]] Buffer<T>& buffer() { return buffer_; }
    /// The elements; fails the test if a guard was written.
    [[nodiscard]] std::vector<T> download() const {
        std::vector<T> values = buffer_.download();
        for (std::size_t i = count_; i < values.size(); ++i) {
            EXPECT_EQ(values[i], guard()) << "guard " << i - count_ << " behind " << count_ << " elements";
        }
        values.resize(count_);
        return values;
    }

  private:
    static constexpr std::size_t kGuards = 64;
    static constexpr T guard() { return static_cast<T>(0xdeadbeefcafef00dull); }

    std::size_t count_;
    Buffer<T> buffer_;
};

}  // namespace nearlight::core::test
