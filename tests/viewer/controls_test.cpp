// SPDX-License-Identifier: Apache-2.0
#include "viewer/controls.h"

#include <gtest/gtest.h>

namespace nearlight::viewer {
namespace {

TEST(Controls, NoInputMovesNothing) {
    EXPECT_TRUE(shows_same(moved({}, {.seconds = 0.02f}, 1.0f), {}));
    EXPECT_TRUE(shows_same(moved({}, {.drag = Input::Drag::orbit}, 1.0f), {}));
}

/// What lies under the mouse follows it: dragging to the right brings what is on the left into view.
TEST(Controls, ThePictureFollowsDrags) {
    const FreeCamera looked = moved({}, {.drag = Input::Drag::look, .drag_x = 0.1f}, 1.0f);
    EXPECT_LT(looked.forward.x, 0.0f);
    const FreeCamera orbited = moved({}, {.drag = Input::Drag::orbit, .drag_x = 0.1f}, 1.0f);
    EXPECT_LT(orbited.origin.x, 0.0f);
    const FreeCamera panned = moved({}, {.drag = Input::Drag::pan, .drag_y = 0.1f}, 1.0f);
    EXPECT_GT(panned.origin.y, 0.0f);
}

TEST(Controls, KeysWalkAtTheGivenSpeed) {
    const FreeCamera walked = moved({}, {.ahead = 1, .seconds = 0.05f}, 2.0f);
    EXPECT_NEAR(walked.origin.z, -0.1f, 1e-6f);
    const FreeCamera hurried = moved({}, {.right = -1, .hurries = true, .seconds = 0.05f}, 2.0f);
    EXPECT_NEAR(hurried.origin.x, -0.4f, 1e-6f);
}

/// A program that slept for a minute does not jump through a wall.
TEST(Controls, LongFramesCountAsShortOnes) {
    EXPECT_LT(-moved({}, {.ahead = 1, .seconds = 60.0f}, 1.0f).origin.z, 0.2f);
}

TEST(Controls, TheWheelApproaches) {
    EXPECT_LT(moved({}, {.wheel = 1.0f}, 1.0f).origin.z, 0.0f);
    EXPECT_GT(moved({}, {.wheel = -1.0f}, 1.0f).origin.z, 0.0f);
}

}  // namespace
}  // namespace nearlight::viewer
