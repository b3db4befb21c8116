// SPDX-License-Identifier: Apache-2.0
#include "host/scene/light_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

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

/// Expects all triangles of the light within the node's box, and their normals within its cone.
void expect_inside(const Scene& scene, const Emitter& emitter, const LightNode& node) {
    for (uint i = 0; i < emitter.triangle_count; ++i) {
        const Triangle& triangle = scene.triangles[emitter.triangle + i];
        const Vec3 v0 = scene.vertices[triangle.v0].position;
        const Vec3 normal = normalize(
            cross(scene.vertices[triangle.v1].position - v0, scene.vertices[triangle.v2].position - v0));
        for (const uint vertex : {triangle.v0, triangle.v1, triangle.v2}) {
            const Vec3 p = scene.vertices[vertex].position;
            ASSERT_EQ(min(p, node.low), node.low);
            ASSERT_EQ(max(p, node.high), node.high);
        }
        ASSERT_GE(dot(normal, node.axis), node.cos_spread - 1e-6f);
    }
}

/// Walks down to every leaf by the way that its emitter has, and checks the bounds on the way.
void expect_good_tree(const Scene& scene) {
    const EmitterTable table = build_emitter_table(scene);
    ASSERT_EQ(table.light_tree.size(), 2 * table.emitters.size() - 1);
    for (uint index = 0; index < table.emitters.size(); ++index) {
        const Emitter& emitter = table.emitters[index];
        uint way = emitter.tree_way;
        std::size_t node = 0;
        int depth = 0;
        for (;; ++depth) {
            const LightNode& at = table.light_tree[node];
            expect_inside(scene, emitter, at);
            if (at.second_child == 0) {
                break;
            }
            ASSERT_NEAR(at.power, table.light_tree[node + 1].power + table.light_tree[at.second_child].power,
                        1e-4f * at.power);
            node = (way & 1u) != 0 ? at.second_child : node + 1;
            way >>= 1;
        }
        ASSERT_LE(depth, NEARLIGHT_MAX_LIGHT_TREE_DEPTH);
        ASSERT_EQ(table.light_tree[node].emitter, index);
    }
    double power = 0;
    for (const Emitter& emitter : table.emitters) {
        const double part = emitter.type == NEARLIGHT_EMITTER_SPHERE     ? 0.25
                            : emitter.type == NEARLIGHT_EMITTER_CYLINDER ? 1 / std::numbers::pi
                                                                         : 1.0;
        power += part * emitter.probability * table.total_power;
    }
    EXPECT_NEAR(table.light_tree[0].power, power, 1e-4 * power);
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

/// Lights at distances that double have a tree of one light a level, until there are no bits left.
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

TEST(LightTree, AFewLightsHaveNone) {
    const auto tree_of = [](std::size_t count) {
        return build_emitter_table(many_lamps(count, [](std::size_t) { return Vec3{0, 0, 0}; })).light_tree;
    };
    EXPECT_TRUE(tree_of(0).empty());
    EXPECT_TRUE(tree_of(kMinTreeLights - 1).empty());
    EXPECT_FALSE(tree_of(kMinTreeLights).empty());
}

}  // namespace
}  // namespace nearlight::core
