// SPDX-License-Identifier: Apache-2.0
#include "host/session/frame_sequence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/session/rendering.h"
#include "tests/session/yard_scene.h"
#include "tests/support/device_fixture.h"
#include "tests/support/error_matchers.h"

namespace nearlight::core {
namespace {

TEST(FrameSequence, MomentsAndKeyViewsFollowTheRate) {
    AnimationOptions options{.fps = 25, .animations = {"sequence"}};
    EXPECT_DOUBLE_EQ(moment_of(options, 50).seconds, 2.0);
    EXPECT_EQ(moment_of(options, 50).animations, options.animations);
    EXPECT_EQ(key_step(options), 25);
    options.fps = 0.25;
    EXPECT_EQ(key_step(options), 1);
    options.vpl_keys = 0;
    EXPECT_EQ(key_step(options), 0);
}

/// The yard, in which the camera moves all the time, and something else begins to after a second.
class FrameSequenceTest : public test::DeviceTest {
  protected:
    static SceneCamera camera_at(double seconds) {
        Scene scene;
        small_scenes::set_camera(scene, {0.1 + 0.3 * seconds, 0.6, -1.9}, {0.3 * seconds, -0.5, 1}, 70);
        scene.camera.width = 40;
        scene.camera.height = 24;
        return scene.camera;
    }
    static std::uint64_t pose_at(double seconds) {
        return seconds > 1 ? static_cast<std::uint64_t>(std::lround(100 * seconds)) : 0;
    }
    FrameSource source() {
        return {.load =
                    [this](const SceneMoment& moment) {
                        if (is_broken_) {
                            throw Error(ErrorKind::file, "yard.glb: is broken");
                        }
                        ++loads_;
                        Scene scene = test::yard({40, 24, 70});
                        scene.camera = camera_at(moment.seconds);
                        scene.pose = pose_at(moment.seconds);
                        return scene;
                    },
                .camera_at = [](const Scene& scene, const SceneMoment& moment) -> std::optional<SceneCamera> {
                    return scene.pose == pose_at(moment.seconds) ? std::optional(camera_at(moment.seconds))
                                                                 : std::nullopt;
                }};
    }
    FrameSequence sequence(Device& device) { return {source(), {.fps = 4}, {&device}, {}, scene_}; }
    static void go_to(FrameSequence& sequence, int frame) {
        sequence.go_to(frame, {.range = 2.0f, .clamp_radius = 0.2f}, test::few_vpls().sampling);
    }

    std::unique_ptr<Scene> scene_;
    int loads_ = 0;
    bool is_broken_ = false;
};

TEST_F(FrameSequenceTest, LoadsTheSceneOnlyWhereMoreThanTheCameraMoves) {
    on_each_device([&](Device& device) {
        scene_.reset();
        loads_ = 0;
        FrameSequence sequence = this->sequence(device);
        for (const auto& [frame, loads] : {std::pair{0, 1}, {1, 1}, {3, 1}, {3, 1}, {6, 2}, {6, 2}, {0, 3}}) {
            go_to(sequence, frame);
            EXPECT_EQ(loads_, loads) << frame;
            EXPECT_EQ(scene_->camera.to_world.m, camera_at(frame / 4.0).to_world.m) << frame;
        }
    });
}

TEST_F(FrameSequenceTest, KeyViewsAreWeightedByHowNearTheyAre) {
    on_each_device([&](Device& device) {
        scene_.reset();
        FrameSequence sequence = this->sequence(device);
        go_to(sequence, 3);
        ASSERT_EQ(sequence.views().size(), 2u);
        EXPECT_EQ(sequence.views()[0].frame, 0);
        EXPECT_FLOAT_EQ(sequence.views()[0].weight, 0.25f);
        EXPECT_EQ(sequence.views()[1].frame, 4);
        EXPECT_FLOAT_EQ(sequence.views()[1].weight, 0.75f);
        EXPECT_EQ(sequence.views()[1].camera.to_world.m, camera_at(1).to_world.m);
        EXPECT_TRUE(sequence.vpl_maker());
        go_to(sequence, 0);
        ASSERT_EQ(sequence.views().size(), 1u);
        EXPECT_EQ(sequence.views()[0].weight, 1.0f);
        go_to(sequence, 6);  // the light is like that at neither key view
        EXPECT_TRUE(sequence.views().empty());
        EXPECT_FALSE(sequence.vpl_maker());
        go_to(sequence, 1);
        EXPECT_EQ(sequence.views().size(), 2u);
    });
}

TEST_F(FrameSequenceTest, GoesOnAfterAFileThatWasBroken) {
    on_each_device([&](Device& device) {
        scene_.reset();
        FrameSequence sequence = this->sequence(device);
        go_to(sequence, 1);
        const auto light = [&] {
            return sequence.session().sample(sequence.session().look({}, 1), {}, 1).vpls.count();
        };
        const std::size_t before = light();
        is_broken_ = true;
        EXPECT_TRUE(test::mentions(test::error_of([&] { go_to(sequence, 6); }), "is broken"));
        EXPECT_TRUE(test::mentions(test::error_of([&] { go_to(sequence, 1); }), "is broken"))
            << "there is no scene";
        is_broken_ = false;
        go_to(sequence, 1);
        EXPECT_EQ(light(), before);
        EXPECT_EQ(sequence.views().size(), 2u);
    });
}

}  // namespace
}  // namespace nearlight::core
