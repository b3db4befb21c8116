// SPDX-License-Identifier: Apache-2.0
// What rays of camera and receivers carry, as kernels/lib/path_ray.cl and receiver_path.cl count it.
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
    begin_ray(&ray, (float3)(0.1f, 0.2f, 0.0f), ray.direction, 0.0f);
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

}  // namespace
}  // namespace nearlight::core
