// SPDX-License-Identifier: Apache-2.0
#include "host/stages/compaction.h"

#include "host/base/random.h"
#include "tests/support/device_fixture.h"
#include "tests/support/sizes.h"

namespace nearlight::core {
namespace {

using test::GuardedBuffer;

class CompactionTest : public test::DeviceTest {};

std::vector<uint> indices_of_set(const std::vector<uint>& flags) {
    std::vector<uint> indices;
    for (std::size_t i = 0; i < flags.size(); ++i) {
        if (flags[i] != 0) {
            indices.push_back(static_cast<uint>(i));
        }
    }
    return indices;
}

void check(Compaction& compaction, Device& device, const std::vector<uint>& flags) {
    const std::vector<uint> expected = indices_of_set(flags);
    GuardedBuffer<uint> indices(device, expected.size());
    const Buffer<uint> input(device, flags);
    EXPECT_EQ(compaction.list_set(input, flags.size(), indices.buffer()), expected.size());
    EXPECT_EQ(indices.download(), expected) << flags.size() << " flags";
}

TEST_F(CompactionTest, ListsSetFlagsInOrderAtEverySize) {
    on_each_device([](Device& device) {
        Compaction compaction(device);
        for (const std::size_t size : test::awkward_sizes()) {
            Pcg32 random(size);
            std::vector<uint> flags(size);
            for (uint& flag : flags) {
                flag = random.next() >> 31u;
            }
            check(compaction, device, flags);
        }
    });
}

TEST_F(CompactionTest, AllNoneFirstLastAndAnyNonZeroValue) {
    on_each_device([](Device& device) {
        Compaction compaction(device);
        constexpr std::size_t kCount = 5000;
        check(compaction, device, std::vector<uint>(kCount, 1));
        check(compaction, device, std::vector<uint>(kCount, 0));
        std::vector<uint> ends(kCount, 0);
        ends.front() = 7;
        ends.back() = ~0u;
        check(compaction, device, ends);
    });
}

TEST_F(CompactionTest, GathersElementsOfAnyStruct) {
    on_each_device([](Device& device) {
        constexpr std::size_t kCount = 1001;
        std::vector<Vpl> vpls(kCount);
        std::vector<uint> indices(kCount);
        Pcg32 random(3);
        for (std::size_t i = 0; i < kCount; ++i) {
            vpls[i] = {.position = {random.uniform(), 0, 0},
                       .depth = static_cast<uint>(i),
                       .normal = {},
                       .flags = 0,
                       .power = {},
                       .shading = random.next()};
            indices[i] = random.next() % kCount;
        }
        Buffer<Vpl> gathered(device, kCount);
        Compaction(device).gather(Buffer<Vpl>(device, vpls), Buffer<uint>(device, indices), kCount, gathered);
        const std::vector<Vpl> result = gathered.download();
        for (std::size_t i = 0; i < kCount; ++i) {
            EXPECT_EQ(result[i].depth, indices[i]);
            EXPECT_EQ(result[i].position.x, vpls[indices[i]].position.x);
            EXPECT_EQ(result[i].shading, vpls[indices[i]].shading);
        }
    });
}

}  // namespace
}  // namespace nearlight::core
