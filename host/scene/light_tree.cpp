// SPDX-License-Identifier: Apache-2.0
#include "host/scene/light_tree.h"

#include <algorithm>
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
    NormalCone cone;        ///< of where they face
    double cos_beam = 1.0;  ///< none shines farther than this angle from there
    double power = 0.0;

    void extend(const LightBounds& other) {
        box.extend(other.box);
        cone = cone_of_both(cone, other.cone);
        cos_beam = std::min(cos_beam, other.cos_beam);
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

LightBounds bounds_of_triangle(const Scene& scene, const Triangle& triangle, double flux) {
    LightBounds bounds;
    for (const uint vertex : {triangle.v0, triangle.v1, triangle.v2}) {
        bounds.box.extend(scene.vertices[vertex].position);
    }
    const Vec3 v0 = scene.vertices[triangle.v0].position;
    bounds.cone.axis = normalize(
        cross(scene.vertices[triangle.v1].position - v0, scene.vertices[triangle.v2].position - v0));
    bounds.cone.angle = 0.0;
    bounds.cos_beam = 0.0;
    bounds.power = flux;
    return bounds;
}

/// A sphere or cylinder, which shines to all sides.
LightBounds bounds_of_round_lamp(const Emitter& emitter, double flux) {
    LightBounds bounds;
    const Vec3 half_size = Vec3{1, 1, 1} * emitter.outer_radius;
    for (const Vec3 end : {emitter.position, emitter.position + emitter.direction * emitter.length}) {
        bounds.box.extend(end - half_size);
        bounds.box.extend(end + half_size);
    }
    bounds.cone = NormalCone::of({0, 0, 1}, std::numbers::pi);
    bounds.power = flux * (emitter.type == NEARLIGHT_EMITTER_SPHERE ? 0.25 : 1 / std::numbers::pi);
    return bounds;
}

/// The cosine of the angle from the axis within which a spot or projector shines.
double beam_limit(const Emitter& emitter) {
    if (emitter.type == NEARLIGHT_EMITTER_SPOT) {
        return std::cos(emitter.cutoff_angle);
    }
    // At the corner of an image, d·x_axis and d·y_axis are half of d·direction.
    const double slope = 0.5 * std::hypot(1.0 / length(emitter.x_axis), 1.0 / length(emitter.y_axis));
    return 1.0 / std::hypot(1.0, slope);
}

LightBounds bounds_of_point(const Emitter& emitter) {
    LightBounds bounds;
    bounds.box.extend(emitter.position);
    const bool shines_everywhere = emitter.type == NEARLIGHT_EMITTER_POINT;
    bounds.cone = shines_everywhere ? NormalCone::of({0, 0, 1}, std::numbers::pi)
                                    : NormalCone::of(emitter.direction, 0.0);
    bounds.cos_beam = shines_everywhere ? 1.0 : beam_limit(emitter);
    bounds.power = static_cast<double>(kPi) * luminance(emitter.radiance);
    return bounds;
}

/// A light's power in the tree is π times its greatest intensity, which is the flux of a triangle, but a
/// quarter of that of a sphere and 1/π of that of a cylinder, which shine to all sides. So lights that are
/// equally bright from their best side count alike.
TreeLight make_light(const Scene& scene, const Emitter& emitter, uint index) {
    const double flux = static_cast<double>(kPi) * emitter.area * luminance(emitter.radiance);
    TreeLight light;
    light.emitter = index;
    light.bounds = is_delta_light(emitter) ? bounds_of_point(emitter)
                   : emitter.type == NEARLIGHT_EMITTER_TRIANGLE
                       ? bounds_of_triangle(scene, scene.triangles[emitter.triangle], flux)
                       : bounds_of_round_lamp(emitter, flux);
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

/// The lights of one node: a part of those of its parent.
struct LightRange {
    std::size_t first = 0, end = 0;
    LightBounds bounds;

    [[nodiscard]] std::size_t count() const { return end - first; }
};

/// The most leaves of a tree with so many levels of nodes above them: the width to that power.
uint most_leaves(uint levels) {
    return levels == 0 ? 1 : NEARLIGHT_LIGHT_TREE_WIDTH * most_leaves(levels - 1);
}

/// The squared radius of the sphere around `center` that holds the box, with room for what kernels round.
float squared_radius_around(Vec3 center, const Aabb& box) {
    const Vec3 reach = max(box.max - center, center - box.min);
    return 1.0001f * dot(reach, reach);
}

void set_child(LightNode& node, std::size_t i, const LightBounds& bounds) {
    const Vec3 center = bounds.box.center();
    const Vec3 axis = bounds.cone.axis;
    for (int k = 0; k < 3; ++k) {
        node.center[k][i] = static_cast<float>(light_axis_component(center, k));
        node.axis[k][i] = static_cast<float>(light_axis_component(axis, k));
    }
    node.radius_squared[i] = squared_radius_around(center, bounds.box);
    // Rounding must not leave a light outside.
    node.cos_spread[i] = static_cast<float>(std::cos(std::min(bounds.cone.angle + 1e-4, std::numbers::pi)));
    node.cos_beam[i] = static_cast<float>(bounds.cos_beam);
    node.power[i] = static_cast<float>(bounds.power);
}

class LightTreeBuilder {
  public:
    LightTreeBuilder(std::vector<TreeLight>& lights, std::vector<Emitter>& emitters)
        : lights_(lights), emitters_(emitters) {}

    std::vector<LightNode> build() {
        add_node(range(0, lights_.size()), 0, 0);
        return std::move(nodes_);
    }

  private:
    uint add_node(const LightRange& lights, uint depth, uint way);
    uint add_leaf(const LightRange& light, uint way);
    [[nodiscard]] std::vector<LightRange> children_of(const LightRange& lights, uint depth);
    [[nodiscard]] LightRange range(std::size_t first, std::size_t end) const;
    [[nodiscard]] std::size_t best_part(const LightRange& lights);
    [[nodiscard]] std::size_t halve(const LightRange& lights);
    [[nodiscard]] LightSplit best_split(const LightRange& lights, const Aabb& centers) const;
    [[nodiscard]] Aabb centers_of(const LightRange& lights) const;

    [[nodiscard]] std::span<TreeLight> in(const LightRange& lights) const {
        return std::span(lights_).subspan(lights.first, lights.count());
    }

    std::vector<TreeLight>& lights_;
    std::vector<Emitter>& emitters_;
    std::vector<LightNode> nodes_;
};

LightRange LightTreeBuilder::range(std::size_t first, std::size_t end) const {
    LightRange range{first, end, {}};
    for (std::size_t i = first; i < end; ++i) {
        range.bounds.extend(lights_[i].bounds);
    }
    return range;
}

Aabb LightTreeBuilder::centers_of(const LightRange& lights) const {
    Aabb centers;
    for (const TreeLight& light : in(lights)) {
        centers.extend(light.center);
    }
    return centers;
}

LightSplit LightTreeBuilder::best_split(const LightRange& lights, const Aabb& centers) const {
    LightSplit best;
    const Vec3 size = lights.bounds.box.size();
    for (int axis = 0; axis < 3; ++axis) {
        const double extent = light_axis_component(size, axis);
        if (!(light_axis_component(centers.size(), axis) > 0.0)) {
            continue;
        }
        std::array<LightBounds, kBins> bins;
        const LightBins mapping(centers, axis);
        for (const TreeLight& light : in(lights)) {
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

/// Orders the lights so that those of the best split's first part stand before the returned index.
std::size_t LightTreeBuilder::best_part(const LightRange& lights) {
    // Two lights have only halves.
    const Aabb centers = centers_of(lights);
    const LightSplit split = lights.count() == 2 ? LightSplit{} : best_split(lights, centers);
    if (split.axis >= 0) {
        const LightBins mapping(centers, split.axis);
        const std::span<TreeLight> parted = in(lights);
        const auto behind = std::partition(parted.begin(), parted.end(), [&](const TreeLight& light) {
            return mapping.of(light) < split.border;
        });
        if (behind != parted.begin() && behind != parted.end()) {
            return lights.first + static_cast<std::size_t>(behind - parted.begin());
        }
    }
    return halve(lights);
}

/// Orders the lights along the longest axis of their box, so that one half stands before the returned index.
std::size_t LightTreeBuilder::halve(const LightRange& lights) {
    const Vec3 size = centers_of(lights).size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::span<TreeLight> halved = in(lights);
    const auto middle = static_cast<std::ptrdiff_t>(lights.count() / 2);
    std::ranges::nth_element(halved, halved.begin() + middle, {}, [&](const TreeLight& light) {
        return light_axis_component(light.center, axis);
    });
    return lights.first + lights.count() / 2;
}

/// Parts the lights until there are as many parts as a node may have, or each is one light. The part that
/// costs most is parted next, and the largest is halved where the tree would else become too deep.
std::vector<LightRange> LightTreeBuilder::children_of(const LightRange& lights, uint depth) {
    const bool must_halve = lights.count() > most_leaves(NEARLIGHT_MAX_LIGHT_TREE_DEPTH - depth - 1);
    std::vector<LightRange> parts{lights};
    while (parts.size() < NEARLIGHT_LIGHT_TREE_WIDTH && parts.size() < lights.count()) {
        const auto next = std::ranges::max_element(parts, {}, [&](const LightRange& part) {
            return part.count() == 1 ? -1.0
                   : must_halve      ? static_cast<double>(part.count())
                                     : part.bounds.cost();
        });
        const std::size_t middle = must_halve ? halve(*next) : best_part(*next);
        const LightRange second = range(middle, next->end);
        *next = range(next->first, middle);
        parts.push_back(second);
    }
    return parts;
}

/// Adds a node of these lights, to which `way` leads through `depth` others, and all below it. Returns its
/// index.
uint LightTreeBuilder::add_node(const LightRange& lights, uint depth, uint way) {
    const std::size_t index = nodes_.size();
    nodes_.emplace_back();
    const std::vector<LightRange> children = children_of(lights, depth);
    for (uint i = 0; i < children.size(); ++i) {
        const uint way_on = way + i * most_leaves(depth);
        const uint child = children[i].count() == 1 ? add_leaf(children[i], way_on)
                                                    : add_node(children[i], depth + 1, way_on);
        set_child(nodes_[index], i, children[i].bounds);
        nodes_[index].child[i] = child;
    }
    return static_cast<uint>(index);
}

/// Notes the way to the only light of the range. Returns how a node refers to it.
uint LightTreeBuilder::add_leaf(const LightRange& light, uint way) {
    const uint emitter = lights_[light.first].emitter;
    emitters_[emitter].tree_way = way;
    return NEARLIGHT_LEAF_BIT | emitter;
}

}  // namespace

std::vector<LightNode> build_light_tree(const Scene& scene, std::vector<Emitter>& emitters, uint first,
                                        uint end) {
    std::vector<TreeLight> lights;
    for (uint i = first; i < end; ++i) {
        lights.push_back(make_light(scene, emitters[i], i));
    }
    return lights.empty() ? std::vector<LightNode>{} : LightTreeBuilder(lights, emitters).build();
}

}  // namespace nearlight::core
