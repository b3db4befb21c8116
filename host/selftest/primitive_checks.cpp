// SPDX-License-Identifier: Apache-2.0
#include "host/selftest/checks.h"

#include <algorithm>
#include <numeric>

#include "host/base/random.h"
#include "host/cl/kernel.h"
#include "host/cl/shared_layout.h"
#include "host/stages/compaction.h"
#include "host/stages/morton_sort.h"

namespace nearlight::core {
namespace {

/// Sizes around those of work-groups and around the lengths at which arrays are split, and a large one.
constexpr std::size_t kSizes[] = {1, 63, 64, 65, 1023, 1024, 1025, 65'537, 500'000};

template <typename T>
std::vector<T> random_numbers(std::size_t count, uint seed, T mask) {
    Pcg32 random(seed);
    std::vector<T> numbers(count);
    std::generate(numbers.begin(), numbers.end(), [&] { return static_cast<T>(random.next()) & mask; });
    return numbers;
}

template <typename T>
void expect_equal(const std::vector<T>& found, const std::vector<T>& expected, CheckResult& result) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
        result.expect(i < found.size() && found[i] == expected[i]);
    }
}

template <typename T>
void check_scan_of(Device& device, CheckResult& result) {
    PrefixScan<T> scan(device);
    for (const std::size_t size : kSizes) {
        const std::vector<T> numbers = random_numbers<T>(size, 1, T{0xfffff});
        const Buffer<T> input(device, numbers);
        Buffer<T> output(device, size);
        std::vector<T> expected(size);
        std::inclusive_scan(numbers.begin(), numbers.end(), expected.begin());
        scan.inclusive(input, output, size);
        expect_equal(output.download(), expected, result);
        std::exclusive_scan(numbers.begin(), numbers.end(), expected.begin(), T{0});
        scan.exclusive(input, output, size);
        expect_equal(output.download(), expected, result);
    }
}

/// The cell along one axis, which is every third bit of a code from `first` on.
int cell_of(uint code, uint first) {
    uint cell = 0;
    for (uint bit = 0; bit < 10; ++bit) {
        cell |= ((code >> (3 * bit + first)) & 1u) << bit;
    }
    return static_cast<int>(cell);
}

bool is_cell(int found, double exact) {
    const double nearest_border = std::round(exact);
    const bool either = std::abs(exact - nearest_border) < 1e-3;
    const int cell = std::clamp(static_cast<int>(std::floor(exact)), 0, 1023);
    return found == cell || (either && std::abs(found - nearest_border + 0.5) <= 0.5);
}

}  // namespace

void check_layout(Device& device, CheckResult& result) {
    const std::vector<LayoutFact> facts = shared_layout();
    Kernel probe(Program(device, "layout_probe.cl"), "layout_probe");
    const Buffer<uint> out(device, std::vector<uint>(facts.size() + 64, 0));
    probe.launch(1, 1, out);
    const std::vector<uint> found = out.download();
    for (std::size_t i = 0; i < facts.size(); ++i) {
        result.expect(found[i] == facts[i].value);
    }
}

void check_scan(Device& device, CheckResult& result) {
    check_scan_of<uint>(device, result);
    check_scan_of<std::uint64_t>(device, result);
}

void check_compaction(Device& device, CheckResult& result) {
    Compaction compaction(device);
    for (const std::size_t size : kSizes) {
        const std::vector<uint> flags = random_numbers<uint>(size, 2, 1);
        std::vector<uint> expected;
        for (uint i = 0; i < size; ++i) {
            if (flags[i] != 0) {
                expected.push_back(i);
            }
        }
        Buffer<uint> indices(device, size);
        std::vector<uint> found(compaction.list_set(Buffer<uint>(device, flags), size, indices));
        result.expect(found.size() == expected.size());
        indices.download(found);
        expect_equal(found, expected, result);
    }
}

void check_sort(Device& device, CheckResult& result) {
    MortonSort sorter(device);
    for (const std::size_t size : kSizes) {
        // Every second array has few different keys, so that an unstable sort is noticed.
        const std::vector<uint> numbers = random_numbers<uint>(size, 3, size % 2 == 0 ? 0xffu : ~0u);
        std::vector<uint> expected(size);
        std::iota(expected.begin(), expected.end(), 0u);
        Buffer<uint> keys(device, numbers);
        Buffer<uint> values(device, expected);
        sorter.sort(keys, values, size);
        std::stable_sort(expected.begin(), expected.end(),
                         [&](uint a, uint b) { return numbers[a] < numbers[b]; });
        expect_equal(values.download(), expected, result);
    }
}

void check_morton(Device& device, CheckResult& result) {
    constexpr std::size_t kCount = 20'000;
    Pcg32 random(4);
    std::vector<Vec3> points(kCount);
    for (Vec3& p : points) {
        const float x = 4.0f * random.uniform() - 1.0f;
        const float y = 2.0f * random.uniform();
        p = {x, y, random.uniform()};
    }
    MortonSort morton(device);
    const Buffer<Vec3> positions(device, points);
    Buffer<uint> codes(device, kCount);
    Buffer<uint> values(device, kCount);
    const Aabb box = morton.bounds(positions, kCount);
    Aabb expected;
    for (const Vec3 p : points) {
        expected.extend(p);
    }
    result.expect(box.min == expected.min && box.max == expected.max);
    morton.codes(positions, kCount, box, codes, values);
    const std::vector<uint> found = codes.download();
    const double scale = 1024.0 / max_component(box.size());
    for (std::size_t i = 0; i < kCount; ++i) {
        const Vec3 p = points[i] - box.min;
        result.expect(is_cell(cell_of(found[i], 2), p.x * scale) &&
                      is_cell(cell_of(found[i], 1), p.y * scale) &&
                      is_cell(cell_of(found[i], 0), p.z * scale));
    }
}

}  // namespace nearlight::core
