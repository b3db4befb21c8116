// SPDX-License-Identifier: Apache-2.0
// What rays of camera and receivers carry, as kernels/lib/path_ray.cl and receiver_path.cl count it.
#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "host/scene/material_model.h"
#include "tests/support/bsdf_materials.h"
#include "tests/support/device_fixture.h"
#include "tests/support/kernel_probe.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::KernelProbe;
using test::SceneOnDevice;

class PathRayTest : public test::DeviceTest {};

TEST_F(PathRayTest, GlassDoesNotMakeAPathWeak) {
    Scene scene;
    Material diamond = test::make_glass(0, 0, 0);
    diamond.eta = {2.4f, 1, 1};
    const int material = add_material(scene, diamond);
    add_quad(scene, {-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, material);  // faces the ray
    add_quad(scene, {-1, -1, 2}, {2, 0, 0}, {0, 2, 0}, material);
    on_each_ray_tree([&](Device& device) {
        KernelProbe probe(device, R"(
#include "lib/receiver_path.cl"
kernel void probe(SCENE_PARAMETERS, global float* out) {
    const SceneView scene = SCENE_VIEW;
    PathRay ray = first_ray((float3)(0.0f, 0.0f, 1.0f));
    const LightReceiver from = even_receiver((float3)(0.1f, 0.2f, 0.0f), ray.direction);
    begin_ray(&ray, &from, 0.0f);
    for (uint surface = 0; surface < 2; ++surface) {
        const SurfaceHit hit = trace_surface(&scene, ray.origin, ray.direction, INFINITY);
        const SurfaceBsdf glass = surface_bsdf(&scene, &hit, ray.direction, BSDF_RADIANCE, 0.5f);
        scatter_ray(&scene, &ray, &hit, &glass, BSDF_S, 0.999f, (float2)(0.5f, 0.5f));
        PathRay rest = ray;
        out[4 * surface] = ray.throughput.x;
        out[4 * surface + 1] = ray.index;
        out[4 * surface + 2] = carried_part(&ray, (float3)(0.5f));
        out[4 * surface + 3] = survives(&rest, (float3)(1.0f), 1, 1.0f, 0.99f) ? rest.throughput.x : 0.0f;
    }
}
)");
        const SceneOnDevice on_device(probe.device(), scene);
        Buffer<float> out(probe.device(), 8);
        probe.kernel().launch(1, 1, on_device.buffers, out);
        const std::vector<float> seen = out.download();
        EXPECT_NEAR(seen[0], 1 / (2.4f * 2.4f), 1e-5f) << "radiance is larger within";
        EXPECT_NEAR(seen[1], 2.4f, 1e-5f);
        EXPECT_NEAR(seen[2], 0.5f, 1e-5f);
        EXPECT_EQ(seen[3], seen[0]) << "a path that carries all light goes on for sure";
        EXPECT_NEAR(seen[4], 1.0f, 1e-5f) << "beyond the glass";
        EXPECT_NEAR(seen[5], 1.0f, 1e-5f);
        EXPECT_NEAR(seen[6], 0.5f, 1e-5f);
        EXPECT_EQ(seen[7], seen[4]);
    });
}

/// What a rough metal reflects of equal lights at one point, by four light samples and three rays for each:
/// the mean of 1024 estimates.
double reflected(Device& device, int lights) {
    constexpr uint kCount = 1024;
    Scene scene;
    const uint metal = add_material(scene, test::make_metal(0.5f, 0.5f, 0, {0, 0, 0}, {1, 1, 1}));
    add_quad(scene, {-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, metal);  // faces the ray
    for (int i = 0; i < lights; ++i) {
        add_point_light(scene, {0.3f, 0, 0}, {1, 1, 1});
    }
    KernelProbe probe(device, R"(
#include "lib/path_ray.cl"
kernel void probe(SCENE_PARAMETERS, global float* out) {
    const SceneView scene = SCENE_VIEW;
    const float3 along = (float3)(0.0f, 0.0f, 1.0f);
    const SurfaceHit hit = trace_surface(&scene, (float3)(0.1f, 0.2f, 0.0f), along, INFINITY);
    const SurfaceBsdf metal = surface_bsdf(&scene, &hit, along, BSDF_RADIANCE, 0.5f);
    const LightQuota quota = {.samples = 4, .rays = 12};
    const uint key = (uint)get_global_id(0);
    out[key] = reflected_light(&scene, &hit, &metal, BSDF_S, &quota, key).x;
}
)");
    const SceneOnDevice on_device(probe.device(), scene);
    Buffer<float> out(probe.device(), kCount);
    probe.kernel().launch(kCount, 8, on_device.buffers, out);
    const std::vector<float> estimates = out.download();
    return std::accumulate(estimates.begin(), estimates.end(), 0.0) / kCount;
}

/// A few point lights are all summed, and of many each sample stands for all; rays never meet one.
TEST_F(PathRayTest, LightsWithoutAreaAreCountedOnceHoweverManyThereAre) {
    on_each_device([](Device& device) {
        const double one = reflected(device, 1);
        ASSERT_GT(one, 1e-3);
        EXPECT_NEAR(reflected(device, 3) / one, 3, 1e-4);
        EXPECT_NEAR(reflected(device, 40) / one, 40, 0.25)
            << "of 4096 samples whose weights differ by a tenth";
    });
}

/// The light of a square lamp that a ray of a density (per steradian) meets, weighted against light samples
/// of where the ray began.
float met(Device& device, int veils, float half_side, float pdf) {
    Scene scene;
    const uint white = add_material(scene, diffuse_material({1, 1, 1}));
    const uint veil = add_material(scene, mask_material(parameter_of(0.0f), white));
    for (int i = 1; i <= veils; ++i) {
        add_quad(scene, {-1, -1, static_cast<float>(i)}, {0, 2, 0}, {2, 0, 0}, veil);
    }
    Material shining = diffuse_material({0, 0, 0});
    shining.emission = parameter_of(5.0f);
    const float side = 2 * half_side;
    add_quad(scene, {0.1f - half_side, 0.2f - half_side, 4}, {0, side, 0}, {side, 0, 0},
             add_material(scene, shining));
    KernelProbe probe(device, R"(
#include "lib/path_ray.cl"
kernel void probe(SCENE_PARAMETERS, float pdf, global float* out) {
    const SceneView scene = SCENE_VIEW;
    PathRay ray = first_ray((float3)(0.0f, 0.0f, 1.0f));
    const LightReceiver from = even_receiver((float3)(0.1001f, 0.2002f, 0.0f), ray.direction);
    begin_ray(&ray, &from, pdf);
    SurfaceHit hit = trace_surface(&scene, ray.origin, ray.direction, INFINITY);
    while (hit.t > 0.0f && is_black(emitted_radiance(&scene, &hit))) {
        const SurfaceBsdf veil = surface_bsdf(&scene, &hit, ray.direction, BSDF_RADIANCE, 0.5f);
        scatter_ray(&scene, &ray, &hit, &veil, BSDF_D | BSDF_S, 0.5f, (float2)(0.5f, 0.5f));
        hit = trace_surface(&scene, ray.origin, ray.direction, INFINITY);
    }
    out[0] = met_light(&scene, &ray, &hit).x;
}
)");
    const SceneOnDevice on_device(probe.device(), scene);
    Buffer<float> out(probe.device(), 1);
    probe.kernel().launch(1, 1, on_device.buffers, pdf, out);
    return out.download()[0];
}

/// Light samples have the density of the whole distance, not of that from the last veil. Large lamps are
/// sampled by solid angle, and tiny ones by area, where the distance counts.
TEST_F(PathRayTest, VeilsDoNotChangeTheShareOfTheLightThatRaysMeet) {
    on_each_device([](Device& device) {
        for (const float half_side : {1.0f, 0.005f}) {
            const float pdf = half_side == 1.0f ? 0.5f : 1e5f;
            const float straight = met(device, 0, half_side, pdf);
            ASSERT_GT(straight, 0.1f);
            ASSERT_LT(straight, 4.9f) << "light samples should have their share";
            for (const int veils : {1, 2, 3}) {
                EXPECT_NEAR(met(device, veils, half_side, pdf), straight, 1e-3f * straight) << veils;
            }
        }
    });
}

}  // namespace
}  // namespace nearlight::core
