// SPDX-License-Identifier: Apache-2.0
#include "host/stages/light_visibility.h"

#include <numeric>

#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

class LightVisibilityTest : public test::DeviceTest {};

/// Asks about the triangles `ids`. The entries of others are 7 at first.
std::vector<uint> selected(Device& device, const Scene& scene, const std::vector<uint>& ids) {
    const test::SceneOnDevice on_device(device, scene);
    std::vector<uint> flags(scene.triangles.size(), 7);
    for (const uint id : ids) {
        flags[id] = 0;
    }
    Buffer<uint> buffer(device, flags);
    LightVisibility(device).run(on_device.buffers, Buffer<uint>(device, ids), ids.size(), 3, buffer);
    return buffer.download();
}

/// Quads 0 to 3 are a floor in the light, one in the shadow of quad 3, one that turns its back to the light,
/// and a roof.
Scene three_floors(bool two_sided) {
    Scene scene;
    const Material material = lambertian({0.5f, 0.5f, 0.5f});
    const uint grey = two_sided ? add_two_sided(scene, material) : add_material(scene, material);
    add_quad(scene, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}, grey);
    add_quad(scene, {5, 0, 0}, {0, 0, 1}, {1, 0, 0}, grey);
    add_quad(scene, {0, 0, 5}, {1, 0, 0}, {0, 0, 1}, grey);  // faces down
    add_quad(scene, {4, 1, -1}, {0, 0, 3}, {3, 0, 0}, grey);
    return scene;
}

TEST_F(LightVisibilityTest, WhatTheLightReachesIsSelected) {
    on_each_device([](Device& device) {
        for (const bool two_sided : {false, true}) {
            Scene scene = three_floors(two_sided);
            add_point_light(scene, {5.5f, 3, 0.5f}, {1, 1, 1});
            const uint back = two_sided ? 1 : 0;
            EXPECT_EQ(selected(device, scene, {0, 1, 2, 3, 4, 5, 6, 7}),
                      (std::vector<uint>{1, 1, 0, 0, back, back, 1, 1}));
            EXPECT_EQ(selected(device, scene, {0, 2}), (std::vector<uint>{1, 7, 0, 7, 7, 7, 7, 7}));
        }
    });
}

TEST_F(LightVisibilityTest, OneOfManyLightsIsEnough) {
    on_each_device([](Device& device) {
        for (const int pairs : {1, 3}) {  // two lights are asked one by one, six are not
            Scene scene = three_floors(false);
            for (int i = 0; i < pairs; ++i) {
                add_point_light(scene, {5.5f, 3, 0.5f}, {1, 1, 1});
                add_point_light(scene, {5.5f, 0.5f, 0.5f}, {1, 1, 1});  // below the roof of quad 3
            }
            EXPECT_EQ(selected(device, scene, {0, 1, 2, 3, 6, 7}),
                      (std::vector<uint>{1, 1, 1, 1, 7, 7, 1, 1}));
        }
    });
}

TEST_F(LightVisibilityTest, AreaLightsShineOnWhatTheyFace) {
    on_each_device([](Device& device) {
        for (const bool faces_down : {true, false}) {
            Scene scene = three_floors(false);
            Material lamp = lambertian({0, 0, 0});
            lamp.emission = parameter_of(Vec3{1, 1, 1});
            const uint material = add_material(scene, lamp);
            add_quad(scene, {0, 2, 0}, faces_down ? Vec3{1, 0, 0} : Vec3{0, 0, 1},
                     faces_down ? Vec3{0, 0, 1} : Vec3{1, 0, 0}, material);
            const uint lit = faces_down ? 1 : 0;
            EXPECT_EQ(selected(device, scene, {0, 1}), (std::vector<uint>{lit, lit, 7, 7, 7, 7, 7, 7, 7, 7}));
        }
    });
}

TEST_F(LightVisibilityTest, WithoutLightsNothingIsSelected) {
    on_each_device([](Device& device) {
        EXPECT_EQ(selected(device, three_floors(true), {0, 1, 2}),
                  (std::vector<uint>{0, 0, 0, 7, 7, 7, 7, 7}));
    });
}

}  // namespace
}  // namespace nearlight::core
