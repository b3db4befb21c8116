// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/spatial_split.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace nearlight::core {
namespace {

constexpr float kMaxSplitArea = 1e30f;
constexpr float kWeightUnit = 0x1p30f;
/// In longer ranges, a sample of this many references first tells whether a plane is worth looking for, which
/// is rare. The boxes of a sample are smaller, so it errs towards looking.
constexpr std::size_t kSample = 512;

/// The corners of a triangle, each aligned as Box4 is.
struct Corners {
    alignas(16) float points[3][4];

    Corners(const Scene& scene, uint id) {
        const Triangle& triangle = scene.triangles[id];
        set(0, scene.vertices[triangle.v0].position);
        set(1, scene.vertices[triangle.v1].position);
        set(2, scene.vertices[triangle.v2].position);
    }

  private:
    void set(int i, Vec3 p) {
        points[i][0] = p.x;
        points[i][1] = p.y;
        points[i][2] = p.z;
        points[i][3] = 0.0f;
    }
};

/// The fraction of the way from a to b, 0 to 1, at which an edge passes the plane between them.
float pass_plane(const float* a, const float* b, int axis, float position) {
    return std::clamp((position - a[axis]) / (b[axis] - a[axis]), 0.0f, 1.0f);
}

bool is_empty(const Box4& box) {
    return !(box.low[0] <= box.high[0] && box.low[1] <= box.high[1] && box.low[2] <= box.high[2]);
}

float area_together(Box4 a, const Box4& b) {
    a.extend(b);
    return a.half_area();
}

struct Slab {
    Box4 box;
    uint entries;  ///< references that begin in the slab
    uint exits;    ///< references that end in the slab
};

/// The slabs of one axis.
struct AxisSlabs {
    std::array<Slab, kMaxSlabs> slabs;  // slabs beyond the count in use are never touched

    void clear(int count) { std::fill_n(slabs.begin(), count, Slab{Box4::empty(), 0, 0}); }

    void add(const AxisSlabs& other, int count) {
        for (int i = 0; i < count; ++i) {
            slabs[i].box.extend(other.slabs[i].box);
            slabs[i].entries += other.slabs[i].entries;
            slabs[i].exits += other.slabs[i].exits;
        }
    }

    /// Adds a reference that reaches from slab `first` to a later slab `last`; each slab gets the box of what
    /// lies in it.
    void add_cut(const Reference& reference, const Corners& corners, const BinMapping& mapping, int axis,
                 int first, int last) {
        std::array<Box4, kMaxSlabs> parts;
        std::fill(parts.begin() + first, parts.begin() + last + 1, Box4::empty());
        const float* a = corners.points[2];
        int slab_a = mapping.bin(a[axis], axis);
        for (const auto& b : corners.points) {
            const int slab_b = mapping.bin(b[axis], axis);
            if (slab_b >= first && slab_b <= last) {
                parts[slab_b].extend(b);
            }
            const int end = std::min(std::max(slab_a, slab_b), last + 1);
            for (int i = std::max(std::min(slab_a, slab_b) + 1, first); i <= end; ++i) {
                const float t = pass_plane(a, b, axis, mapping.plane(i, axis));
                if (i > first) {
                    parts[i - 1].extend_between(a, b, t);
                }
                if (i <= last) {
                    parts[i].extend_between(a, b, t);
                }
            }
            a = b;
            slab_a = slab_b;
        }
        for (int i = first; i <= last; ++i) {
            parts[i].clip(reference);
            if (!is_empty(parts[i])) {
                slabs[i].box.extend(parts[i]);
            }
        }
    }

    [[nodiscard]] SpatialSplit better(int axis, int count, const SpatialSplit& best) const {
        SpatialSplit result = best;
        std::array<Box4, kMaxSlabs> right_boxes;
        std::array<uint, kMaxSlabs> right_counts;
        Box4 right = Box4::empty();
        uint right_count = 0;
        for (int i = count - 1; i > 0; --i) {
            right.extend(slabs[i].box);
            right_count += slabs[i].exits;
            right_boxes[i] = right;
            right_counts[i] = right_count;
        }
        Box4 left = Box4::empty();
        uint left_count = 0;
        for (int i = 1; i < count; ++i) {
            left.extend(slabs[i - 1].box);
            left_count += slabs[i - 1].entries;
            if (left_count == 0 || right_counts[i] == 0) {
                continue;
            }
            const float cost = left.half_area() * static_cast<float>(left_count) +
                               right_boxes[i].half_area() * static_cast<float>(right_counts[i]);
            if (cost < result.cost) {
                result = {cost, axis, i, left_count, right_counts[i], left, right_boxes[i]};
            }
        }
        return result;
    }
};

struct Slabs {
    explicit Slabs(int count) : slab_count(count) {
        for (AxisSlabs& axis : axes) {
            axis.clear(count);
        }
    }

    void add(const Slabs& other) {
        for (int axis = 0; axis < 3; ++axis) {
            axes[axis].add(other.axes[axis], slab_count);
        }
    }
    void add(const Reference& reference, const Scene& scene, const BinMapping& mapping) {
        alignas(16) int firsts[4];
        alignas(16) int lasts[4];
        mapping.get_bins(reference.low, firsts);
        mapping.get_bins(reference.high, lasts);
        for (int axis = 0; axis < 3; ++axis) {
            const int first = firsts[axis];
            const int last = lasts[axis];
            auto& slabs = axes[axis].slabs;
            ++slabs[first].entries;
            ++slabs[last].exits;
            if (first == last) {
                slabs[first].box.extend(reference);
            } else {
                axes[axis].add_cut(reference, Corners(scene, reference.id()), mapping, axis, first, last);
            }
        }
    }

