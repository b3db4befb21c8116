// SPDX-License-Identifier: Apache-2.0
// Rays that leave a triangle, and segments that end on it, do not meet it, whatever its shape, its size and
// its place; and they start so close to it that hardly anything fits in between.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/base/random.h"
#include "host/scene/ray_epsilon.h"
#include "tests/support/device_fixture.h"
#include "tests/support/kernel_probe.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::KernelProbe;
using test::SceneOnDevice;

class StandOffTest : public test::DeviceTest {};

constexpr std::size_t kTrianglesOfAKind = 2000;
constexpr std::size_t kLeavingRays = 50'000;

/// What triangles of a scene are like.
struct Kind {
    const char* name;
    float size;      ///< longest edge, m
    float width;     ///< height over that edge ÷ size
    float distance;  ///< of their middles from the origin, at most, m
    bool is_level;   ///< parallel to the x-z plane, and all at one height
    float reach;     ///< of one more triangle that is far away, from the origin, m; 0: there is none
    float most_off;  ///< no ray may start farther off one of them, m
};

Vec3 random_direction(Pcg32& random) {
    const float z = 2.0f * random.uniform() - 1.0f;
    const float angle = 2.0f * kPi * random.uniform();
    const float r = std::sqrt(1.0f - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}

Scene triangles_of(const Kind& kind) {
    Scene scene;
    scene.materials.assign(1, lambertian({0.5f, 0.5f, 0.5f}));
    Pcg32 random(3);
    for (uint i = 0; i < kTrianglesOfAKind; ++i) {
        Vec3 along = random_direction(random);
        Vec3 middle = random_direction(random) * (kind.distance * random.uniform());
        Vec3 up = random_direction(random);
        if (kind.is_level) {
            along = normalize(Vec3{along.x, 0, along.z});
            middle.y = 0.75f;
            up = {0, 1, 0};
        }
        const Vec3 across = normalize(cross(along, up)) * (kind.width * kind.size);
        const Vec3 first = middle - along * (0.5f * kind.size);
        add_triangle(scene, first, first + along * kind.size, middle + across, 0);
    }
    if (kind.reach > 0) {
        const Vec3 corner{kind.reach, kind.reach, kind.reach};
        add_triangle(scene, corner, {-kind.reach, kind.reach, 0}, {0, kind.reach, -kind.reach}, 0);
    }
    return scene;
}

constexpr Kind kKinds[] = {
    {"of a room", 1, 0.5f, 5, false, 0, 3e-5f},
    {"of a room's walls", 5, 0.8f, 3, false, 0, 5e-5f},
    {"small ones", 0.01f, 0.5f, 2, false, 0, 1.5e-5f},
    {"slivers", 1, 1e-3f, 5, false, 0, 1.5e-4f},
    {"small ones in a dome", 0.01f, 0.5f, 2, false, 1e5f, 1.5e-4f},
    {"a kilometre away", 1, 0.5f, 1000, false, 0, 3e-3f},
    {"of a level plain of 10 km", 10'000, 0.8f, 10, true, 0, 1e-3f},
};

/// How far each ray starts off its triangle, and a number of two bits. Bit 0: the ray met the triangle. Bit
/// 1: a segment that ends where the ray starts met it. Directions near the horizon are as likely as all
/// others together.
const char* const kProbe = R"(
#include "lib/light/triangle.cl"
#include "lib/random.cl"
kernel void probe(SCENE_PARAMETERS, uint count, global uint* out, global float* stand_offs) {
    const uint i = (uint)get_global_id(0);
    if (i >= count) {
        return;
    }
    const SceneView scene = SCENE_VIEW;
    const uint triangle = i % scene.info->triangle_count;
    const uint4 random = random_uint4((uint4)(i, 1, 2, 3));
    const float2 weights =
        square_to_triangle((float2)(to_unit_float(random.x), to_unit_float(random.y)));
    float3 normal;
    triangle_point(&scene, triangle, weights, &normal);
    const float2 circle = circle_point(to_unit_float(random.z));
    const float u = to_unit_float(random.w);
    const float cosine = i % 2 == 0 ? u : 0.02f + 0.05f * u;
    const float sine = sqrt(1.0f - cosine * cosine);
    const float3 direction = to_world_frame((float3)(sine * circle, cosine), normal);
    const SurfaceHit at = surface_met_at(&scene, triangle, weights, -direction);
    const float3 origin = ray_origin(&at, direction);
    const SurfaceHit next = trace_surface(&scene, origin, direction, INFINITY);
    const float far = fmin(10.0f * max_component(fabs(origin)), scene.info->extent);
    const float3 from = origin + far * direction;
    const SurfaceHit last =
        trace_between(&scene, from, origin - from, 0.999f, NEARLIGHT_SEGMENT_T_MAX);
    stand_offs[i] = at.stand_off;
    out[i] = (next.t >= 0.0f && next.triangle == triangle ? 1 : 0) |
             (last.t >= 0.0f && last.triangle == triangle ? 2 : 0);
}
)";

TEST_F(StandOffTest, NothingMeetsTheTriangleThatItLeaves) {
    for (const Kind& kind : kKinds) {
        SCOPED_TRACE(kind.name);
        const Scene scene = triangles_of(kind);
        on_each_ray_tree([&](Device& device) {
            KernelProbe probe(device, kProbe);
            const SceneOnDevice on_device(probe.device(), scene);
            Buffer<uint> met(probe.device(), kLeavingRays);
            Buffer<float> stand_offs(probe.device(), kLeavingRays);
            probe.kernel().launch(kLeavingRays, 8, on_device.buffers, static_cast<uint>(kLeavingRays), met,
                                  stand_offs);
            const std::vector<float> found_offs = stand_offs.download();
            for (uint i = 0; i < scene.triangles.size(); ++i) {
                const float expected = triangle_stand_off(scene, i, bounds(scene).size());
                ASSERT_NEAR(found_offs[i], expected, 1e-3f * expected) << i;
            }
            const std::vector<uint> found = met.download();
            EXPECT_EQ(std::ranges::count_if(found, [](uint bits) { return (bits & 1) != 0; }), 0);
            EXPECT_EQ(std::ranges::count_if(found, [](uint bits) { return (bits & 2) != 0; }), 0);
        });
    }
}

TEST_F(StandOffTest, RaysStartCloseToTheirTriangle) {
    for (const Kind& kind : kKinds) {
        const Scene scene = triangles_of(kind);
        const Vec3 size = bounds(scene).size();
        float most = 0;
        for (uint i = 0; i < kTrianglesOfAKind; ++i) {
            most = std::max(most, triangle_stand_off(scene, i, size));
        }
        EXPECT_GT(most, 0.0f) << kind.name;
        EXPECT_LT(most, kind.most_off) << kind.name;
    }
}

}  // namespace
}  // namespace nearlight::core
