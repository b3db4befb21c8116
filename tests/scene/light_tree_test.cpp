// SPDX-License-Identifier: Apache-2.0
#include "host/scene/light_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>
#include <numeric>
#include <span>

#include "host/base/random.h"
#include "host/scene/emitters.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

/// Emissive triangles whose corners are near the positions, some of them all in one place.
Scene many_lamps(std::size_t count, const std::function<Vec3(std::size_t)>& position) {
    Scene scene;
    scene.materials.resize(1, Material{});
    scene.materials[0].emission = {{1, 2, 3}, -1};
    Pcg32 random(3);
    for (std::size_t i = 0; i < count; ++i) {
        const auto first = static_cast<uint>(scene.vertices.size());
        for (int corner = 0; corner < 3; ++corner) {
            const float x = random.uniform();
            const float y = random.uniform();
            scene.vertices.push_back({position(i) + Vec3{x, y, random.uniform()} * 0.1f, 0, {0, 0, 0}, 0});
        }
        scene.triangles.push_back({first, first + 1, first + 2, 0});
    }
    return scene;
}

/// The bounds that a node holds of one of its children.
struct ChildBounds {
    Vec3 center, axis;
    float radius_squared, cos_spread, cos_beam;

    ChildBounds(const LightNode& node, std::size_t i)
        : center{node.center[0][i], node.center[1][i], node.center[2][i]},
          axis{node.axis[0][i], node.axis[1][i], node.axis[2][i]},
          radius_squared(node.radius_squared[i]),
          cos_spread(node.cos_spread[i]),
          cos_beam(node.cos_beam[i]) {}
    [[nodiscard]] bool hold(Vec3 p) const { return dot(p - center, p - center) <= radius_squared; }
};

/// Expects all triangles of the light within the sphere, and their normals within the cone.
void expect_triangles_inside(const Scene& scene, const Emitter& emitter, const ChildBounds& bounds) {
    for (uint i = 0; i < emitter.triangle_count; ++i) {
        const Triangle& triangle = scene.triangles[emitter.triangle + i];
        const Vec3 v0 = scene.vertices[triangle.v0].position;
        const Vec3 normal = normalize(
            cross(scene.vertices[triangle.v1].position - v0, scene.vertices[triangle.v2].position - v0));
        for (const uint vertex : {triangle.v0, triangle.v1, triangle.v2}) {
            ASSERT_TRUE(bounds.hold(scene.vertices[vertex].position));
        }
        ASSERT_GE(dot(normal, bounds.axis), bounds.cos_spread - 1e-6f);
    }
}

/// Expects the lamp without a surface in the sphere, and all of its beam within the cone.
void expect_beam_inside(const Emitter& emitter, const ChildBounds& bounds) {
    ASSERT_TRUE(bounds.hold(emitter.position));
    const double spread = std::acos(std::clamp(bounds.cos_spread, -1.0f, 1.0f));
    if (emitter.type == NEARLIGHT_EMITTER_POINT) {
        ASSERT_NEAR(spread, std::numbers::pi, 1e-3);
    } else {
        const double off_axis = std::acos(std::clamp(dot(emitter.direction, bounds.axis), -1.0f, 1.0f));
        ASSERT_LE(off_axis, spread + 1e-3);
        ASSERT_LE(bounds.cos_beam, std::cos(emitter.cutoff_angle) + 1e-6);
    }
}

/// The power of all lights below the node.
double power_below(const LightNode& node) {
    return std::accumulate(std::begin(node.power), std::end(node.power), 0.0);
}

/// Expects as many children as have power, one behind the other, and returns their number.
std::size_t expect_children_in_front(const LightNode& node) {
    const std::span power(node.power);
    const auto behind = std::ranges::find(power, 0.0f);
    EXPECT_TRUE(std::ranges::all_of(behind, power.end(), [](float p) { return p == 0.0f; }));
    return static_cast<std::size_t>(behind - power.begin());
}

/// The share of a light's power that the tree counts.
double part_in_tree(const Emitter& emitter) {
    switch (emitter.type) {
        case NEARLIGHT_EMITTER_SPHERE:
            return 0.25;
        case NEARLIGHT_EMITTER_CYLINDER:
            return 1 / std::numbers::pi;
        default:
            return 1.0;
    }
}

