// SPDX-License-Identifier: Apache-2.0
#include "host/compare/vpl_figure.h"

#include <gtest/gtest.h>

#include <vector>

#include "host/base/math.h"
#include "host/compare/pictures.h"
#include "host/scene/camera.h"

namespace nearlight::core {
namespace {

SceneCamera camera() {
    return {.to_world = look_at({1, 2, 3}, {2, 2.5, 5}, {0, 1, 0}),
            .fov_x_degrees = 55,
            .width = 32,
            .height = 20};
}

TEST(VplFigure, ProjectsToWhereTheCameraRayComesFrom) {
    const Camera pinhole = make_camera(camera(), 32, 20);
    for (const auto& [x, y] : {std::pair{16.0f, 10.0f}, {0.5f, 0.5f}, {31.0f, 3.0f}, {5.0f, 19.5f}}) {
        const Vec3 direction = pinhole.corner + x * pinhole.step_x + y * pinhole.step_y;
        const auto point = project(camera(), pinhole.origin + 3.0f * direction);
        ASSERT_TRUE(point);
        EXPECT_NEAR(point->x, x, 1e-3);
        EXPECT_NEAR(point->y, y, 1e-3);
        EXPECT_NEAR(point->distance, 3.0f * length(direction), 1e-3);
    }
}

TEST(VplFigure, WhatIsBehindOrBesideTheCameraIsNotThere) {
    const Camera pinhole = make_camera(camera(), 32, 20);
    const auto toward = [&](float x, float y) {
        return pinhole.corner + x * pinhole.step_x + y * pinhole.step_y;
    };
    EXPECT_FALSE(project(camera(), pinhole.origin - toward(16, 10)));
    EXPECT_FALSE(project(camera(), pinhole.origin + toward(-1, 10)));
    EXPECT_FALSE(project(camera(), pinhole.origin + toward(16, 21)));
    EXPECT_FALSE(project(camera(), pinhole.origin));
}

TEST(VplFigure, CountsAndDrawsWhatIsInThePicture) {
    const Camera pinhole = make_camera(camera(), 32, 20);
    const auto vpl_at = [&](float x, float y, float distance, uint flags) {
        const Vec3 direction = normalize(pinhole.corner + x * pinhole.step_x + y * pinhole.step_y);
        return Vpl{pinhole.origin + distance * direction, 1, {0, 0, 1}, flags, {1, 1, 1}, 0};
    };
    const std::vector<float> depths(32 * 20, 2.0f);
    const std::vector<Vpl> vpls{vpl_at(8, 5, 2.0f, NEARLIGHT_VPL_CLOSE), vpl_at(24, 15, 2.0f, 0),
                                vpl_at(8, 15, 3.0f, 0), vpl_at(-9, 5, 2.0f, 0)};
    const VplDots dots = draw_vpls(make_picture(32, 20), depths, camera(), vpls);
    EXPECT_EQ(dots.vpls, 4u);
    EXPECT_EQ(dots.in_picture, 3u);
    EXPECT_EQ(dots.visible, 2u);
    const int factor = dots.picture.width / 32;
    const auto at = [&](int x, int y, std::size_t c) { return dots.picture.at(x * factor, y * factor, c); };
    EXPECT_GT(at(8, 5, 0), 0.9f);    // orange
    EXPECT_GT(at(24, 15, 2), 0.9f);  // blue
    EXPECT_GT(at(8, 15, 2), 0.2f);   // hidden: fainter
    EXPECT_LT(at(8, 15, 2), 0.6f);
    EXPECT_EQ(at(16, 3, 0) + at(16, 3, 2), 0.0f);  // nothing
}

}  // namespace
}  // namespace nearlight::core
