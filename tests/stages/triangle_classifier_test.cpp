// SPDX-License-Identifier: Apache-2.0
#include "host/stages/triangle_classifier.h"

#include "host/base/math.h"
#include "host/base/random.h"
#include "host/reference/close_range_oracle.h"
#include "host/scene/camera.h"
#include "host/stages/close_range.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core {
namespace {

class TriangleClassifierTest : public test::DeviceTest {};

using Corners = TriangleCorners;

struct Result {
    std::vector<uint> flags;
    std::vector<float> areas;
};

Result classify(Device& device, const std::vector<Corners>& corners, const CloseRange& region,
                uint material_flags = NEARLIGHT_MATERIAL_DIFFUSE_FRONT, bool whole_triangles = true) {
    Material material{};
    material.flags = material_flags;
    std::vector<Vertex> vertices;
    std::vector<Triangle> triangles;
    for (const Corners& t : corners) {
        const uint first = static_cast<uint>(vertices.size());
        for (const Vec3 p : {t.a, t.b, t.c}) {
            vertices.push_back({.position = p, .u = 0, .normal = {}, .v = 0});
        }
        triangles.push_back({first, first + 1, first + 2, 0});
    }
    test::GuardedBuffer<uint> flags(device, corners.size());
    test::GuardedBuffer<float> areas(device, corners.size());
    TriangleClassifier(device).classify(Buffer<Vertex>(device, vertices), Buffer<Triangle>(device, triangles),
                                        Buffer<Material>(device, std::vector<Material>{material}),
                                        Buffer<CloseRange>(device, std::vector<CloseRange>{region}),
                                        whole_triangles, corners.size(), flags.buffer(), areas.buffer());
    return {flags.download(), areas.download()};
}

/// The view of 90° × 90° from the origin along +Z, which contains points with |x| ≤ z and |y| ≤ z.
CloseRange square_region(float range) {
    SceneCamera camera;
    camera.fov_x_degrees = 90;
    return make_close_range(make_camera(camera, 100, 100), range);
}

/// Of triangles that reach out of the close range, only the part between its planes counts.
TEST_F(TriangleClassifierTest, AreasOfPartsEndAtThePlanes) {
    on_each_device([](Device& device) {
        const std::vector<Corners> corners{
            {{-0.5f, 0, 2}, {0.5f, 0, 2}, {0, 0.5f, 2}},              // wholly inside
            {{-100, -100, 1}, {100, -100, 1}, {0, 200, 1}},           // all of |x| ≤ 1, |y| ≤ 1
            {{-900, -1, -900}, {900, -1, -900}, {0, -1, 1800}},       // a trapezium from z = 1 to z = 3
            {{-9000, -1, -9000}, {9000, -1, -9000}, {0, -1, 18000}},  // the same
        };
        const Result parts =
            classify(device, corners, square_region(3.0f), NEARLIGHT_MATERIAL_DIFFUSE_FRONT, false);
        EXPECT_EQ(parts.areas[0], 0.25f);
        EXPECT_NEAR(parts.areas[1], 4.0f, 0.01f);
        // The margin for rounding is 7 mm beside coordinates of 1800 m, and 7 cm beside those of 18 km.
        EXPECT_NEAR(parts.areas[2], 8.05f, 0.1f);
        EXPECT_NEAR(parts.areas[3], 8.5f, 1.0f);
        EXPECT_EQ(classify(device, corners, square_region(3.0f)).areas[1], 30'000.0f);
    });
}

TEST_F(TriangleClassifierTest, NearestPointInsideTheFrustumDecides) {
    on_each_device([](Device& device) {
        const std::vector<Corners> corners{
            {{-0.5f, 0, 2}, {0.5f, 0, 2}, {0, 0.5f, 2}},         // wholly inside
            {{-0.5f, 0, 4}, {0.5f, 0, 4}, {0, 0.5f, 4}},         // beyond the range
            {{-0.5f, 0, -2}, {0.5f, 0, -2}, {0, 0.5f, -2}},      // behind the camera
            {{5, 0, 2}, {6, 0, 2}, {5, 1, 2}},                   // beside the frustum
            {{-900, -1, -900}, {900, -1, -900}, {0, -1, 1800}},  // a floor; its centroid is inside, nearest
                                                                 // visible point at distance √2
            {{-100, -1, 0}, {0, -1, 0}, {-1, -1, 1e4f}},         // a floor whose centroid is far away
            {{-100, -100, 1}, {100, -100, 1}, {0, 200, 1}},      // covers the view: no corner is in it
            {{-100, -100, 3.5f}, {100, -100, 3.5f}, {0, 200, 3.5f}},  // covers the view, but beyond the range
            // The triangle is near the camera only outside the frustum. The part inside begins at distance
            // 4·√2.
            {{1, -0.1f, 0}, {1, 0.1f, 0}, {5, 0, 5}},
            {{0, 0, 2.999f}, {0.1f, 0, 9}, {0, 0.1f, 9}},   // only its tip is near enough
            {{0, 0, 3.001f}, {0.1f, 0, 9}, {0, 0.1f, 9}},   // not even its tip
            {{0.1f, -1, -1}, {0.1f, 1, -1}, {0.1f, 0, 1}},  // crosses the camera's plane
        };
        const std::vector<uint> expected{1, 0, 0, 0, 1, 1, 1, 0, 0, 1, 0, 1};
        EXPECT_EQ(classify(device, corners, square_region(3.0f)).flags, expected);
    });
}

TEST_F(TriangleClassifierTest, AreaIsThatOfTheWholeTriangle) {
    on_each_device([](Device& device) {
        const Result result = classify(device,
                                       {{{0, 0, 2}, {3, 0, 2}, {0, 4, 2}},
                                        {{0, 0, 2}, {1e-3f, 0, 2}, {0, 1e-3f, 2}},
                                        {{0, 0, 2}, {1, 1, 2}, {2, 2, 2}},
                                        {{1, 2, 2}, {1, 2, 2}, {1, 2, 2}}},
                                       square_region(3.0f));
        EXPECT_FLOAT_EQ(result.areas[0], 6.0f);
        EXPECT_NEAR(result.areas[1], 0.5e-6f, 1e-12f);
        EXPECT_EQ(result.areas[2], 0.0f);
        EXPECT_EQ(result.areas[3], 0.0f);
        EXPECT_EQ(result.flags, (std::vector<uint>{1, 1, 0, 0}));
    });
}

TEST_F(TriangleClassifierTest, WhatHasNoLambertianPartIsLeftOut) {
    on_each_device([](Device& device) {
        const std::vector<Corners> corners{{{-0.5f, 0, 2}, {0.5f, 0, 2}, {0, 0.5f, 2}}};
        for (const uint other : {0u, NEARLIGHT_MATERIAL_BECKMANN | NEARLIGHT_MATERIAL_THIN}) {
            for (const uint diffuse : {0u, NEARLIGHT_MATERIAL_DIFFUSE_FRONT, NEARLIGHT_MATERIAL_DIFFUSE_BACK,
                                       NEARLIGHT_MATERIAL_DIFFUSE_FRONT | NEARLIGHT_MATERIAL_DIFFUSE_BACK}) {
                EXPECT_EQ(classify(device, corners, square_region(3.0f), other | diffuse).flags[0],
                          diffuse != 0 ? 1u : 0u);
            }
        }
    });
}

TEST_F(TriangleClassifierTest, NoTriangles) {
    on_each_device(
        [](Device& device) { EXPECT_TRUE(classify(device, {}, square_region(1.0f)).flags.empty()); });
}

/// A pinhole, a lens with a near clip, and parallel rays.
std::vector<SceneCamera> cameras_of_each_kind() {
    SceneCamera camera;
    camera.to_world = look_at({0.3, -0.2, 0.5}, {-1, 0.4, 1.5}, {0.3, 1, 0.2});
    camera.fov_x_degrees = 55;
    std::vector<SceneCamera> cameras{camera, camera, camera};
    cameras[1].aperture_radius = 0.2;
    cameras[1].focus_distance = 0.8;
    cameras[1].near_clip = 0.3;
    cameras[2].kind = CameraKind::orthographic;
    return cameras;
}

/// Compares the classes of random triangles in the view of a camera with those of the oracle.
void expect_agreement(Device& device, const SceneCamera& camera) {
    constexpr float kRange = 1.5f;
    const CloseRange region = make_close_range(make_camera(camera, 320, 200), kRange);
    Pcg32 random(11);
    std::vector<Corners> corners(20'000);
    for (Corners& t : corners) {
        const auto point = [&](float size) {
            return Vec3{random.uniform() - 0.5f, random.uniform() - 0.5f, random.uniform() - 0.5f} * size;
        };
        const Vec3 center = region.origin + point(4.0f);
        const float size = std::exp2(8.0f * random.uniform() - 5.0f);
        t = {center + point(size), center + point(size), center + point(size)};
    }
    const std::vector<uint> flags = classify(device, corners, region).flags;
    int selected = 0;
    int undecided = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        constexpr double kSlack = 5e-5;
        const bool surely = nearest_squared_distance(corners[i], region, 0.0) < kRange * kRange;
        const bool perhaps =
            nearest_squared_distance(corners[i], region, kSlack) < (kRange + kSlack) * (kRange + kSlack);
        EXPECT_TRUE(flags[i] || !surely) << "triangle " << i << " was left out";
        EXPECT_TRUE(!flags[i] || perhaps) << "triangle " << i << " does not reach into the close range";
        selected += static_cast<int>(flags[i]);
        undecided += perhaps && !surely;
    }
    EXPECT_GT(selected, 500);
    EXPECT_LT(selected, 19'000);
    EXPECT_LT(undecided, 20);
}

TEST_F(TriangleClassifierTest, AgreesWithAQuadraticProgrammeOnRandomTriangles) {
    on_each_device([](Device& device) {
        for (const SceneCamera& camera : cameras_of_each_kind()) {
            expect_agreement(device, camera);
        }
    });
}

TEST_F(TriangleClassifierTest, CentroidsOfSelectedTriangles) {
    on_each_device([](Device& device) {
        const std::vector<Vertex> vertices{
            {{0, 0, 0}, 0, {}, 0}, {{3, 0, 6}, 0, {}, 0}, {{0, 9, 0}, 0, {}, 0}, {{-3, 0, 0}, 0, {}, 0}};
        const std::vector<Triangle> triangles{{0, 1, 2, 0}, {0, 2, 3, 0}};
        Buffer<Vec3> centroids(device, 2);
        TriangleClassifier(device).centroids(Buffer<Vertex>(device, vertices),
                                             Buffer<Triangle>(device, triangles),
                                             Buffer<uint>(device, std::vector<uint>{1, 0}), 2, centroids);
        const std::vector<Vec3> result = centroids.download();
        EXPECT_NEAR(length(result[0] - Vec3{-1, 3, 0}), 0.0f, 1e-6f);
        EXPECT_NEAR(length(result[1] - Vec3{1, 3, 2}), 0.0f, 1e-6f);
    });
}

}  // namespace
}  // namespace nearlight::core
