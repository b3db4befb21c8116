// SPDX-License-Identifier: Apache-2.0
#include "host/stages/close_range.h"

#include <gtest/gtest.h>

#include "host/base/math.h"
#include "host/base/random.h"
#include "host/scene/pinhole_camera.h"

namespace nearlight {
namespace {

bool contains(const CloseRange& region, Vec3 p) {
    for (const auto& plane : region.planes) {
        if (plane[0] * p.x + plane[1] * p.y + plane[2] * p.z + plane[3] < 0.0f) {
            return false;
        }
    }
    return length(p - region.origin) < region.range;
}

std::vector<PinholeCamera> some_cameras() {
    SceneCamera tilted;
    tilted.to_world = look_at({3, -2, 5}, {-1, 4, 0.5}, {0.3, 1, 0.2});
    tilted.fov_x_degrees = 71;
    SceneCamera mirrored = tilted;
    mirrored.to_world = tilted.to_world * scaling(-1, 1, 1);
    SceneCamera narrow;
    narrow.fov_x_degrees = 3;
    return {make_pinhole_camera(tilted, 640, 200), make_pinhole_camera(mirrored, 90, 300),
            make_pinhole_camera(narrow, 64, 64)};
}

TEST(CloseRange, HoldsExactlyWhatFallsOnTheFilmNearerThanRange) {
    constexpr float kRange = 2.5f;
    for (const PinholeCamera& camera : some_cameras()) {
        const CloseRange region = make_close_range(camera, kRange);
        Pcg32 random(5);
        for (int i = 0; i < 5000; ++i) {
            // Film positions up to half a film beyond each edge, and distances on both sides of the range.
            const float x = random.uniform() * 2.0f - 0.5f;
            const float y = random.uniform() * 2.0f - 0.5f;
            const float distance = kRange * (0.01f + 2.0f * random.uniform());
            const Vec3 direction = camera.corner + camera.step_x * (x * static_cast<float>(camera.width)) +
                                   camera.step_y * (y * static_cast<float>(camera.height));
            const bool near_edge = std::min({std::abs(x), std::abs(x - 1), std::abs(y), std::abs(y - 1),
                                             std::abs(distance / kRange - 1)}) < 1e-3f;
            if (near_edge) {
                continue;
            }
            const bool inside = x > 0 && x < 1 && y > 0 && y < 1 && distance < kRange;
            const Vec3 point = camera.origin + normalize(direction) * distance;
            EXPECT_EQ(contains(region, point), inside) << x << " " << y << " " << distance;
        }
    }
}

TEST(CloseRange, NothingBehindTheCameraIsInside) {
    for (const PinholeCamera& camera : some_cameras()) {
        const CloseRange region = make_close_range(camera, 100.0f);
        Pcg32 random(6);
        for (int i = 0; i < 1000; ++i) {
            const Vec3 direction = camera.corner +
                                   camera.step_x * (random.uniform() * static_cast<float>(camera.width)) +
                                   camera.step_y * (random.uniform() * static_cast<float>(camera.height));
            EXPECT_FALSE(contains(region, camera.origin - normalize(direction) * (0.1f + random.uniform())));
        }
    }
}

TEST(CloseRange, PlanesAreUnitAndGoThroughTheCamera) {
    for (const PinholeCamera& camera : some_cameras()) {
        for (const auto& plane : make_close_range(camera, 1.0f).planes) {
            const Vec3 normal{plane[0], plane[1], plane[2]};
            EXPECT_NEAR(length(normal), 1.0f, 1e-6f);
            EXPECT_NEAR(dot(normal, camera.origin) + plane[3], 0.0f, 1e-5f);
        }
    }
}

}  // namespace
}  // namespace nearlight
