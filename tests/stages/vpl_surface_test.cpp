// SPDX-License-Identifier: Apache-2.0
// What a VPL takes from the surface that it lies on, whichever kernel makes it.
#include <gtest/gtest.h>

#include <algorithm>

#include "host/base/packed_direction.h"
#include "host/stages/light_tracer.h"
#include "host/stages/patch_vpls.h"
#include "host/stages/reverse_vpls.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::SceneOnDevice;

constexpr Vec3 kWall{0, 0, -1};  ///< the normal of the wall
constexpr float kDistance = 1.0f;

constexpr float kWallAlbedo = 0.5f;

/// A wall, with or without a coat, before the origin, where a point light is. Its vertices have a normal that
/// leans.
struct LeaningWall {
    Scene scene;
    uint curve = 0;
    Vec3 shading = normalize({0.6f, 0.4f, -1.0f});

    explicit LeaningWall(bool has_coat = true) {
        constexpr Vec3 kGrey{kWallAlbedo, kWallAlbedo, kWallAlbedo};
        const Material material = has_coat ? coated(scene, kGrey, {.eta = 1.5}) : lambertian(kGrey);
        curve = material.curve;
        add_quad(scene, {-1, -1, kDistance}, {0, 2, 0}, {2, 0, 0}, add_material(scene, material));
        for (Vertex& vertex : scene.vertices) {
            vertex.normal = shading;
        }
        add_point_light(scene, {0, 0, 0}, {1, 1, 1});
    }
};

void expect_of_wall(const std::vector<Vpl>& vpls, const LeaningWall& wall, uint depth) {
    ASSERT_FALSE(vpls.empty());
    ASSERT_NE(wall.curve, 0u);
    for (const Vpl& vpl : vpls) {
        EXPECT_EQ(vpl.normal, kWall);
        EXPECT_EQ(vpl.depth, depth);
        EXPECT_EQ(vpl.flags >> NEARLIGHT_VPL_CURVE_SHIFT, wall.curve);
        EXPECT_EQ(vpl.flags & NEARLIGHT_VPL_MAPPED, 0u);
        EXPECT_NE(vpl.flags & NEARLIGHT_VPL_TILTED, 0u);
        // The kernel interpolates three normals, and rounds the result to one of two codes.
        const uint expected = pack_direction(wall.shading);
        EXPECT_NEAR(vpl.shading & 0xffffu, expected & 0xffffu, 1.0);
        EXPECT_NEAR(vpl.shading >> 16u, expected >> 16u, 1.0);
    }
}

class VplSurfaceTest : public test::DeviceTest {};

TEST_F(VplSurfaceTest, PatchesTakeItsNormalsAndCurve) {
    const LeaningWall wall;
    on_each_ray_tree([&](Device& device) {
        const SceneOnDevice on_device(device, wall.scene);
        SurfaceSample sample{};
        sample.position = {0.1f, 0.2f, kDistance};
        sample.normal = kWall;
        CloseRegion region;
        region.range = Buffer<CloseRange>(device, std::vector<CloseRange>(1));
        region.whole_triangles = true;
        Buffer<Vpl> vpls(device, 2);
        Buffer<uint> flags(device, 2);
        PatchVpls(device).run(on_device.buffers, Buffer<SurfaceSample>(device, std::vector{sample}), 1,
                              region, 0.25f, vpls, flags);
        ASSERT_EQ(flags.download(), (std::vector<uint>{1, 0})) << "the wall has one side";
        expect_of_wall({vpls.download_one(0)}, wall, 0);
    });
}

TEST_F(VplSurfaceTest, DepositsOfWalksTakeItsNormalsAndCurve) {
    const LeaningWall wall;
    on_each_ray_tree([&](Device& device) {
        const SceneOnDevice on_device(device, wall.scene);
        CloseRegion region;
        region.range = Buffer<CloseRange>(device, std::vector<CloseRange>(1));
        region.triangles = Buffer<uint>(device, std::vector<uint>(wall.scene.triangles.size()));
        expect_of_wall(LightTracer(device).run(on_device.buffers, region, KeepDeposits::all,
                                               {.walk_count = 200, .bounce_count = 2, .seed = 3}),
                       wall, 1);
    });
}

/// ∫ ρ·max(cosθ, 0)/r² over the wall, where θ is the angle to the normal that leans.
double reflected_by(const LeaningWall& wall) {
    constexpr int kSteps = 400;
    double sum = 0;
    for (int i = 0; i < kSteps * kSteps; ++i) {
        const Vec3 place{(2.0f * static_cast<float>(i % kSteps) + 1) / kSteps - 1,
                         (2.0f * static_cast<float>(i / kSteps) + 1) / kSteps - 1, kDistance};
        const float distance = length(place);
        const float cosine = -dot(place, wall.shading) / distance;
        sum += static_cast<double>(std::max(cosine, 0.0f) / (distance * distance)) * 4 / (kSteps * kSteps);
    }
    return kWallAlbedo * sum;
}

TEST_F(VplSurfaceTest, DepositsReflectWhatArrivesByTheNormalThatLeans) {
    const LeaningWall wall(false);
    const double expected = reflected_by(wall);
    on_each_ray_tree([&](Device& device) {
        const SceneOnDevice on_device(device, wall.scene);
        CloseRegion region;
        region.range = Buffer<CloseRange>(device, std::vector<CloseRange>(1));
        region.triangles = Buffer<uint>(device, std::vector<uint>(wall.scene.triangles.size()));
        double power = 0;
        for (const Vpl& vpl :
             LightTracer(device).run(on_device.buffers, region, KeepDeposits::all,
                                     {.walk_count = 100'000, .bounce_count = 1, .seed = 5})) {
            power += vpl.power.y;
            ASSERT_LT(vpl.position.z, kDistance) << "it should stand off the wall";
            ASSERT_GT(vpl.position.z, 0.999f * kDistance);
        }
        EXPECT_NEAR(power, expected, 0.01 * expected);
    });
}

TEST_F(VplSurfaceTest, ReverseVplsTakeItsNormalsAndCurve) {
    const LeaningWall wall;
    on_each_ray_tree([&](Device& device) {
        const SceneOnDevice on_device(device, wall.scene);
        Gatherer gatherer(device);
        const Importon origin{
            .position = {0, 0, 0}, .pad0 = 0, .normal = -kWall, .flags = 0, .response = {1, 1, 1}, .pad1 = 0};
        const CameraPoints points = make_camera_points(device, std::span(&origin, 1), 100);
        expect_of_wall(ReverseVpls(device, gatherer).trace(on_device.buffers, points, 4), wall, 0);
    });
}

}  // namespace
}  // namespace nearlight::core
