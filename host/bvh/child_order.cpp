// SPDX-License-Identifier: Apache-2.0
#include "host/bvh/child_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "host/base/random.h"
#include "host/bvh/parallel.h"
#include "host/bvh/ray_tests.h"
#include "host/bvh/sah_builder.h"
#include "host/scene/ray_epsilon.h"

namespace nearlight::core {
namespace {

constexpr std::size_t kMaxSegments = 4000;
constexpr std::size_t kMinSegments = 500;
constexpr std::size_t kTrianglesPerSegment = 16;  // in small scenes, where time is short
constexpr std::size_t kTriesPerSegment = 4;       // pairs of points, many of which face away from each other
constexpr std::uint64_t kSeed = 7;
/// The estimate from areas counts as much as this many segments.
constexpr double kPrior = 8.0;
/// Parts of the segments that one thread each traces. There are few, because each has records of all nodes.
constexpr std::size_t kSurveyParts = 4;
constexpr std::size_t kNodeGrain = 1u << 12u;

/// What a segment finds below a box that it meets.
struct Passage {
    bool hit = false;
    uint cost = 0;  ///< number of nodes and triangles visited
};

/// Sums over segments that met one child. They are whole numbers, so their order does not matter.
struct Record {
    uint visits = 0;
    uint hits = 0;
    uint cost = 0;

    void add(const Passage& passage) {
        visits += 1;
        hits += passage.hit ? 1 : 0;
        cost += passage.cost;
    }
    void add(const Record& other) {
        visits += other.visits;
        hits += other.hits;
        cost += other.cost;
    }
};
struct Records {
    Record left;
    Record right;
};

/// Traces segments that visit everything on their way, hits or not, so that every box they meet counts.
class Survey {
  public:
    Survey() = default;
    explicit Survey(const Bvh& bvh) : bvh_(&bvh), records_(bvh.nodes.size()) {}

    void trace(const TestRay& ray) { visit(0, ray); }
    [[nodiscard]] std::vector<Records> take() && { return std::move(records_); }
    void add(const Survey& other) {
        parallel_for(records_.size(), kNodeGrain, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                records_[i].left.add(other.records_[i].left);
                records_[i].right.add(other.records_[i].right);
            }
        });
    }

  private:
    Passage visit(uint reference, const TestRay& ray) {
        if (is_leaf(reference)) {
            return visit_leaf(reference, ray);
        }
        const BvhNode& node = bvh_->nodes[reference];
        Passage sum{false, 1};
        const auto visit_child = [&](uint child, Vec3 low, Vec3 high, Record& record) {
            if (std::isinf(enter_box(ray, 1.0f, low, high))) {
                return;
            }
            const Passage passage = visit(child, ray);
            record.add(passage);
            sum.cost += sum.hit ? 0 : passage.cost;
            sum.hit = sum.hit || passage.hit;
        };
        visit_child(node.left, node.left_min, node.left_max, records_[reference].left);
        visit_child(node.right, node.right_min, node.right_max, records_[reference].right);
        return sum;
    }

    [[nodiscard]] Passage visit_leaf(uint leaf, const TestRay& ray) const {
        Passage sum;
        for (uint i = leaf_first(leaf); i < leaf_first(leaf) + leaf_count(leaf) && !sum.hit; ++i) {
            BvhHit hit;
            hit.t = NEARLIGHT_SEGMENT_T_MAX;
            sum.cost += 1;
            sum.hit = intersect(bvh_->triangles[i], ray, hit);
        }
        return sum;
    }

    const Bvh* bvh_ = nullptr;
    std::vector<Records> records_;
};

struct SurfacePoint {
    Vec3 position;  ///< moved off the surface
    Vec3 normal;
};

/// Random points on the fronts of triangles, evenly by area.
class Surfaces {
  public:
    Surfaces(const Scene& scene, std::span<const uint> ids)
        : scene_(scene), ids_(ids), size_(bounds(scene).size()) {
        cumulative_.resize(ids.size());
        parallel_for(ids.size(), kNodeGrain, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                cumulative_[i] = triangle_area(scene, scene.triangles[ids[i]]);
            }
        });
        std::partial_sum(cumulative_.begin(), cumulative_.end(), cumulative_.begin());
    }
    [[nodiscard]] bool usable() const {
        return !cumulative_.empty() && cumulative_.back() > 0.0 && std::isfinite(cumulative_.back());
    }
    [[nodiscard]] SurfacePoint pick(Pcg32& random) const {
        const double wanted = random.uniform() * cumulative_.back();
        const auto at = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, wanted);
        const uint id = ids_[static_cast<std::size_t>(at - cumulative_.begin())];
        const Triangle& triangle = scene_.triangles[id];
        const Vec3 v0 = scene_.vertices[triangle.v0].position;
        const Vec3 edge1 = scene_.vertices[triangle.v1].position - v0;
        const Vec3 edge2 = scene_.vertices[triangle.v2].position - v0;
        const float root = std::sqrt(random.uniform());
        const float v = root * random.uniform();
        const Vec3 normal = normalize(cross(edge1, edge2));
        const float off = triangle_stand_off(scene_, id, size_);
        return {v0 + edge1 * (1.0f - root) + edge2 * v + normal * off, normal};
    }

  private:
    const Scene& scene_;
    std::span<const uint> ids_;
    std::vector<double> cumulative_;
    Vec3 size_;  ///< of the scene's bounds, m
};

