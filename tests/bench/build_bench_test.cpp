// SPDX-License-Identifier: Apache-2.0
#include "host/bench/build_bench.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/base/receivers.h"
#include "host/bench/embree_trees.h"
#include "host/reference/gather_workload.h"
#include "host/reference/synthetic_scene.h"

namespace nearlight::core {
namespace {

using testing::IsEmpty;

constexpr int kSide = 64;
constexpr std::size_t kVpls = 8;

std::vector<uint> all_triangles(const Scene& scene) {
    return distinct_triangles(build_scene_bvh(scene));
}

TEST(EmbreeTrees, AreSoundInOurLayout) {
    const Scene scene = make_sphere_room(5000);
    const std::vector<uint> ids = all_triangles(scene);
    for (const EmbreeQuality quality : {EmbreeQuality::medium, EmbreeQuality::high}) {
        const Bvh bvh = build_embree_bvh(scene, ids, quality);
        EXPECT_THAT(check_bvh(bvh, scene, ids), IsEmpty());
        const Seconds seconds = seconds_of_embree_build(scene, ids, quality);
        EXPECT_GT(seconds.wall, 0.0);
        EXPECT_GT(seconds.processor, 0.0);
    }
}

TEST(TreeSteps, CountWhatAPlainTraversalFinds) {
    const Scene scene = make_sphere_room(3000);
    const Bvh bvh = build_bvh(scene, all_triangles(scene));
    const std::vector<Vpl> vpls = make_traced_vpls(scene, bvh, kVpls);
    const std::vector<ReceiverPacket> receivers = make_camera_receivers(scene, bvh, kSide, kSide);
    std::uint64_t rays = 0;
    std::uint64_t occluded_rays = 0;
    for (const Vpl& vpl : vpls) {
        for (const ReceiverPacket& packet : receivers) {
            for (std::size_t i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
                const auto [position, normal] = receiver_at(packet, i);
                const Vec3 d = position - vpl.position;
                if (dot(d, vpl.normal) > 0.0f && dot(d, normal) < 0.0f) {
                    ++rays;
                    occluded_rays +=
                        occluded(bvh, vpl.position, d, NEARLIGHT_SEGMENT_T_MIN, NEARLIGHT_SEGMENT_T_MAX) ? 1
                                                                                                         : 0;
                }
            }
        }
    }
    const TreeSteps one = count_steps(bvh, vpls, receivers, 1);
    EXPECT_EQ(one.rays, rays);
    EXPECT_EQ(one.occluded, occluded_rays);
    EXPECT_GT(one.nodes_per_packet, one.nodes_per_ray);  // a packet visits the nodes of all its rays
    const TreeSteps four = count_steps(bvh, vpls, receivers, 4);
    EXPECT_EQ(four.nodes_per_ray, one.nodes_per_ray);
    EXPECT_EQ(four.triangles_per_packet, one.triangles_per_packet);
}

TEST(BuildBench, DescribesFourTreesOverTheSameRays) {
    BuildBenchConfig config;
    config.vpl_count = kVpls;
    config.width = kSide;
    config.height = kSide;
    config.tile_stride = 4;
    config.repeats = 1;
    const BuildBenchResult result = bench_build(make_sphere_room(4000), config);
    ASSERT_EQ(result.trees.size(), 4u);
    for (const BuiltTree& tree : result.trees) {
        SCOPED_TRACE(tree.name);
        EXPECT_GT(tree.seconds.wall, 0.0);
        EXPECT_GT(tree.seconds.processor, 0.0);
        EXPECT_GT(tree.sah_cost, 1.0);
        EXPECT_GE(tree.duplication, 0.0);
        EXPECT_EQ(tree.steps.rays, result.trees[0].steps.rays);
        EXPECT_EQ(tree.steps.occluded, result.trees[0].steps.occluded);
    }
    EXPECT_EQ(result.trees[0].duplication, 0.0);
    EXPECT_GT(result.ratio_seconds, 0.0);
    EXPECT_GT(result.ratio_processor_seconds, 0.0);
}

}  // namespace
}  // namespace nearlight::core