/// Walks down to every leaf by the way that its emitter has, and checks the bounds on the way.
void expect_good_tree(const Scene& scene) {
    const EmitterTable table = build_emitter_table(scene);
    const auto in_tree =
        std::span(table.emitters).subspan(table.tree_first, table.tree_end - table.tree_first);
    ASSERT_FALSE(in_tree.empty());
    for (uint index = table.tree_first; index < table.tree_end; ++index) {
        const Emitter& emitter = table.emitters[index];
        uint way = emitter.tree_way;
        uint node = 0;
        uint depth = 0;
        for (; !(node & NEARLIGHT_LEAF_BIT); ++depth) {
            const LightNode& at = table.light_tree[node];
            const uint next = way % NEARLIGHT_LIGHT_TREE_WIDTH;
            ASSERT_LT(next, expect_children_in_front(at));
            const ChildBounds bounds(at, next);
            if (is_delta_light(emitter)) {
                expect_beam_inside(emitter, bounds);
            } else {
                expect_triangles_inside(scene, emitter, bounds);
            }
            node = at.child[next];
            if (!(node & NEARLIGHT_LEAF_BIT)) {
                ASSERT_NEAR(at.power[next], power_below(table.light_tree[node]), 1e-4 * at.power[next]);
            }
            way /= NEARLIGHT_LIGHT_TREE_WIDTH;
        }
        ASSERT_LE(depth, NEARLIGHT_MAX_LIGHT_TREE_DEPTH);
        ASSERT_EQ(node & ~NEARLIGHT_LEAF_BIT, index);
    }
    double power = 0;
    for (const Emitter& emitter : in_tree) {
        power += is_delta_light(emitter)
                     ? std::numbers::pi * luminance(emitter.radiance)
                     : part_in_tree(emitter) * std::numbers::pi * emitter.area * luminance(emitter.radiance);
    }
    EXPECT_NEAR(power_below(table.light_tree[0]), power, 1e-4 * power);
}

TEST(LightTree, EveryLightIsFoundWithinItsBounds) {
    Pcg32 random(4);
    expect_good_tree(many_lamps(1000, [&](std::size_t) {
        const float x = random.uniform();
        const float y = random.uniform();
        return Vec3{x, y, random.uniform()} * 10.0f;
    }));
    expect_good_tree(many_lamps(9, [](std::size_t i) { return Vec3{static_cast<float>(i), 0, 0}; }));
}

/// Lights at distances that double would have a tree of seven lights a level, far deeper than it may be.
TEST(LightTree, NoTreeIsDeeperThanAWayCanTell) {
    expect_good_tree(many_lamps(400, [](std::size_t i) {
        return Vec3{std::exp2(static_cast<float>(i) / 4.0f - 20.0f), 0, 0};
    }));
    expect_good_tree(many_lamps(5000, [](std::size_t) { return Vec3{1, 2, 3}; }));
}

/// A sphere or cylinder is one leaf, however many triangles stand for it.
TEST(LightTree, RoundLightsAreLeavesBesideTriangles) {
    Scene scene = many_lamps(20, [](std::size_t i) { return Vec3{static_cast<float>(i), 0, 0}; });
    for (int i = 0; i < 4; ++i) {
        small_scenes::add_sphere_lamp(scene, {3.0f * static_cast<float>(i), 2, 1}, 0.3f, {3, 3, 3});
    }
    small_scenes::add_cylinder_lamp(scene, {1, 2, 3}, 70, 0.2f, 4, {2, 2, 2});
    EXPECT_EQ(build_emitter_table(scene).emitters.size(), 25u);
    expect_good_tree(scene);
}

TEST(LightTree, OneLightHasNone) {
    const auto tree_of = [](std::size_t count) {
        return build_emitter_table(many_lamps(count, [](std::size_t) { return Vec3{0, 0, 0}; })).light_tree;
    };
    EXPECT_TRUE(tree_of(0).empty());
    EXPECT_TRUE(tree_of(1).empty());
    EXPECT_EQ(tree_of(2).size(), 1u);
}

/// Points, spots and directional lights by turns, and two area lights.
Scene lamps_without_surface(std::size_t count) {
    Scene scene = many_lamps(2, [](std::size_t i) { return Vec3{static_cast<float>(i), 5, 0}; });
    for (std::size_t i = 0; i < count; ++i) {
        Emitter emitter{};
        emitter.type =
            std::array{NEARLIGHT_EMITTER_POINT, NEARLIGHT_EMITTER_SPOT, NEARLIGHT_EMITTER_DIRECTIONAL}[i % 3];
        emitter.position = {static_cast<float>(i % 7), static_cast<float>(i % 5), 1};
        emitter.direction = normalize(Vec3{static_cast<float>(i % 4), 1, 2});
        emitter.radiance = {1, 2, static_cast<float>(i)};
        emitter.beam_angle = 0.2f;
        emitter.cutoff_angle = 0.5f;
        scene.delta_emitters.push_back(emitter);
    }
    return scene;
}

/// Lamps without a surface are all summed where they are few, and have a place in the tree where they are
/// many. Directional lights have none.
TEST(LightTree, ManyPointsAndSpotsBelongToIt) {
    const EmitterTable few = build_emitter_table(lamps_without_surface(NEARLIGHT_MAX_EXACT_LIGHTS));
    EXPECT_EQ(few.tree_first, NEARLIGHT_MAX_EXACT_LIGHTS);
    EXPECT_EQ(few.tree_end, NEARLIGHT_MAX_EXACT_LIGHTS + 2);

    const Scene scene = lamps_without_surface(300);
    const EmitterTable many = build_emitter_table(scene);
    EXPECT_EQ(many.tree_first, 100u);
    EXPECT_EQ(many.tree_end, 302u);
    for (uint i = 0; i < many.tree_first; ++i) {
        EXPECT_EQ(many.emitters[i].type, NEARLIGHT_EMITTER_DIRECTIONAL);
    }
    expect_good_tree(scene);
}

}  // namespace
}  // namespace nearlight::core
