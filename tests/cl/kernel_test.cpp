// SPDX-License-Identifier: Apache-2.0
#include "host/cl/kernel.h"

#include <fstream>
#include <numeric>

#include "tests/image/temporary_folder.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

/// Devices with a kernel that counts in `out` how often each work-item runs, and in which group of which
/// size.
class KernelTest : public test::DeviceTest {
  protected:
    void SetUp() override {
        DeviceTest::SetUp();
        std::ofstream(folder_ / "visits.cl") << "kernel void visits(global uint* out, uint count) {\n"
                                                "    const uint i = (uint)get_global_id(0);\n"
                                                "    if (i < count) {\n"
                                                "        out[2 * i] += 1;\n"
                                                "        out[2 * i + 1] = (uint)(get_group_id(0) + "
                                                "get_global_offset(0) / get_local_size(0));\n"
                                                "    }\n"
                                                "}\n";
    }
    /// Calls check(kernel, device) on a device that launches at most `launch_items` work-items at once.
    template <typename Check>
    void with_launches_of(uint launch_items, const Check& check) {
        for (const auto& shared : devices()) {
            SCOPED_TRACE("device " + shared->name());
            Device device(shared->entry(), {.kernel_dir = folder_.path(), .cache_dir = "none"});
            Tunables tunables = device.tunables();
            tunables.launch_items = launch_items;
            tunables.launch_ms = 1;
            device.set_tunables(tunables);
            Kernel kernel(Program(device, "visits.cl", Defines{}), "visits");
            check(kernel, device);
        }
    }
    static std::vector<uint> all_visited(std::size_t count, uint times) {
        return std::vector<uint>(count, times);
    }
    static std::vector<uint> every_second(const std::vector<uint>& values, std::size_t first) {
        std::vector<uint> result;
        for (std::size_t i = first; i < values.size(); i += 2) {
            result.push_back(values[i]);
        }
        return result;
    }

  private:
    TemporaryFolder folder_;
};

TEST_F(KernelTest, PartsOfALaunchRunEachWorkItemOnce) {
    for (const uint launch_items : {64u, 1000u, ~0u}) {
        with_launches_of(launch_items, [](Kernel& kernel, Device& device) {
            constexpr std::size_t kCount = 100'003;
            Buffer<uint> out(device, 2 * kCount);
            out.fill_zero();
            kernel.launch_items(kCount, out, static_cast<uint>(kCount));
            EXPECT_EQ(every_second(out.download(), 0), all_visited(kCount, 1));
            kernel.launch_items(kCount, out, static_cast<uint>(kCount));
            EXPECT_EQ(every_second(out.download(), 0), all_visited(kCount, 2)) << "at the pace that it found";
        });
    }
}

TEST_F(KernelTest, PartsOfALaunchOfBundlesHaveWholeGroups) {
    with_launches_of(64, [](Kernel& kernel, Device& device) {
        constexpr std::size_t kBundles = 1001;
        const std::size_t local_size = device.tunables().bundle_local_size;
        const std::size_t count = kBundles * local_size;
        Buffer<uint> out(device, 2 * count);
        out.fill_zero();
        kernel.launch_bundles(kBundles, out, static_cast<uint>(count));
        EXPECT_EQ(every_second(out.download(), 0), all_visited(count, 1));
        const std::vector<uint> bundles = every_second(out.download(), 1);
        for (std::size_t i = 0; i < count; ++i) {
            ASSERT_EQ(bundles[i], i / local_size);
        }
    });
}

TEST_F(KernelTest, GroupsAreNoLargerThanTheDeviceAllows) {
    with_launches_of(~0u, [](Kernel& kernel, Device& device) {
        constexpr std::size_t kCount = 1u << 20u;
        Buffer<uint> out(device, 2 * kCount);
        out.fill_zero();
        kernel.launch(kCount, kCount, out, static_cast<uint>(kCount));
        EXPECT_EQ(every_second(out.download(), 0), all_visited(kCount, 1));
    });
}

}  // namespace
}  // namespace nearlight::core
