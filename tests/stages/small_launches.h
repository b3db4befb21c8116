// SPDX-License-Identifier: Apache-2.0
// A scene that has all kinds of lights and most kinds of surfaces, and a fixture that launches stages on it
// with a handful of work-items each, for simulators of devices, which are a million times slower
// (scripts/oclgrind). Other tests compare with oracles; these compare the two trees that rays go through,
// which give the same hits.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "host/reference/gather_workload.h"
#include "host/scene/material_model.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core::test {

/// A quad of two triangles that faces the camera, of which the picture shows three in a row.
inline void add_panel(Scene& scene, int column, const Material& material) {
    using namespace small_scenes;
    add_quad(scene, {-0.9f + 0.6f * static_cast<float>(column), -0.6f, 0.8f}, {0, 1.0f, 0}, {0.6f, 0, 0},
             add_material(scene, material));
}

/// A room without a front: panels of coats, glass and a masked map before walls, and lights of all kinds.
inline Scene bright_corner() {
    using namespace small_scenes;
    Scene scene;
    const int bitmap = add_small_bitmap(scene);
    Material painted = lambertian({0.7f, 0.6f, 0.5f});
    painted.reflectance.texture = bitmap;
    add_quad(scene, {-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, add_material(scene, painted));
    add_quad(scene, {-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, add_material(scene, lambertian({0.6f, 0.6f, 0.6f})));
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{3, 3, 3});
    add_quad(scene, {-0.2f, 0.9f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}, add_material(scene, lamp));
    add_panel(scene, 0, principled_material(scene, 1.5));
    add_panel(scene, 1, dielectric_material(1.5));
    const uint metal = add_material(scene, conductor_material({0.2f, 0.9f, 1.1f}, {3.9f, 2.4f, 2.2f}));
    const uint mapped = add_material(scene, normal_map_material(textured(bitmap), metal));
    add_panel(scene, 2, mask_material(parameter_of(Vec3{0.5f, 0.5f, 0.5f}), mapped));
    add_sphere_lamp(scene, {0.6f, 0.4f, 0}, 0.1f, {2, 2, 2});
    add_cylinder_lamp(scene, {-0.6f, 0.4f, 0}, 90, 0.05f, 0.3f, {2, 2, 2});
    add_point_light(scene, {0, 0.3f, -0.5f}, {1, 1, 1});
    add_directional_light(scene, {0.1f, -1, 0.2f}, {1, 1, 1});
    add_projector(scene, {0, 0.5f, -0.8f}, {0, -1, 0.5f}, 0.3f, 0.3f, {1, 1, 1}, bitmap);
    scene.environment = patterned_map(4, 2);
    for (Vertex& vertex : scene.vertices) {
        vertex.u = vertex.position.x;
        vertex.v = vertex.position.y + vertex.position.z;
    }
    set_camera(scene, {0, 0, -0.9}, {0, -0.2, 1}, 70);
    return scene;
}

/// What a check compares between trees: numbers, all of which must be finite, and some of which not 0.
using Numbers = std::vector<float>;

inline Numbers numbers_of(const std::vector<IrradiancePacket>& light) {
    Numbers numbers;
    for (const IrradiancePacket& packet : light) {
        numbers.insert(numbers.end(), packet.r, packet.r + 3 * NEARLIGHT_PACKET_SIZE);
    }
    return numbers;
}

class SmallLaunchesTest : public DeviceTest {
  protected:
    /// Runs `launch(device)` with both trees of single rays.
    template <typename Launch>
    void expect_same_of_both_trees(const Launch& launch) {
        Numbers of_wide_tree;
        on_each_ray_tree([&](Device& device) {
            const Numbers found = launch(device);
            double sum = 0;
            for (const float number : found) {
                sum += std::abs(number);
            }
            EXPECT_TRUE(std::isfinite(sum));
            EXPECT_GT(sum, 0);
            if (device.has_wide_rays()) {
                of_wide_tree = found;
            } else if (!of_wide_tree.empty()) {
                expect_near(found, of_wide_tree);
            }
        });
    }

  private:
    static void expect_near(const Numbers& found, const Numbers& expected) {
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_NEAR(found[i], expected[i], 1e-4f * (1 + std::abs(expected[i]))) << "number " << i;
        }
    }
};

/// One packet of receivers on the scene, or several.
inline std::vector<ReceiverPacket> few_receivers(const SceneOnDevice& scene, int width, int height) {
    return make_camera_receivers(scene.scene, scene.bvh, width, height);
}

}  // namespace nearlight::core::test
