// SPDX-License-Identifier: Apache-2.0
#include "host/reference/sample_batch.h"

#include <cmath>
#include <utility>

namespace nearlight::core {
namespace {

/// Bijective mixing of bits [Steele, Lea and Flood, Fast Splittable Pseudorandom Number Generators, 2014].
std::uint64_t mix(std::uint64_t x) {
    x = (x ^ (x >> 30u)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27u)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31u);
}

constexpr float kBelowOne = 0x1.fffffep-1f;

}  // namespace

SampleBatch::SampleBatch(std::uint64_t seed, std::uint64_t pixel, std::uint64_t batch, int size)
    : random_(mix(mix(seed + 0x9e3779b97f4a7c15ull) + batch), mix(pixel + 0x9e3779b97f4a7c15ull)) {
    const int side = static_cast<int>(std::lround(std::sqrt(size)));
    const float cell = 1.0f / static_cast<float>(side);
    for (auto& points : points_) {
        for (int i = 0; i < size; ++i) {
            const float x = (static_cast<float>(i % side) + random_.uniform()) * cell;
            const float y = (static_cast<float>(i / side) + random_.uniform()) * cell;
            points[static_cast<std::size_t>(i)] = {std::min(x, kBelowOne), std::min(y, kBelowOne)};
        }
        for (int i = size - 1; i > 0; --i) {
            const auto other = random_.next() % static_cast<std::uint32_t>(i + 1);
            std::swap(points[static_cast<std::size_t>(i)], points[other]);
        }
    }
}

}  // namespace nearlight::core
