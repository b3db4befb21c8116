// SPDX-License-Identifier: Apache-2.0
#include "host/stages/morton_sort.h"

#include <numeric>

#include "host/base/random.h"
#include "tests/support/device_fixture.h"
#include "tests/support/sizes.h"

namespace nearlight::core {
namespace {

using test::GuardedBuffer;

class MortonSortTest : public test::DeviceTest {};

/// Sorts (keys[i], i) on the device and compares with a stable sort here.
void check_sort(MortonSort& sorter, Device& device, const std::vector<uint>& keys) {
    std::vector<uint> expected(keys.size());
    std::iota(expected.begin(), expected.end(), 0u);
    GuardedBuffer<uint> sorted_keys(device, keys.size());
    GuardedBuffer<uint> sorted_values(device, keys.size());
    sorted_keys.buffer().upload(keys);
    sorted_values.buffer().upload(expected);
    sorter.sort(sorted_keys.buffer(), sorted_values.buffer(), keys.size());

    std::stable_sort(expected.begin(), expected.end(), [&](uint a, uint b) { return keys[a] < keys[b]; });
    EXPECT_EQ(sorted_values.download(), expected) << keys.size() << " keys";
    std::vector<uint> expected_keys = keys;
    std::sort(expected_keys.begin(), expected_keys.end());
    EXPECT_EQ(sorted_keys.download(), expected_keys) << keys.size() << " keys";
}

std::vector<uint> random_keys(std::size_t count, uint mask) {
    Pcg32 random(count);
    std::vector<uint> keys(count);
    std::generate(keys.begin(), keys.end(), [&] { return random.next() & mask; });
    return keys;
}

TEST_F(MortonSortTest, SortsLikeTheStandardLibraryAtEverySize) {
    on_each_device([](Device& device) {
        MortonSort sorter(device);
        for (const std::size_t size : test::awkward_sizes()) {
            check_sort(sorter, device, random_keys(size, ~0u));
        }
    });
}

TEST_F(MortonSortTest, EqualKeysKeepTheirOrder) {
    on_each_device([](Device& device) {
        MortonSort sorter(device);
        check_sort(sorter, device, std::vector<uint>(100'000, 0x2bad0bad));
        for (const uint mask : {1u, 0x100u, 0x80000001u, 0x00ff00ffu}) {
            check_sort(sorter, device, random_keys(100'000, mask));
        }
    });
}

TEST_F(MortonSortTest, SortedAndReversedKeys) {
    on_each_device([](Device& device) {
        MortonSort sorter(device);
        std::vector<uint> keys(50'001);
        std::iota(keys.begin(), keys.end(), 0xfffff000u);  // wraps around
        check_sort(sorter, device, keys);
        std::reverse(keys.begin(), keys.end());
        check_sort(sorter, device, keys);
        std::sort(keys.begin(), keys.end());
        check_sort(sorter, device, keys);
    });
}

uint interleave(uint x, uint y, uint z) {
    uint code = 0;
    for (uint bit = 0; bit < 10; ++bit) {
        code |= ((x >> bit & 1u) << 2u | (y >> bit & 1u) << 1u | (z >> bit & 1u)) << 3u * bit;
    }
    return code;
}

TEST_F(MortonSortTest, CodesInterleaveTheCellsOfEachAxis) {
    on_each_device([](Device& device) {
        // One cell is a quarter of a metre; the box is longest along x, so y and z use fewer cells.
        const Aabb box{{-10, 2, 5}, {246, 34, 69}};
        Pcg32 random(4);
        std::vector<Vpl> points(1000);
        std::vector<uint> expected(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            const uint x = random.next() % 1024;
            const uint y = random.next() % 128;
            const uint z = random.next() % 256;
            const auto at = [](uint cell) { return (static_cast<float>(cell) + 0.5f) * 0.25f; };
            points[i].position = box.min + Vec3{at(x), at(y), at(z)};
            expected[i] = interleave(x, y, z);
        }
        GuardedBuffer<uint> codes(device, points.size());
        GuardedBuffer<uint> values(device, points.size());
        MortonSort(device).codes(Buffer<Vpl>(device, points), points.size(), box, codes.buffer(),
                                 values.buffer());
        EXPECT_EQ(codes.download(), expected);
        std::iota(expected.begin(), expected.end(), 0u);
        EXPECT_EQ(values.download(), expected);
    });
}

TEST_F(MortonSortTest, CodesOfOutsidersAndOfNanAreInRange) {
    on_each_device([](Device& device) {
        constexpr float kInf = std::numeric_limits<float>::infinity();
        const std::vector<Vec3> points{{-5, 0.5f, 9}, {kInf, -kInf, 0}, {NAN, NAN, NAN}, {1, 1, 1}};
        Buffer<uint> codes(device, points.size());
        Buffer<uint> values(device, points.size());
        MortonSort(device).codes(Buffer<Vec3>(device, points), points.size(), {{0, 0, 0}, {1, 1, 1}}, codes,
                                 values);
        const std::vector<uint> expected{interleave(0, 512, 1023), interleave(1023, 0, 0), 0,
                                         interleave(1023, 1023, 1023)};
        EXPECT_EQ(codes.download(), expected);
    });
}

TEST_F(MortonSortTest, BoundsHoldAllFinitePointsTightly) {
    on_each_device([](Device& device) {
        MortonSort sorter(device);
        for (const std::size_t size : {1u, 1000u, 1024u, 100'003u}) {
            Pcg32 random(size);
            std::vector<Vec3> points(size);
            Aabb expected;
            for (Vec3& p : points) {
                p = {random.uniform() - 3, random.uniform() * 100, random.uniform() * 1e-6f};
                expected.extend(p);
            }
            if (size > 10) {
                constexpr float kInfinite = std::numeric_limits<float>::infinity();
                for (const Vec3 p :
                     {Vec3{NAN, 1e9f, 0}, Vec3{1e9f, kInfinite, 1e9f}, Vec3{-1e9f, 0, -kInfinite}}) {
                    points.insert(points.begin() + 5, p);
                }
            }
            const Aabb box = sorter.bounds(Buffer<Vec3>(device, points), points.size());
            EXPECT_EQ(box.min, expected.min);
            EXPECT_EQ(box.max, expected.max);
        }
        EXPECT_TRUE(sorter.bounds(Buffer<Vec3>(device, 0), 0).is_empty());
    });
}

TEST_F(MortonSortTest, OrderVisitsAGridOctantByOctant) {
    on_each_device([](Device& device) {
        std::vector<SurfaceSample> samples;
        for (int i = 0; i < 8 * 8 * 8; ++i) {
            // The points are in another order than the curve's: x changes fastest.
            SurfaceSample sample{};
            sample.position = {static_cast<float>(i % 8), static_cast<float>(i / 8 % 8),
                               static_cast<float>(i / 64)};
            samples.push_back(sample);
        }
        Buffer<uint> order(device, samples.size());
        MortonSort(device).order(Buffer<SurfaceSample>(device, samples), samples.size(), order);
        const std::vector<uint> indices = order.download();
        for (std::size_t i = 0; i < indices.size(); ++i) {
            const Vec3 p = samples[indices[i]].position;
            const std::size_t octant =
                (p.x > 3.5f ? 4u : 0u) + (p.y > 3.5f ? 2u : 0u) + (p.z > 3.5f ? 1u : 0u);
            EXPECT_EQ(octant, i / 64) << "place " << i;
        }
    });
}

TEST_F(MortonSortTest, OrderOfCoincidentPointsIsTheirOwn) {
    on_each_device([](Device& device) {
        const std::vector<Vec3> points(3000, Vec3{1, 2, 3});
        Buffer<uint> order(device, points.size());
        MortonSort(device).order(Buffer<Vec3>(device, points), points.size(), order);
        std::vector<uint> expected(points.size());
        std::iota(expected.begin(), expected.end(), 0u);
        EXPECT_EQ(order.download(), expected);
    });
}

}  // namespace
}  // namespace nearlight::core