std::vector<TestRay> make_segments(const Surfaces& surfaces, std::size_t count) {
    std::vector<TestRay> segments;
    Pcg32 random(kSeed);
    for (std::size_t i = 0; surfaces.usable() && i < kTriesPerSegment * count && segments.size() < count;
         ++i) {
        const SurfacePoint from = surfaces.pick(random);
        const SurfacePoint to = surfaces.pick(random);
        const Vec3 direction = to.position - from.position;
        if (dot(direction, from.normal) > 0.0f && dot(direction, to.normal) < 0.0f) {
            segments.push_back(make_test_ray(from.position, direction, NEARLIGHT_SEGMENT_T_MIN));
        }
    }
    return segments;
}

/// Traces segments in a few parts, each with records of its own, and returns the sums.
std::vector<Records> survey(const Bvh& bvh, const Scene& scene, std::span<const uint> ids) {
    const std::vector<TestRay> segments = make_segments(
        Surfaces(scene, ids), std::clamp(ids.size() / kTrianglesPerSegment, kMinSegments, kMaxSegments));
    std::vector<Survey> parts(kSurveyParts);
    parallel_for(parts.size(), 1, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            parts[i] = Survey(bvh);
            for (std::size_t k = i; k < segments.size(); k += parts.size()) {
                parts[i].trace(segments[k]);
            }
        }
    });
    for (std::size_t i = 1; i < parts.size(); ++i) {
        parts.front().add(parts[i]);
    }
    return std::move(parts.front()).take();
}

/// The expected values of a ray that meets a box.
struct Expectation {
    double chance = 0.0;  ///< probability that the ray hits something in the box
    double cost = 0.0;
};

class Orderer {
  public:
    Orderer(Bvh& bvh, std::span<const Records> records) : bvh_(bvh), records_(records) {}

    Expectation order(uint reference, double area, int level = 0) {
        if (is_leaf(reference)) {
            return expect_leaf(reference, area);
        }
        BvhNode& node = bvh_.nodes[reference];
        const double left_area = Aabb{node.left_min, node.left_max}.half_area();
        const double right_area = Aabb{node.right_min, node.right_max}.half_area();
        Expectation first;
        Expectation second;
        invoke_at_level(
            level, [&] { first = blend(order(node.left, left_area, level + 1), records_[reference].left); },
            [&] { second = blend(order(node.right, right_area, level + 1), records_[reference].right); });
        double meets_first = share(left_area, area);
        double meets_second = share(right_area, area);
        if (second.chance * first.cost > first.chance * second.cost) {
            std::swap(node.left, node.right);
            std::swap(node.left_min, node.right_min);
            std::swap(node.left_max, node.right_max);
            std::swap(first, second);
            std::swap(meets_first, meets_second);
        }
        const double misses_first = 1.0 - meets_first * first.chance;
        return {1.0 - misses_first * (1.0 - meets_second * second.chance),
                1.0 + meets_first * first.cost + misses_first * meets_second * second.cost};
    }

  private:
    static double share(double part, double whole) { return part < whole ? part / whole : 1.0; }
    static Expectation blend(const Expectation& by_area, const Record& counted) {
        const double weight = kPrior + counted.visits;
        return {(kPrior * by_area.chance + counted.hits) / weight,
                (kPrior * by_area.cost + counted.cost) / weight};
    }
    /// A random line that meets a box meets a triangle in it with chance area ÷ half area of the box.
    [[nodiscard]] Expectation expect_leaf(uint leaf, double area) const {
        double covered = 0.0;
        for (uint i = leaf_first(leaf); i < leaf_first(leaf) + leaf_count(leaf); ++i) {
            covered += 0.5 * length(bvh_.triangles[i].normal);
        }
        return {share(covered, area), static_cast<double>(leaf_count(leaf))};
    }

    Bvh& bvh_;
    std::span<const Records> records_;
};

/// Puts the subtree of `index`, which has `count` nodes, from `place` on in depth-first order. `nodes` were
/// in that order before children changed sides, so of two inner children the lower index came first.
uint move_subtree(const std::vector<BvhNode>& nodes, uint index, uint count, uint place,
                  std::vector<BvhNode>& ordered, int level) {
    if (is_leaf(index)) {
        return index;
    }
    BvhNode node = nodes[index];
    uint left_count = is_leaf(node.left) ? 0 : count - 1;
    if (!is_leaf(node.left) && !is_leaf(node.right)) {
        left_count = node.left < node.right ? node.right - node.left : count - 1 - (node.left - node.right);
    }
    uint left = 0;
    uint right = 0;
    invoke_at_level(
        level, [&] { left = move_subtree(nodes, node.left, left_count, place + 1, ordered, level + 1); },
        [&] {
            right = move_subtree(nodes, node.right, count - 1 - left_count, place + 1 + left_count, ordered,
                                 level + 1);
        });
    node.left = left;
    node.right = right;
    ordered[place] = node;
    return place;
}

}  // namespace

void order_children(Bvh& bvh, const Scene& scene, std::span<const uint> ids) {
    const BvhNode& root = bvh.nodes.front();
    if (root.left == root.right) {
        return;
    }
    Aabb box{root.left_min, root.left_max};
    box.extend({root.right_min, root.right_max});
    std::vector<Records> records;
    std::vector<BvhNode> ordered;
    parallel_invoke([&] { records = survey(bvh, scene, ids); }, [&] { ordered.resize(bvh.nodes.size()); });
    Orderer(bvh, records).order(0, box.half_area());
    move_subtree(bvh.nodes, 0, static_cast<uint>(bvh.nodes.size()), 0, ordered, 0);
    bvh.nodes = std::move(ordered);
}

}  // namespace nearlight::core
