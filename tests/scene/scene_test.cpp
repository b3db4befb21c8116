// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <set>
#include <vector>

#include "tests/support/error_matchers.h"

namespace nearlight::core {
namespace {

void expect_color(Vec3 a, Vec3 b) {
    EXPECT_FLOAT_EQ(a.x, b.x);
    EXPECT_FLOAT_EQ(a.y, b.y);
    EXPECT_FLOAT_EQ(a.z, b.z);
}

/// A scene with one item of each kind.
Scene small_scene() {
    Scene scene;
    scene.name = "small";
    scene.vertex_colors = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
    scene.vertices = {{{0, 0, 0}, 0, {0, 0, 1}, 0},
                      {{3, 0, 0}, 1, {0, 0, 1}, 0},
                      {{0, 4, 0}, 0, {0, 0, 1}, 1},
                      {{99, 99, 99}, 0, {0, 0, 0}, 0}};
    scene.triangles = {{0, 1, 2, 0}};
    scene.materials.push_back({});
    scene.textures.push_back({});
    scene.images.push_back({"white.png", 1, 1, NEARLIGHT_TEXELS_SRGB8, {0xffffffffu}});
    scene.delta_emitters.push_back({});
    scene.environment.width = scene.environment.height = 1;
    scene.environment.radiance = {{1, 1, 1}};
    return scene;
}

TEST(Scene, NotesReadLikeCompilerMessages) {
    EXPECT_EQ(to_string(Note{"a/b.xml", 7, "unknown bsdf"}), "a/b.xml:7: unknown bsdf");
    EXPECT_EQ(to_string(Note{"a/b.xml", 0, "unknown bsdf"}), "a/b.xml: unknown bsdf");
}

TEST(Scene, BoundsLeaveOutVerticesThatNoTriangleUses) {
    const Aabb box = bounds(small_scene());
    expect_color(box.min, {0, 0, 0});
    expect_color(box.max, {3, 4, 0});
    EXPECT_TRUE(bounds(Scene{}).is_empty());
}

TEST(Scene, AreasOfPlainTinyAndHugeTriangles) {
    Scene scene = small_scene();
    EXPECT_FLOAT_EQ(triangle_area(scene, scene.triangles[0]), 6.0f);
    EXPECT_EQ(triangle_area(scene, {0, 1, 1, 0}), 0.0f);
    for (const float scale : {1e-14f, 1e14f}) {
        scene.vertices[1].position = {3 * scale, 0, 0};
        scene.vertices[2].position = {0, 0, 4 * scale};
        EXPECT_FLOAT_EQ(triangle_area(scene, scene.triangles[0]), 6.0f * scale * scale);
    }
}

/// Something that shapes the picture.
using SceneChange = std::function<void(Scene&)>;

std::vector<SceneChange> changes_of_surfaces() {
    return {
        [](Scene& s) { s.vertices[1].position.x += 1e-6f; },
        [](Scene& s) { s.vertices[1].u = 0.5f; },
        [](Scene& s) {
            s.vertices[1].normal = {0, 1, 0};
        },
        [](Scene& s) { s.vertices.pop_back(); },
        [](Scene& s) { std::swap(s.triangles[0].v0, s.triangles[0].v1); },
        [](Scene& s) { s.triangles.push_back(s.triangles[0]); },
        [](Scene& s) { s.vertex_colors[3].z = 0.5f; },
        [](Scene& s) {
            s.second_uvs = {{0.0f, 0.5f}};
        },
        [](Scene& s) { s.materials[0].reflectance.value.y = 0.1f; },
        [](Scene& s) { s.materials[0].roughness.texture = 3; },
        [](Scene& s) { s.materials[0].emission.value.z = 0.1f; },
        [](Scene& s) { s.materials[0].clearcoat_gloss.value.x = 0.1f; },
        [](Scene& s) { s.materials[0].model = NEARLIGHT_BSDF_CONDUCTOR; },
        [](Scene& s) { s.materials[0].flags = NEARLIGHT_MATERIAL_BECKMANN; },
        [](Scene& s) { s.materials[0].child[1] = 1; },
        [](Scene& s) { s.materials[0].internal_reflectance = 0.3f; },
        [](Scene& s) { s.transmission_curves[NEARLIGHT_CURVE_SIZE - 1] = 0.5f; },
        [](Scene& s) { s.textures[0].image = 0; },
        [](Scene& s) { s.textures[0].parameters.kind = NEARLIGHT_TEXTURE_CHECKERBOARD; },
        [](Scene& s) { s.textures[0].parameters.v_shear = 0.5f; },
        [](Scene& s) { s.textures[0].parameters.flags = NEARLIGHT_TEXTURE_SECOND_UV; },
        [](Scene& s) { s.textures[0].parameters.cutoff = 0.5f; },
        [](Scene& s) { s.textures[0].parameters.color1.value.x = 0.5f; },
        [](Scene& s) { s.textures[0].parameters.color0.texture = 1; },
        [](Scene& s) { s.textures[0].parameters.wrap_t = NEARLIGHT_WRAP_CLAMP; },
        [](Scene& s) { s.textures[0].parameters.filter = NEARLIGHT_FILTER_NEAREST; },
        [](Scene& s) { s.images[0].format = NEARLIGHT_TEXELS_LINEAR8; },
        [](Scene& s) { s.images[0].words[0] = 0; },
        [](Scene& s) { s.images[0].width = 2; },
    };
}

std::vector<SceneChange> changes_of_lights_and_view() {
    return {
        [](Scene& s) { s.delta_emitters[0].position.x = 1; },
        [](Scene& s) { s.delta_emitters[0].radiance.x = 1; },
        [](Scene& s) { s.delta_emitters[0].cutoff_angle = 1; },
        [](Scene& s) { s.delta_emitters[0].image = 1; },
        [](Scene& s) { s.environment.sun_half_angle = 0.1f; },
        [](Scene& s) { s.environment.radiance[0].x = 2; },
        [](Scene& s) { s.environment.to_world = rotation(0, 1, 0, 10); },
        [](Scene& s) { s.camera.to_world(0, 3) = 1e-9; },
        [](Scene& s) { s.camera.fov_x_degrees = 41; },
        [](Scene& s) { s.camera.width = 641; },
        [](Scene& s) { s.camera.height = 481; },
        [](Scene& s) { s.camera.kind = CameraKind::orthographic; },
        [](Scene& s) { s.camera.center_x = 0.1; },
        [](Scene& s) { s.camera.center_y = 0.1; },
        [](Scene& s) { s.camera.film_part = 0.5; },
        [](Scene& s) { s.camera.aperture_radius = 0.5; },
        [](Scene& s) { s.camera.focus_distance = 0.5; },
        [](Scene& s) { s.camera.near_clip = 0.25; },
        [](Scene& s) { s.camera.far_clip = 0.25; },
        [](Scene& s) { s.camera.filter.kind = FilterKind::tent; },
        [](Scene& s) { s.camera.filter.radius = 1.0; },
        [](Scene& s) { s.camera.filter.b = 1.0; },
        [](Scene& s) { s.camera.filter.c = 1.0; },
        [](Scene& s) { s.camera.sample_border = true; },
        [](Scene& s) { s.camera.hide_emitters = true; },
        [](Scene& s) { s.camera.is_monochrome = true; },
        [](Scene& s) { s.max_depth = 3; },
        [](Scene& s) { s.samples_per_pixel = 3; },
    };
}

TEST(Scene, HashKnowsEverythingThatShapesThePicture) {
    std::vector<SceneChange> changes = changes_of_surfaces();
    std::ranges::copy(changes_of_lights_and_view(), std::back_inserter(changes));
    std::set<std::uint64_t> hashes{scene_hash(small_scene())};
    for (const SceneChange& change : changes) {
        Scene scene = small_scene();
        change(scene);
        hashes.insert(scene_hash(scene));
    }
    EXPECT_EQ(hashes.size(), changes.size() + 1);
}

TEST(Scene, HashDoesNotKnowNamesNotesPaddingAndWhatIsFilledInLater) {
    Scene scene = small_scene();
    const std::uint64_t before = scene_hash(scene);
    scene.name = "other";
    scene.source = "elsewhere/scene.xml";
    scene.notes.push_back({"scene.xml", 1, "approximated"});
    scene.images[0].name = "renamed.png";
    scene.textures[0].parameters.first_word = 17;
    scene.delta_emitters[0].probability = 0.5f;
    scene.delta_emitters[0].cdf = 1.0f;
    EXPECT_EQ(scene_hash(scene), before);
}

// Fixes the hash function, so that hashes stored in files remain comparable. The number is from Python's
// xxhash, which hashed the lengths of seven arrays, where only that of the transmission curves is not zero, a
// curve of ones, no environment, the identity twice, the default camera and integrator, and a depth of 0.
TEST(Scene, HashOfAnEmptySceneDoesNotChange) {
    Scene scene;
    scene.max_depth = 0;
    EXPECT_EQ(scene_hash(scene), 12888696993993237507ull);
}

TEST(Scene, MoreTrianglesThanATreeHoldsAreRefused) {
    check_triangle_count(kMaxSceneTriangles);
    const Error error = test::error_of([] { check_triangle_count(kMaxSceneTriangles + 1); });
    EXPECT_EQ(error.kind(), ErrorKind::out_of_memory);
    EXPECT_TRUE(test::mentions(error, "only 134217727"));
}

}  // namespace
}  // namespace nearlight::core
