// SPDX-License-Identifier: Apache-2.0
#include "host/bench/trace_bench.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/bench/embree_rays.h"
#include "host/bvh/bvh.h"
#include "host/reference/gather_workload.h"
#include "host/reference/synthetic_scene.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core::test {
namespace {

std::vector<uint> all_triangles(const Scene& scene) {
    return distinct_triangles(build_scene_bvh(scene));
}

TEST(TraceBench, CameraRaysFindTheReceivers) {
    const Scene scene = make_sphere_room(2000);
    const Bvh bvh = build_scene_bvh(scene);
    const std::vector<RayQuery> rays = make_camera_rays(scene, 20, 12);
    ASSERT_EQ(rays.size(), 20u * 12u);
    std::size_t hits = 0;
    for (const RayQuery& ray : rays) {
        EXPECT_NEAR(length(ray.direction), 1.0f, 1e-5f);
        hits += closest_hit(bvh, ray.origin, ray.direction, ray.t_min, ray.t_max).triangle != ~0u ? 1u : 0u;
    }
    std::size_t receivers = 0;
    for (const ReceiverPacket& packet : make_camera_receivers(scene, bvh, 20, 12)) {
        for (int i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
            receivers += packet.nx[i] != 0.0f || packet.ny[i] != 0.0f || packet.nz[i] != 0.0f ? 1u : 0u;
        }
    }
    EXPECT_EQ(hits, receivers);
}

TEST(TraceBench, WalkRaysGoOnFromWhereTheLastOneEnded) {
    const Scene scene = make_sphere_room(2000);
    const Bvh bvh = build_scene_bvh(scene);
    const std::vector<RayQuery> rays = make_walk_rays(scene, bvh, 1000);
    ASSERT_EQ(rays.size(), 1000u);
    std::size_t continued = 0;
    for (std::size_t i = 1; i < rays.size(); ++i) {
        const RayQuery& last = rays[i - 1];
        const BvhHit hit = closest_hit(bvh, last.origin, last.direction, last.t_min, last.t_max);
        ASSERT_NE(hit.triangle, ~0u) << "the room is closed";
        continued += length(last.origin + last.direction * hit.t - rays[i].origin) < 1e-2f ? 1u : 0u;
    }
    EXPECT_GT(continued, 300u) << "most walks go on at least once";
    EXPECT_LT(continued, 999u) << "and end at some time";
}

TEST(TraceBench, AllOfEmbreesModesFindTheSameHits) {
    const Scene scene = make_sphere_room(3000);
    const Bvh bvh = build_scene_bvh(scene);
    const EmbreeRays embree(scene, all_triangles(scene));
    const std::vector<RayQuery> rays = make_walk_rays(scene, bvh, 1001);  // the last packet is not full
    std::vector<float> distances;
    for (const EmbreeMode& mode : all_embree_modes()) {
        const Seconds seconds = embree.trace(rays, mode, 2, distances);
        EXPECT_GT(seconds.processor, 0.0);
        ASSERT_EQ(distances.size(), rays.size());
        std::size_t differing = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const BvhHit hit =
                closest_hit(bvh, rays[i].origin, rays[i].direction, rays[i].t_min, rays[i].t_max);
            const bool same = hit.triangle == ~0u ? std::isinf(distances[i])
                                                  : std::abs(distances[i] - hit.t) <= 1e-4f * hit.t;
            differing += same ? 0 : 1;
        }
        EXPECT_LE(differing, 1u) << to_string(mode, "rtcIntersect");
    }
}

class TraceBenchOnDevice : public DeviceTest {};

TEST_F(TraceBenchOnDevice, AgreesWithEmbree) {
    const Scene scene = make_sphere_room(3000);
    on_each_device([&](Device& device) {
        const TraceBenchResult result =
            bench_trace(device, scene, {.width = 40, .height = 24, .walk_rays = 500, .repeats = 1});
        ASSERT_EQ(result.sets.size(), 2u);
        EXPECT_EQ(result.sets[0].rays, 40u * 24u);
        EXPECT_EQ(result.sets[1].rays, 500u);
        for (const RaySetResult& set : result.sets) {
            EXPECT_TRUE(set.agrees);
            EXPECT_GT(set.hits, set.rays / 2);
            EXPECT_EQ(set.tracers.size(), 9u);
            EXPECT_GT(set.ratio, 0.0);
        }
    });
}

}  // namespace
}  // namespace nearlight::core::test