    [[nodiscard]] SpatialSplit best() const {
        SpatialSplit result;
        for (int axis = 0; axis < 3; ++axis) {
            result = axes[axis].better(axis, slab_count, result);
        }
        return result;
    }

    int slab_count;
    std::array<AxisSlabs, 3> axes;
};

}  // namespace

SpatialSplitter::SpatialSplitter(const Scene& scene, const Box4& root)
    : scene_(scene), root_area_(root.half_area()), pad_(0.0f) {
    for (int axis = 0; axis < 3; ++axis) {
        pad_ = std::max({pad_, 0x1p-19f * std::abs(root.low[axis]), 0x1p-19f * std::abs(root.high[axis])});
    }
    usable_ = root_area_ > 0.0f && root_area_ < kMaxSplitArea;
}

uint SpatialSplitter::weight(const Reference& reference) const {
    const Corners corners(scene_, reference.id());
    const auto point = [&](int i) {
        return Vec3{corners.points[i][0], corners.points[i][1], corners.points[i][2]};
    };
    const Vec3 doubled = cross(point(1) - point(0), point(2) - point(0));
    const float needed = std::abs(doubled.x) + std::abs(doubled.y) + std::abs(doubled.z);
    const float excess = std::max(reference.half_area() - needed, 0.0f);
    return static_cast<uint>(std::min(std::sqrt(excess / root_area_), 1.0f) * kWeightUnit);
}

SpatialSplit SpatialSplitter::find(std::span<const Reference> range, const BinMapping& mapping,
                                   float max_cost) const {
    const std::size_t stride = range.size() / kSample;
    if (stride > 1) {
        Slabs sample(mapping.count());
        for (std::size_t i = 0; i < range.size(); i += stride) {
            sample.add(range[i], scene_, mapping);
        }
        if (sample.best().cost * static_cast<float>(stride) > max_cost) {
            return {};
        }
    }
    Slabs slabs(mapping.count());
    fold(range, slabs, [&](Slabs& sum, std::span<const Reference> part) {
        for (const Reference& reference : part) {
            sum.add(reference, scene_, mapping);
        }
    });
    const SpatialSplit best = slabs.best();
    return best.cost <= max_cost ? best : SpatialSplit{};
}

SpatialSplitter::Cut SpatialSplitter::cut(const Reference& reference, int axis, float position) const {
    const Corners corners(scene_, reference.id());
    Box4 left = Box4::empty();
    Box4 right = Box4::empty();
    const float* a = corners.points[2];
    for (const auto& b : corners.points) {
        if (b[axis] <= position) {
            left.extend(b);
        }
        if (b[axis] >= position) {
            right.extend(b);
        }
        if ((a[axis] < position) != (b[axis] < position)) {
            const float t = pass_plane(a, b, axis, position);
            left.extend_between(a, b, t);
            right.extend_between(a, b, t);
        }
        a = b;
    }
    const auto finish = [&](Box4 box) {
        for (int i = 0; i < 3; ++i) {
            box.low[i] = (box.low[i] - pad_) + 0.0f;
            box.high[i] = (box.high[i] + pad_) + 0.0f;
        }
        box.clip(reference);
        Reference part{box};
        part.set_id(reference.id());
        const float share = part.half_area() / reference.half_area();
        part.set_weight(share > 0.0f && share < 1.0f
                            ? static_cast<uint>(static_cast<float>(reference.weight()) * std::sqrt(share))
                            : 0u);
        return part;
    };
    return {finish(left), finish(right)};
}

SpatialSplitter::Parts SpatialSplitter::partition(std::span<Reference> room, std::size_t count,
                                                  const BinMapping& mapping,
                                                  const SpatialSplit& split) const {
    const float position = mapping.plane(split.first_right_slab, split.axis);
    const auto left_count = static_cast<float>(split.left_count);
    const auto right_count = static_cast<float>(split.right_count);
    const float left_area = split.left.half_area();
    const float right_area = split.right.half_area();
    std::size_t left_end = 0;
    std::size_t right_begin = count;
    std::size_t right_end = count;
    const auto put_right = [&] { std::swap(room[left_end], room[--right_begin]); };
    while (left_end < right_begin) {
        Reference& reference = room[left_end];
        if (mapping.bin(reference.low[split.axis], split.axis) >= split.first_right_slab) {
            put_right();
            continue;
        }
        if (mapping.bin(reference.high[split.axis], split.axis) < split.first_right_slab) {
            ++left_end;
            continue;
        }
        const Cut parts = cut(reference, split.axis, position);
        const float as_two = left_area * left_count + right_area * right_count;
        const float as_left =
            area_together(split.left, reference) * left_count + right_area * (right_count - 1.0f);
        const float as_right =
            left_area * (left_count - 1.0f) + area_together(split.right, reference) * right_count;
        if (is_empty(parts.left) || (as_right < as_two && as_right < as_left)) {
            put_right();
        } else if (is_empty(parts.right) || as_left < as_two) {
            ++left_end;
        } else {
            room[right_end++] = parts.right;
            reference = parts.left;
            ++left_end;
        }
    }
    return {left_end, right_end - left_end};
}

}  // namespace nearlight::core
