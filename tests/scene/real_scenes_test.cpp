// SPDX-License-Identifier: Apache-2.0
#include "tests/support/real_scenes.h"
#include "host/scene/ply_loader.h"
#include "tests/scene/scene_files.h"

namespace nearlight::core {
namespace {

using namespace test;

TEST(RealScenes, ModernHall) {
    const auto file = real_scene("modern-hall/scene.xml");
    if (file.empty()) {
        GTEST_SKIP() << "modern-hall is not there; set NEARLIGHT_TEST_SCENES";
    }
    const Scene scene = load_scene(file);
    EXPECT_EQ(scene.name, "modern-hall");
    EXPECT_EQ(scene.triangles.size(), 31567u);
    EXPECT_EQ(scene.images.size(), 3u);
    EXPECT_TRUE(scene.notes.empty()) << to_string(scene.notes.front());
    EXPECT_EQ(scene.camera.width, 1280);
    EXPECT_EQ(scene.max_depth, 65);
    EXPECT_EQ(scene.samples_per_pixel, 256);
}

TEST(RealScenes, VeachBidir) {
    const auto file = real_scene("veach-bidir/scene.xml");
    if (file.empty()) {
        GTEST_SKIP() << "veach-bidir is not there; set NEARLIGHT_TEST_SCENES";
    }
    const Scene scene = load_scene(file, {.parameters = {{"resx", "320"}}, .strict = false});
    EXPECT_EQ(scene.triangles.size(), 11544u);
    EXPECT_EQ(scene.camera.width, 320);
    EXPECT_EQ(scene.camera.height, 1024);
    std::size_t emissive = 0;
    for (const Triangle& triangle : scene.triangles) {
        emissive += is_zero(scene.materials[triangle.material].emission.value) ? 0 : 1;
    }
    EXPECT_EQ(emissive, 4u);
    EXPECT_TRUE(scene.notes.empty());
}

TEST(RealScenes, FurnishedLivingRoom) {
    const auto file = real_scene("furnished-living-room.gltf");
    if (file.empty()) {
        GTEST_SKIP() << "furnished-living-room is not there; set NEARLIGHT_TEST_SCENES";
    }
    const Scene scene = load_scene(file, {.camera = "cabinets"});
    EXPECT_EQ(scene.triangles.size(), 116817u);
    EXPECT_EQ(scene.delta_emitters.size(), 2u);
    // 11 of colours, the others of roughness, metalness (where its factor is not 0) and normals, of which
    // five also serve turned over.
    EXPECT_EQ(scene.images.size(), 43u);
    EXPECT_EQ(scene.camera.width, 640);
    EXPECT_NEAR(scene.camera.fov_x_degrees, 69.5, 0.1);
}

TEST(RealScenes, LionHead) {
    const auto file = real_scene("lion-head/lion_head_1k.gltf");
    if (file.empty()) {
        GTEST_SKIP() << "lion-head is not there; set NEARLIGHT_TEST_SCENES";
    }
    EXPECT_EQ(load_scene(file).triangles.size(), 47214u);
}

TEST(RealScenes, TeapotPlyFiles) {
    std::size_t triangles = 0;
    for (const char* name : {"Mesh000", "Mesh001", "Mesh002", "Mesh003"}) {
        const auto file = real_scene("teapot-full/models/" + std::string(name) + ".ply");
        if (file.empty()) {
            GTEST_SKIP() << "teapot-full is not there; set NEARLIGHT_TEST_SCENES";
        }
        triangles += read_ply(file).triangles.size();
    }
    EXPECT_EQ(triangles, 126742u);
}

}  // namespace
}  // namespace nearlight::core
