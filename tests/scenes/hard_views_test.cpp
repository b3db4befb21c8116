// SPDX-License-Identifier: Apache-2.0
// Checks that the views chosen against close-range sampling have the properties that their READMEs state.
#include <gtest/gtest.h>

#include "host/base/random.h"
#include "host/reference/camera_path.h"
#include "host/reference/path_tracer.h"
#include "host/reference/sampling.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

Image trace(const Scene& scene) {
    return trace_paths(scene, {.spp = 16, .max_depth = 4, .pixel_centers = true});
}

TEST(HardViews, AreReadWithoutAnyApproximation) {
    for (const char* name : {"wall", "whole-room", "next-room"}) {
        const Scene scene = hard_view(name);
        EXPECT_TRUE(scene.notes.empty()) << name;
        EXPECT_GT(scene.triangles.size(), 100u) << name;
        EXPECT_EQ(scene.max_depth, 8) << name;
        for (const Triangle& triangle : scene.triangles) {
            EXPECT_EQ(scene.materials[triangle.material].model, NEARLIGHT_BSDF_TWO_SIDED) << name;
        }
    }
}

TEST(HardViews, DaylightComesThroughTwoPanes) {
    const Scene scene = hard_view("daylight");
    EXPECT_TRUE(scene.notes.empty());
    EXPECT_EQ(scene.max_depth, 12);
    EXPECT_GT(scene.environment.width, 1);
    EXPECT_EQ(scene.environment.sun_half_angle, 0.0f);
    EXPECT_EQ(std::ranges::count_if(scene.triangles,
                                    [&](const Triangle& triangle) {
                                        const uint model = scene.materials[triangle.material].model;
                                        return model == NEARLIGHT_BSDF_THIN_DIELECTRIC;
                                    }),
              4);
}

TEST(HardViews, WallIsOnePlaneLitFromBehindTheCamera) {
    const Image image = trace(wall_view());
    const auto z = static_cast<std::size_t>(image.find_channel("P.Z"));
    for (int pixel = 0; pixel < 32 * 32; ++pixel) {
        ASSERT_NEAR(image.at(pixel % 32, pixel / 32, z), 2.5, 1e-3);
    }
    EXPECT_GT(channel_mean(image, "indirect.R"), 0.3 * channel_mean(image, "direct.R"));
}

/// Fraction of the scene's area whose front or back the camera sees.
double visible_share(const Scene& scene) {
    const EmbreeScene embree(scene);
    const Mat4 to_camera = inverse(scene.camera.to_world);
    const double tan = std::tan(scene.camera.fov_x_degrees * std::numbers::pi / 360.0);
    const Vec3 eye = transform_point(scene.camera.to_world, {0, 0, 0});
    Pcg32 random(1);
    double seen = 0;
    double all = 0;
    for (const Triangle& triangle : scene.triangles) {
        constexpr int kPoints = 50;
        const double area = triangle_area(scene, triangle) / kPoints;
        for (int i = 0; i < kPoints; ++i) {
            const float x = random.uniform();
            const Point2 weights = sample_triangle({x, random.uniform()});
            const Vec3 a = scene.vertices[triangle.v0].position;
            const Vec3 point = a + (scene.vertices[triangle.v1].position - a) * weights.x +
                               (scene.vertices[triangle.v2].position - a) * weights.y;
            const Vec3 p = transform_point(to_camera, point);
            const bool in_view = p.z > 0 && std::abs(p.x) < tan * p.z && std::abs(p.y) < tan * p.z;
            seen += in_view && !embree.occluded(eye, point - eye, 0.0f, 0.999f) ? area : 0.0;
            all += area;
        }
    }
    return seen / all;
}

TEST(HardViews, WholeRoomIsSeenWholeAndTheWallIsNot) {
    EXPECT_GT(visible_share(whole_room_view()), 0.5);
    EXPECT_LT(visible_share(wall_view()), 0.1);
}

TEST(HardViews, NextRoomHasItsLightFromNextDoor) {
    const Scene scene = next_room_view();
    const Image image = trace(scene);
    const auto x = static_cast<std::size_t>(image.find_channel("P.X"));
    const auto direct = static_cast<std::size_t>(image.find_channel("direct.R"));
    const auto indirect = static_cast<std::size_t>(image.find_channel("indirect.R"));
    int here = 0;
    double bounced = 0;
    for (int pixel = 0; pixel < 32 * 32; ++pixel) {
        if (image.at(pixel % 32, pixel / 32, x) < -0.1f) {
            ++here;
            bounced += image.at(pixel % 32, pixel / 32, indirect);
            ASSERT_EQ(image.at(pixel % 32, pixel / 32, direct), 0.0f);
        }
    }
    EXPECT_GT(here, 600);
    EXPECT_LT(here, 32 * 32) << "the next room is to be seen through the door";
    EXPECT_GT(bounced / here, 0.01);
}

}  // namespace
}  // namespace nearlight::core
