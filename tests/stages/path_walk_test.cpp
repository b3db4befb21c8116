// SPDX-License-Identifier: Apache-2.0
// The light that local lights reflect, as kernels/lib/path_walk.cl finds it.
#include <cmath>
#include <numeric>

#include "host/base/packed_direction.h"
#include "tests/support/device_fixture.h"
#include "tests/support/kernel_probe.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::KernelProbe;
using test::SceneOnDevice;

class PathWalkTest : public test::DeviceTest {};

/// Irradiance at the origin about +Z from the first of four VPLs of power π, which is asked for all of them:
/// the green channel, for paths of at most `max_depth`.
float connected_light(KernelProbe& probe, const SceneOnDevice& scene, const Vpl& vpl, float radius,
                      uint max_depth) {
    Buffer<float> out(probe.device(), 1);
    probe.kernel().launch(1, 1, scene.buffers, Buffer<Vpl>(probe.device(), std::vector<Vpl>(4, vpl)),
                          Buffer<float>(probe.device(), std::vector<float>(4, radius)), max_depth, out);
    return out.download_one(0);
}

TEST_F(PathWalkTest, ConnectionsAreBoundedByTheRadiusOfTheVpl) {
    Scene roof;
    add_quad(roof, {5, -1, 1.3f}, {2, 0, 0}, {0, 2, 0}, add_material(roof, lambertian({0.5f, 0.5f, 0.5f})));
    Vpl above{};
    above.position = {0, 0, 2};
    above.depth = 2;
    above.normal = {0, 0, -1};
    above.power = {0, kPi, 0};
    Vpl behind_roof = above;
    behind_roof.position = {9, 0, 2};
    behind_roof.normal = normalize({-9, 0, -2});
    Vpl from_behind = above;
    from_behind.flags = NEARLIGHT_VPL_TILTED;
    from_behind.shading = pack_direction(normalize({1, 0, 0.1f}));
    on_each_ray_tree([&](Device& device) {
        KernelProbe probe(device, R"(
#include "lib/path_walk.cl"
kernel void probe(SCENE_PARAMETERS, const global Vpl* vpls, const global float* radii, uint max_depth, global float* out) {
    const SceneView scene = SCENE_VIEW;
    const ReceiverPoint at = {(float3)(0.0f), (float3)(0.0f, 0.0f, 1.0f), (float3)(0.0f), 0};
    const Connections to = {vpls, radii, 4, 1, {1.0f, 1.0f, INFINITY, 0}};
    out[0] = connected_irradiance(&scene, &to, &at, max_depth, 0.5f).y;
}
)");
        const SceneOnDevice scene(probe.device(), roof);
        EXPECT_NEAR(connected_light(probe, scene, above, 1.0f, 2), 4 / 4.0f, 1e-5f) << "4 VPLs, distance 2";
        EXPECT_NEAR(connected_light(probe, scene, above, 4.0f, 2), 4 / 16.0f, 1e-5f) << "within the radius";
        EXPECT_EQ(connected_light(probe, scene, above, 1.0f, 1), 0.0f) << "of too deep a path";
        EXPECT_EQ(connected_light(probe, scene, behind_roof, 1.0f, 2), 0.0f) << "hidden";
        EXPECT_EQ(connected_light(probe, scene, from_behind, 1.0f, 2), 0.0f) << "by its shading normal";
    });
}

/// Mean irradiance, G, by short walks from a point with the normal `up` · (0, 0, 1), without any VPL and with
/// a radius that leaves all light to the walks.
double walked_light(Device& device, const Scene& scene, float up, uint max_edges) {
    constexpr uint kWalks = 16384;
    KernelProbe probe(device, R"(
#include "lib/path_walk.cl"
kernel void probe(SCENE_PARAMETERS, float up, uint max_edges, global float* out) {
    const uint i = (uint)get_global_id(0);
    const SceneView scene = SCENE_VIEW;
    const ReceiverPoint at = {(float3)(0.0f), (float3)(0.0f, 0.0f, up), (float3)(0.0f), 0};
    const Connections to = {0, 0, 0, 0, {1e6f, 1e6f, INFINITY, 0}};
    out[i] = short_walk_irradiance(&scene, &to, &at, max_edges, 1, i).y;
}
)");
    const SceneOnDevice on_device(probe.device(), scene);
    Buffer<float> out(probe.device(), kWalks);
    probe.kernel().launch(kWalks, 8, on_device.buffers, up, max_edges, out);
    const std::vector<float> light = out.download();
    return std::accumulate(light.begin(), light.end(), 0.0) / kWalks;
}

TEST_F(PathWalkTest, ShortWalksFindLampsByRaysToo) {
    Scene scene;
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{1, 2, 3});
    add_quad(scene, {-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, add_material(scene, lamp));
    // ∫ cos²θ/r² over a quarter of the lamp
    const double quarter = std::sqrt(0.5) * std::atan(std::sqrt(0.5));
    on_each_ray_tree([&](Device& device) {
        EXPECT_NEAR(walked_light(device, scene, 1, 1), 2 * 4 * quarter, 0.01 * 2 * 4 * quarter);
    });
}

/// A light in the middle of a sphere makes it shine evenly, so that every point within receives ρ·I/R².
TEST_F(PathWalkTest, ShortWalksBringWhatSurfacesReflect) {
    constexpr float kAlbedo = 0.5f;
    Scene scene;
    add_inward_sphere(scene, 2.0f, 4, add_material(scene, lambertian({kAlbedo, kAlbedo, kAlbedo})));
    add_point_light(scene, {0, 0, 0.5f}, {8, 8, 8});
    for (Vertex& vertex : scene.vertices) {
        vertex.position.z += 0.5f;  // the light is in the middle, and behind the receiver
    }
    on_each_ray_tree([&](Device& device) {
        EXPECT_NEAR(walked_light(device, scene, -1, 1), 0.0, 1e-6);
        EXPECT_NEAR(walked_light(device, scene, -1, 2), kAlbedo * 8 / 4, 0.01 * kAlbedo * 8 / 4);
        EXPECT_NEAR(walked_light(device, scene, -1, 3), (kAlbedo + kAlbedo * kAlbedo) * 8 / 4, 0.03);
    });
}

}  // namespace
}  // namespace nearlight::core
