// SPDX-License-Identifier: Apache-2.0
// References, which the builder moves about in place of triangles: the box of a triangle or of a part of one.
#pragma once

#include <bit>
#include <span>

#include "host/bvh/box4.h"
#include "host/bvh/parallel.h"
#include "host/scene/scene.h"

namespace nearlight::core {

constexpr std::size_t kParallelLoop = 1u << 16u;  // shorter loops run on one thread
constexpr std::size_t kLoopGrain = 1u << 14u;

/// A padded box that carries the index of its triangle, and a weight, in the free lanes: 32 bytes that stay
/// together when partitioning, so that every loop runs through memory in order.
struct Reference : Box4 {
    [[nodiscard]] uint id() const { return std::bit_cast<uint>(low[3]); }
    void set_id(uint id) { low[3] = std::bit_cast<float>(id); }
    /// How much a tree would gain from splitting the reference (spatial_split.h); 0 if nothing is split.
    [[nodiscard]] uint weight() const { return std::bit_cast<uint>(high[3]); }
    void set_weight(uint weight) { high[3] = std::bit_cast<float>(weight); }
};

/// The reference of a whole triangle, with weight 0. Every box is padded by two ulps of its largest
/// coordinate. Without padding, the box of an axis-aligned triangle has no thickness, its two slab distances
/// differ by nothing but rounding, and a ray that hits the triangle (or runs exactly along the face of a box)
/// may find the interval empty. Adding +0 turns −0 into +0, because a minimum keeps the first of two equal
/// zeros, and which is first would depend on the threads.
Reference make_reference(const Scene& scene, uint id);

/// Folds a range of references into `sum`, which is empty: add(sum, part of the range). Minima, maxima and
/// counts do not depend on the order in which threads finish, so neither does the result.
template <typename Sum, typename Add>
void fold(std::span<const Reference> range, Sum& sum, const Add& add) {
    const auto add_part = [&](Sum& partial, std::size_t first, std::size_t last) {
        add(partial, range.subspan(first, last - first));
    };
    if (range.size() < kParallelLoop) {
        add_part(sum, 0, range.size());
    } else {
        sum = parallel_sum(range.size(), kLoopGrain, sum, add_part);
    }
}

struct RangeBounds {
    Box4 box = Box4::empty();
    Box4 centers = Box4::empty();
    std::uint64_t weight = 0;

    void add(const Reference& reference) {
        box.extend(reference);
        centers.extend_by_center(reference);
        weight += reference.weight();
    }
    void add(const RangeBounds& other) {
        box.extend(other.box);
        centers.extend(other.centers);
        weight += other.weight;
    }
};

}  // namespace nearlight::core
