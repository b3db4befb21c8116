// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene_limits.h"

#include <gtest/gtest.h>

#include "nearlight/error.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

Scene lit_square(Vec3 corner) {
    Scene scene;
    Material lamp = lambertian({0.5f, 0.5f, 0.5f});
    lamp.emission.value = {1, 2, 3};
    add_quad(scene, corner, {2, 0, 0}, {0, 2, 0}, add_material(scene, lamp));
    scene.environment = patterned_map(4, 2);
    scene.delta_emitters.push_back({});
    scene.delta_emitters[0].radiance = {4, 5, 6};
    return scene;
}

std::vector<Note> notes_of(Scene& scene, bool strict = false) {
    std::vector<Note> notes;
    NoteSink sink(notes, strict);
    keep_within_limits(scene, sink);
    return notes;
}

TEST(SceneLimits, OrdinaryScenesStayAsTheyAre) {
    Scene scene = lit_square({-1, -1, 0});
    const std::uint64_t before = scene_hash(scene);
    EXPECT_TRUE(notes_of(scene, true).empty());
    EXPECT_EQ(scene_hash(scene), before);
    Scene empty;
    EXPECT_TRUE(notes_of(empty).empty());
}

TEST(SceneLimits, LightThatCannotBeAddedUpIsDarkened) {
    Scene scene = lit_square({-1, -1, 0});
    scene.materials[0].emission.value = {1e38f, 2, 3};
    scene.environment.radiance[3] = {1, 3e38f, 1};
    scene.environment.sun_radiance = {1, 1, 1e21f};
    scene.delta_emitters[0].radiance = {1e30f, 0, 0};
    const std::vector<Note> notes = notes_of(scene);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0].text, "light brighter than 1e+20 counts as that bright");
    EXPECT_EQ(scene.materials[0].emission.value.x, kMaxRadiance);
    EXPECT_EQ(scene.materials[0].emission.value.y, 2.0f);
    EXPECT_EQ(scene.environment.radiance[3].y, kMaxRadiance);
    EXPECT_EQ(scene.environment.sun_radiance.z, kMaxRadiance);
    EXPECT_EQ(scene.delta_emitters[0].radiance.x, kMaxRadiance);
    scene.delta_emitters[0].radiance.x = 1e30f;
    EXPECT_THROW(notes_of(scene, true), Error);
}

TEST(SceneLimits, ScenesFarFromTheOriginAreRemarked) {
    Scene near = lit_square({500, 0, 0});
    EXPECT_TRUE(notes_of(near).empty());
    Scene far = lit_square({10000, 0, 0});
    const std::vector<Note> notes = notes_of(far, true);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(
        notes[0].text,
        "the scene is 2 large but lies far from the origin, where rays start 0.02 off surfaces, so that "
        "thin things leak; move it to the origin");
}

}  // namespace
}  // namespace nearlight::core
