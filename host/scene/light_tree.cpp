// SPDX-License-Identifier: Apache-2.0
#include "host/scene/light_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <span>

#include "host/scene/emitters.h"

namespace nearlight::core {
namespace {

constexpr double kHalfPi = std::numbers::pi / 2;
constexpr int kBins = 12;

double light_axis_component(Vec3 v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// All directions within `angle` (radians) of an axis; empty if it is negative.
struct NormalCone {
    Vec3 axis{0, 0, 1};
    double angle = -1.0;
    double cosine = 1.0;  ///< of the angle

    static NormalCone of(Vec3 axis, double angle) { return {axis, angle, std::cos(angle)}; }
};

/// A cone that contains both.
NormalCone cone_of_both(const NormalCone& a, const NormalCone& b) {
    if (a.angle < 0.0 || b.angle < 0.0) {
        return a.angle < 0.0 ? b : a;
    }
    const NormalCone& wide = a.angle > b.angle ? a : b;
    const NormalCone& narrow = a.angle > b.angle ? b : a;
    const double cosine = std::clamp(static_cast<double>(dot(a.axis, b.axis)), -1.0, 1.0);
    // Most lights are flat, and their normals mostly lie inside already, which a comparison tells.
    if (wide.angle >= std::numbers::pi || (narrow.angle == 0.0 && cosine >= wide.cosine)) {
        return wide;
    }
    const double between = std::acos(cosine);
    if (std::min(between + narrow.angle, std::numbers::pi) <= wide.angle) {
        return wide;
    }
    const double angle = 0.5 * (wide.angle + between + narrow.angle);
    const Vec3 sideways = narrow.axis - wide.axis * dot(wide.axis, narrow.axis);
    if (angle >= std::numbers::pi || !(length(sideways) > 1e-6f)) {
        return NormalCone::of(wide.axis, std::numbers::pi);
    }
    const double turn = angle - wide.angle;
    return NormalCone::of(normalize(wide.axis * static_cast<float>(std::cos(turn)) +
                                    normalize(sideways) * static_cast<float>(std::sin(turn))),
                          angle);
}

/// What is known of a set of lights.
struct LightBounds {
    Aabb box;
    NormalCone cone;
    double power = 0.0;

    void extend(const LightBounds& other) {
        box.extend(other.box);
        cone = cone_of_both(cone, other.cone);
        power += other.power;
    }
    /// The cost of a node with these lights: its power, the area of its box, and the solid angle into which
    /// it may send light, weighted by the cosine of the angle beyond the cone. With the cone's angle o and
    /// w = min(o + π/2, π), that is 2π(1 − cos o) + π/2·(2w·sin o − cos(o − 2w) − 2o·sin o + cos o).
    [[nodiscard]] double cost() const {
        const double sine = std::sqrt(std::max(0.0, 1.0 - cone.cosine * cone.cosine));
        const double beyond = cone.angle <= kHalfPi ? 2.0 * (kHalfPi * sine + cone.cosine)
                                                    : 2.0 * (std::numbers::pi - cone.angle) * sine;
        const double orientation = 2 * std::numbers::pi * (1 - cone.cosine) + kHalfPi * beyond;
        const Vec3 size = box.size();
        // A line has no area but may be split, too.
        const double area = static_cast<double>(box.half_area()) +
                            1e-3 * static_cast<double>(max_component(size)) * max_component(size);
        return power * orientation * area;
    }
};

struct TreeLight {
    LightBounds bounds;
    Vec3 center{};
    uint emitter = 0;  ///< index into the table
};

/// A light's power in the tree is π times its greatest intensity, which is the flux of a triangle, but a
/// quarter of that of a sphere and 1/π of that of a cylinder, which shine to all sides. So lights that are
/// equally bright from their best side count alike.
TreeLight make_light(const Scene& scene, const Emitter& emitter, uint index) {
    TreeLight light;
    light.emitter = index;
    const double flux = static_cast<double>(kPi) * emitter.area * luminance(emitter.radiance);
    if (emitter.type != NEARLIGHT_EMITTER_TRIANGLE) {
        const Vec3 half_size = Vec3{1, 1, 1} * emitter.outer_radius;
        for (const Vec3 end : {emitter.position, emitter.position + emitter.direction * emitter.length}) {
            light.bounds.box.extend(end - half_size);
            light.bounds.box.extend(end + half_size);
        }
        light.bounds.cone = NormalCone::of({0, 0, 1}, std::numbers::pi);
        light.bounds.power = flux * (emitter.type == NEARLIGHT_EMITTER_SPHERE ? 0.25 : 1 / std::numbers::pi);
    } else {
        const Triangle& triangle = scene.triangles[emitter.triangle];
        for (const uint vertex : {triangle.v0, triangle.v1, triangle.v2}) {
            light.bounds.box.extend(scene.vertices[vertex].position);
        }
        const Vec3 v0 = scene.vertices[triangle.v0].position;
        light.bounds.cone.axis = normalize(
            cross(scene.vertices[triangle.v1].position - v0, scene.vertices[triangle.v2].position - v0));
        light.bounds.cone.angle = 0.0;
        light.bounds.power = flux;
    }
    light.center = light.bounds.box.center();
    return light;
}

/// Bins of equal width along an axis, to which lights belong by their centres.
class LightBins {
  public:
    LightBins(const Aabb& centers, int axis)
        : axis_(axis),
          low_(light_axis_component(centers.min, axis)),
          scale_(kBins / (light_axis_component(centers.max, axis) - low_)) {}
    [[nodiscard]] std::size_t of(const TreeLight& light) const {
        const double place = (light_axis_component(light.center, axis_) - low_) * scale_;
        return static_cast<std::size_t>(std::clamp(static_cast<int>(place), 0, kBins - 1));
    }

  private:
    int axis_;
    double low_, scale_;
};

/// Where the lights of a node are parted: those before a border between bins along an axis.
struct LightSplit {
    int axis = -1;  ///< −1: no split was found
    std::size_t border = 0;
    double cost = kInfinity;
};

class LightTreeBuilder {
  public:
    LightTreeBuilder(std::vector<TreeLight>& lights, std::vector<Emitter>& emitters)
        : lights_(lights), emitters_(emitters) {
        nodes_.reserve(2 * lights.size());
    }

    std::vector<LightNode> build() {
        add_node(0, lights_.size(), 0, 0);
        return std::move(nodes_);
    }

  private:
    void add_node(std::size_t first, std::size_t end, int depth, uint way);
    std::size_t part(std::size_t first, std::size_t end, const LightBounds& bounds, int depth);
    [[nodiscard]] LightSplit best_split(std::span<const TreeLight> lights, const Aabb& centers,
                                        const LightBounds& bounds) const;

    std::vector<TreeLight>& lights_;
    std::vector<Emitter>& emitters_;
    std::vector<LightNode> nodes_;
};

LightSplit LightTreeBuilder::best_split(std::span<const TreeLight> lights, const Aabb& centers,
                                        const LightBounds& bounds) const {
    LightSplit best;
    const Vec3 size = bounds.box.size();
    for (int axis = 0; axis < 3; ++axis) {
        const double extent = light_axis_component(size, axis);
        if (!(light_axis_component(centers.size(), axis) > 0.0)) {
            continue;
        }
        std::array<LightBounds, kBins> bins;
        const LightBins mapping(centers, axis);
        for (const TreeLight& light : lights) {
            bins[mapping.of(light)].extend(light.bounds);
        }
        // Thin boxes, which splits along short axes leave, cost more.
        const double thinness = max_component(size) / std::max(extent, 1e-20);
        std::array<double, kBins> behind{};
        LightBounds sum;
        for (std::size_t i = kBins - 1; i > 0; --i) {
            sum.extend(bins[i]);
            behind[i] = sum.power > 0.0 ? sum.cost() : -1.0;
        }
        sum = {};
        for (std::size_t i = 1; i < kBins; ++i) {
            sum.extend(bins[i - 1]);
            const double cost = thinness * (sum.cost() + behind[i]);
            if (sum.power > 0.0 && behind[i] >= 0.0 && cost < best.cost) {
                best = {axis, i, cost};
            }
        }
    }
    return best;
}

/// Orders the lights so that those of the first child stand before the returned index.
std::size_t LightTreeBuilder::part(std::size_t first, std::size_t end, const LightBounds& bounds, int depth) {
    const std::size_t count = end - first;
    const auto begin = lights_.begin() + static_cast<std::ptrdiff_t>(first);
    const auto behind = lights_.begin() + static_cast<std::ptrdiff_t>(end);
    Aabb centers;
    for (auto light = begin; light != behind; ++light) {
        centers.extend(light->center);
    }
    // Two lights have only halves. Where halves would just fit into the depth that remains, they are taken.
    const bool must_halve = count == 2 || depth + std::bit_width(count - 1) >= NEARLIGHT_MAX_LIGHT_TREE_DEPTH;
    const LightSplit split = must_halve ? LightSplit{} : best_split({begin, behind}, centers, bounds);
    if (split.axis >= 0) {
        const LightBins mapping(centers, split.axis);
        const auto middle = std::partition(
            begin, behind, [&](const TreeLight& light) { return mapping.of(light) < split.border; });
        if (middle != begin && middle != behind) {
            return static_cast<std::size_t>(middle - lights_.begin());
        }
    }
    const Vec3 size = centers.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto half = begin + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(begin, half, behind, [&](const TreeLight& a, const TreeLight& b) {
        return light_axis_component(a.center, axis) < light_axis_component(b.center, axis);
    });
    return first + count / 2;
}

void LightTreeBuilder::add_node(std::size_t first, std::size_t end, int depth, uint way) {
    LightBounds bounds;
    for (std::size_t i = first; i < end; ++i) {
        bounds.extend(lights_[i].bounds);
    }
    LightNode node{};
    node.low = bounds.box.min;
    node.high = bounds.box.max;
    node.power = static_cast<float>(bounds.power);
    node.axis = bounds.cone.axis;
    // Rounding must not leave a light outside.
    node.cos_spread = static_cast<float>(std::cos(std::min(bounds.cone.angle + 1e-4, std::numbers::pi)));
    const std::size_t place = nodes_.size();
    nodes_.push_back(node);
    if (end - first == 1) {
        nodes_[place].emitter = lights_[first].emitter;
        emitters_[lights_[first].emitter].tree_way = way;
        return;
    }
    const std::size_t middle = part(first, end, bounds, depth);
    add_node(first, middle, depth + 1, way);
    nodes_[place].second_child = static_cast<uint>(nodes_.size());
    add_node(middle, end, depth + 1, way | (1u << depth));
}

}  // namespace

std::vector<LightNode> build_light_tree(const Scene& scene, std::vector<Emitter>& emitters) {
    std::vector<TreeLight> lights;
    for (std::size_t i = 0; i < emitters.size(); ++i) {
        if (is_area_light(emitters[i])) {
            lights.push_back(make_light(scene, emitters[i], static_cast<uint>(i)));
        }
    }
    return lights.size() < kMinTreeLights ? std::vector<LightNode>{}
                                          : LightTreeBuilder(lights, emitters).build();
}

}  // namespace nearlight::core
