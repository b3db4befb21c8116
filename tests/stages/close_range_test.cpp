// SPDX-License-Identifier: Apache-2.0
#include "host/stages/close_range.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "host/base/math.h"
#include "host/base/random.h"
#include "host/scene/camera.h"

namespace nearlight::core {
namespace {

bool contains(const CloseRange& region, Vec3 p) {
    return in_frustum(region, p, 0.0f) && length(p - region.origin) < region.range;
}

std::vector<Camera> some_cameras() {
    SceneCamera tilted;
    tilted.to_world = look_at({3, -2, 5}, {-1, 4, 0.5}, {0.3, 1, 0.2});
    tilted.fov_x_degrees = 71;
    SceneCamera mirrored = tilted;
    mirrored.to_world = tilted.to_world * scaling(-1, 1, 1);
    SceneCamera narrow;
    narrow.fov_x_degrees = 3;
    return {make_camera(tilted, 640, 200), make_camera(mirrored, 90, 300), make_camera(narrow, 64, 64)};
}

TEST(CloseRange, HoldsExactlyWhatFallsOnTheFilmNearerThanRange) {
    constexpr float kRange = 2.5f;
    for (const Camera& camera : some_cameras()) {
        const CloseRange region = make_close_range(camera, kRange);
        Pcg32 random(5);
        for (int i = 0; i < 5000; ++i) {
            // Film positions go up to half a film beyond each edge, and distances are on both sides of the
            // range.
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
    for (const Camera& camera : some_cameras()) {
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

TEST(CloseRange, AMarginReachesBeyondEachSideByItsWidthHoweverFarAway) {
    constexpr float kMargin = 0.2f;
    for (const Camera& camera : some_cameras()) {
        const CloseRange region = make_close_range(camera, 1.0f);
        const Vec3 across = camera.step_x * static_cast<float>(camera.width);
        const Vec3 down = camera.step_y * static_cast<float>(camera.height);
        const std::array sides{down * 0.5f, across * 0.5f, across + down * 0.5f, across * 0.5f + down};
        for (const Vec3& side : sides) {
            const Vec3 point = camera.origin + normalize(camera.corner + side) * 50.0f;
            const auto* const nearest = std::ranges::min_element(region.planes, {}, [&](const auto& plane) {
                return std::abs(dot({plane[0], plane[1], plane[2]}, point - camera.origin) + plane[3]);
            });
            const Vec3 outward = -Vec3{(*nearest)[0], (*nearest)[1], (*nearest)[2]};
            EXPECT_TRUE(in_frustum(region, point + outward * (0.99f * kMargin), kMargin));
            EXPECT_FALSE(in_frustum(region, point + outward * (1.01f * kMargin), kMargin));
        }
    }
}

TEST(CloseRange, PlanesAreUnitAndGoThroughTheCamera) {
    for (const Camera& camera : some_cameras()) {
        for (const auto& plane : make_close_range(camera, 1.0f).planes) {
            const Vec3 normal{plane[0], plane[1], plane[2]};
            EXPECT_NEAR(length(normal), 1.0f, 1e-6f);
            EXPECT_NEAR(plane[3], 0.0f, 1e-6f);
        }
    }
}

/// A point that the camera sees at the film position (x, y), as parts of the film, through the lens point a
/// times the lens' half-axes.
struct Seen {
    Vec3 point;
    float depth;  ///< along the viewing direction
};
Seen seen_point(const Camera& camera, float x, float y, float ax, float ay, float depth) {
    const Vec3 d = camera.corner + camera.step_x * (x * static_cast<float>(camera.width)) +
                   camera.step_y * (y * static_cast<float>(camera.height));
    if (camera.is_orthographic != 0) {
        return {camera.origin + d + camera.forward * depth, depth};
    }
    const Vec3 start = camera.lens_x * ax + camera.lens_y * ay;
    return {camera.origin + start + (d * camera.focus_distance - start) * (depth / camera.focus_distance),
            depth};
}

TEST(CloseRange, HoldsAllThatALensSees) {
    SceneCamera lens;
    lens.to_world = look_at({3, -2, 5}, {-1, 4, 0.5}, {0.3, 1, 0.2});
    lens.fov_x_degrees = 50;
    lens.aperture_radius = 0.4;
    lens.center_x = 0.2;
    for (const float focus : {0.7f, 2.0f, 40.0f}) {
        lens.focus_distance = focus;
        const Camera camera = make_camera(lens, 64, 40);
        for (const float range : {1.0f, 3.0f, std::numeric_limits<float>::infinity()}) {
            const CloseRange region = make_close_range(camera, range);
            Pcg32 random(7);
            int inside = 0;
            for (int i = 0; i < 5000; ++i) {
                const float angle = random.uniform() * 6.2831853f;
                const float r = std::sqrt(random.uniform());
                const float film_x = random.uniform();
                const float film_y = random.uniform();
                const Vec3 p = seen_point(camera, film_x, film_y, r * std::cos(angle), r * std::sin(angle),
                                          0.01f + 5.0f * random.uniform())
                                   .point;
                if (length(p - camera.origin) < range) {
                    EXPECT_TRUE(in_frustum(region, p, 1e-4f)) << focus << " " << range;
                    ++inside;
                }
            }
            EXPECT_GT(inside, 300);
            // It is no wider than the lens makes it: a point at the side, at the focus, is outside.
            const Vec3 beside = seen_point(camera, -3.0f, 0.5f, 0, 0, focus).point;
            EXPECT_FALSE(in_frustum(make_close_range(camera, focus), beside, 0.0f));
        }
    }
}

TEST(CloseRange, OrthographicIsTheBlockBeforeTheFilm) {
    SceneCamera parallel;
    parallel.kind = CameraKind::orthographic;
    parallel.to_world = look_at({3, -2, 5}, {-1, 4, 0.5}, {0.3, 1, 0.2}) * scaling(2, 2, 1);
    parallel.near_clip = 0.5;
    const Camera camera = make_camera(parallel, 64, 40);
    const CloseRange region = make_close_range(camera, 4.0f);
    Pcg32 random(8);
    for (int i = 0; i < 5000; ++i) {
        const float x = 2.0f * random.uniform() - 0.5f;
        const float y = 2.0f * random.uniform() - 0.5f;
        const Seen seen = seen_point(camera, x, y, 0, 0, 3.0f * random.uniform());
        const float margin = std::min(
            {std::abs(x), std::abs(1 - x), std::abs(y), std::abs(1 - y), std::abs(seen.depth - 0.5f)});
        if (margin > 1e-3f) {
            const bool inside = x > 0 && x < 1 && y > 0 && y < 1 && seen.depth > 0.5f;
            EXPECT_EQ(in_frustum(region, seen.point, 0.0f), inside) << x << " " << y << " " << seen.depth;
        }
    }
}

}  // namespace
}  // namespace nearlight::core
