// SPDX-License-Identifier: Apache-2.0
#include "host/stages/prefix_scan.h"

#include <numeric>

#include "host/base/random.h"
#include "tests/support/device_fixture.h"
#include "tests/support/sizes.h"

namespace nearlight::core {
namespace {

using test::GuardedBuffer;

class PrefixScanTest : public test::DeviceTest {};

template <typename T>
std::vector<T> random_values(std::size_t count, T largest) {
    Pcg32 random(count + 1);
    std::vector<T> values(count);
    for (T& value : values) {
        value = static_cast<T>((std::uint64_t{random.next()} << 32u | random.next()) % (largest + 1));
    }
    return values;
}

template <typename T>
void check_scans(Device& device, const std::vector<T>& values) {
    PrefixScan<T> scan(device);
    const Buffer<T> input(device, values);
    std::vector<T> expected(values.size());

    GuardedBuffer<T> output(device, values.size());
    scan.exclusive(input, output.buffer(), values.size());
    std::exclusive_scan(values.begin(), values.end(), expected.begin(), T{0});
    EXPECT_EQ(output.download(), expected) << "exclusive, " << values.size() << " elements";
    EXPECT_EQ(scan.total().download_one(0), std::accumulate(values.begin(), values.end(), T{0}));

    scan.inclusive(input, output.buffer(), values.size());
    std::inclusive_scan(values.begin(), values.end(), expected.begin());
    EXPECT_EQ(output.download(), expected) << "inclusive, " << values.size() << " elements";
    EXPECT_EQ(scan.total().download_one(0), std::accumulate(values.begin(), values.end(), T{0}));
}

TEST_F(PrefixScanTest, CountsMatchTheStandardLibraryAtEverySize) {
    on_each_device([](Device& device) {
        for (const std::size_t size : test::awkward_sizes()) {
            check_scans(device, random_values<uint>(size, 300));
        }
    });
}

TEST_F(PrefixScanTest, AreasMatchTheStandardLibraryBeyond32Bits) {
    on_each_device([](Device& device) {
        for (const std::size_t size : test::awkward_sizes()) {
            check_scans(device, random_values<std::uint64_t>(size, std::uint64_t{1} << 40u));
        }
    });
}

TEST_F(PrefixScanTest, InputAndOutputMayBeOneBuffer) {
    on_each_device([](Device& device) {
        const std::vector<uint> values = random_values<uint>(100'003, 1000);
        Buffer<uint> buffer(device, values);
        PrefixScan<uint>(device).exclusive(buffer, buffer, values.size());
        std::vector<uint> expected(values.size());
        std::exclusive_scan(values.begin(), values.end(), expected.begin(), 0u);
        EXPECT_EQ(buffer.download(), expected);
    });
}

TEST_F(PrefixScanTest, TotalOfNothingIsZeroAlsoAfterAnotherScan) {
    on_each_device([](Device& device) {
        PrefixScan<uint> scan(device);
        EXPECT_EQ(scan.total().download_one(0), 0u);
        Buffer<uint> buffer(device, std::vector<uint>{5, 6});
        scan.inclusive(buffer, buffer, 2);
        EXPECT_EQ(scan.total().download_one(0), 11u);
        scan.inclusive(buffer, buffer, 0);
        EXPECT_EQ(scan.total().download_one(0), 0u);
    });
}

}  // namespace
}  // namespace nearlight::core
