// SPDX-License-Identifier: Apache-2.0
#include "host/session/scene_memory.h"

#include <gtest/gtest.h>

#include "tests/support/error_matchers.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

TEST(SceneMemory, EachDeviceOfTheMachineNeedsACopyBesidesTheTrees) {
    const Scene scene = small_scenes::court_under_sky();
    const SceneMemory memory = estimate_scene_memory(scene);
    const std::uint64_t one = memory.trees + memory.on_device();
    check_scene_memory(scene, 0, memory.trees);
    check_scene_memory(scene, 1, one);
    check_scene_memory(scene, 2, one + memory.on_device());
    for (const std::size_t devices : {std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
        const std::uint64_t enough = memory.trees + devices * memory.on_device();
        const Error error = test::error_of([&] { check_scene_memory(scene, devices, enough - 1); });
        EXPECT_EQ(error.kind(), ErrorKind::out_of_memory);
        EXPECT_TRUE(test::mentions(error, "needs about"));
    }
}

TEST(SceneMemory, CountsTexturesAndTheEnvironment) {
    Scene scene = small_scenes::court_under_sky();
    const SceneMemory before = estimate_scene_memory(scene);
    scene.images.emplace_back().words.resize(1000);
    scene.environment.radiance.resize(scene.environment.radiance.size() + 500);
    const SceneMemory after = estimate_scene_memory(scene);
    EXPECT_EQ(after.textures - before.textures, 4000u);
    EXPECT_EQ(after.environment_on_host - before.environment_on_host, 500 * sizeof(Vec3));
    EXPECT_EQ(after.on_device() - before.on_device(), 4000u + 500 * 5 * sizeof(float));
}

}  // namespace
}  // namespace nearlight::core
