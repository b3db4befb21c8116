// SPDX-License-Identifier: Apache-2.0
#include "host/bench/gather_bench.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/bench/embree_occlusion.h"
#include "host/bench/gather_workload.h"
#include "host/bench/synthetic_scene.h"
#include "host/bvh/segment_distance.h"
#include "host/reference/reference_gather.h"
#include "tests/support/device_fixture.h"

namespace nearlight::test {
namespace {

/// What a camera sees of a room full of noisy spheres, and VPLs in it.
struct Workload {
    Scene scene;
    Bvh bvh;
    std::vector<ReceiverPacket> receivers;
    std::vector<Vpl> vpls;
};

Workload make_workload(std::size_t triangles, int side, std::size_t vpls) {
    Workload work;
    work.scene = make_sphere_room(triangles);
    work.bvh = build_scene_bvhs(work.scene).opaque;
    work.receivers = make_camera_receivers(work.scene, work.bvh, side, side);
    work.vpls = make_traced_vpls(work.scene, work.bvh, vpls);
    return work;
}

constexpr float kClampRadius = 0.05f;

class GatherBenchTest : public DeviceTest {
  protected:
    /// One gather of the work; `pairs` says what became of each pair.
    static std::vector<IrradiancePacket> gather(Device& device, GatherKernel kernel, const Workload& work,
                                                std::vector<GatherPair>& pairs) {
        const Buffer<BvhNode> nodes(device, work.bvh.nodes);
        const Buffer<BvhTriangle> triangles(device, work.bvh.triangles);
        const Buffer<Vpl> vpls(device, work.vpls);
        const Buffer<ReceiverPacket> receivers(device, work.receivers);
        Buffer<IrradiancePacket> irradiance(device, work.receivers.size());
        Gatherer gatherer(device, {kernel});
        pairs = gatherer.gather_recorded(
            {nodes, triangles, vpls, vpls.count(), receivers, receivers.count(), kClampRadius}, irradiance);
        return irradiance.download();
    }
};

/// Receivers whose irradiance differs by more than rounding.
std::size_t count_different(const std::vector<IrradiancePacket>& a, const std::vector<IrradiancePacket>& b) {
    std::size_t count = 0;
    for (std::size_t p = 0; p < a.size(); ++p) {
        for (int i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
            count += std::abs(a[p].g[i] - b[p].g[i]) > 1e-4f * b[p].g[i] + 1e-9f ? 1 : 0;
        }
    }
    return count;
}

TEST_F(GatherBenchTest, EveryRayAgreesWithEmbreeButForEdges) {
    const Workload work = make_workload(25'000, 96, 64);
    const EmbreeOcclusion embree(work.scene, work.bvh.triangle_ids);
    const double tolerance = 1e-5 * max_component(bounds(work.scene).size());
    on_each_device([&](Device& device) {
        for (const GatherKernel kernel : {GatherKernel::packets, GatherKernel::rays}) {
            std::vector<GatherPair> pairs;
            gather(device, kernel, work, pairs);
            const std::span is_ray(reinterpret_cast<const std::uint8_t*>(pairs.data()), pairs.size());
            const OcclusionResult reference =
                embree.trace({work.vpls, work.receivers, is_ray}, {1, false, false}, 2, true);
            ASSERT_GT(reference.rays, 100'000u);
            std::size_t different = 0;
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                if ((pairs[i] == GatherPair::occluded) == (reference.occluded_pairs[i] != 0)) {
                    continue;
                }
                ++different;
                const std::size_t block = i / NEARLIGHT_PACKET_SIZE;
                const Vec3 from = work.vpls[block % work.vpls.size()].position;
                const ReceiverPacket& packet = work.receivers[block / work.vpls.size()];
                const std::size_t lane = i % NEARLIGHT_PACKET_SIZE;
                const Vec3 to{packet.px[lane], packet.py[lane], packet.pz[lane]};
                EXPECT_LE(distance_to_edges(work.bvh.triangles, from, to), tolerance) << "pair " << i;
            }
            EXPECT_LE(static_cast<double>(different), 1.0 + 1e-5 * static_cast<double>(reference.rays));
        }
    });
}

TEST_F(GatherBenchTest, IrradianceAgreesWithTheReferenceGather) {
    const Workload work = make_workload(10'000, 64, 100);
    const EmbreeScene embree(work.scene);
    std::vector<IrradiancePacket> expected(work.receivers.size());
    gather_reference(embree, work.vpls, kClampRadius, work.receivers, expected);
    on_each_device([&](Device& device) {
        for (const GatherKernel kernel : {GatherKernel::packets, GatherKernel::rays}) {
            std::vector<GatherPair> pairs;
            // One ray at an edge in 1e5 changes one receiver.
            EXPECT_LE(count_different(gather(device, kernel, work, pairs), expected), 5u);
        }
    });
}

TEST_F(GatherBenchTest, AllWaysToAskEmbreeAgree) {
    const Workload work = make_workload(5'000, 32, 70);
    const EmbreeOcclusion embree(work.scene, work.bvh.triangle_ids);
    const std::vector<std::uint8_t> every_other = [&] {
        std::vector<std::uint8_t> rays(work.receivers.size() * work.vpls.size() * NEARLIGHT_PACKET_SIZE);
        for (std::size_t i = 0; i < rays.size(); i += 2) {
            rays[i] = 1;
        }
        return rays;
    }();
    std::vector<OcclusionResult> results;
    for (const int width : {1, 16}) {
        for (const bool coherent : {false, true}) {
            results.push_back(
                embree.trace({work.vpls, work.receivers, every_other}, {width, coherent, coherent}, 2, true));
        }
    }
    for (const OcclusionResult& result : results) {
        EXPECT_EQ(result.rays, every_other.size() / 2);
        EXPECT_GT(result.occluded, result.rays / 100);
        EXPECT_GT(result.seconds, 0.0);
        std::size_t different = 0;
        for (std::size_t i = 0; i < every_other.size(); ++i) {
            different += result.occluded_pairs[i] != results.front().occluded_pairs[i] ? 1 : 0;
        }
        EXPECT_LE(different, 5u);
    }
}

TEST_F(GatherBenchTest, ResultIsConsistent) {
    const Scene scene = make_sphere_room(3'000);
    const Bvh bvh = build_scene_bvhs(scene).opaque;
    on_each_device([&](Device& device) {
        GatherBenchConfig config;
        config.vpl_count = 20;
        config.width = 40;
        config.height = 24;
        config.repeats = 3;
        const GatherBenchResult result = bench_gather(device, scene, bvh, config);
        EXPECT_EQ(result.triangles, scene.triangles.size());
        EXPECT_EQ(result.pairs, 40u * 24u * 20u);  // the room is closed: every pixel has a receiver
        EXPECT_GT(result.rays, result.pairs / 10);
        EXPECT_LT(result.rays, result.pairs);
        EXPECT_GT(result.occluded_fraction, 0.0);
        EXPECT_LT(result.occluded_fraction, 1.0);
        EXPECT_LE(result.disagreements, 1u);
        EXPECT_GT(result.nearlight_mrays, 0.0);
        EXPECT_GT(result.ratio_embree1, 0.0);
        EXPECT_GT(result.ratio_embree16, 0.0);
        EXPECT_EQ(result.device, device.name());
    });
}

TEST(GatherWorkload, VplsOfASceneWithoutLampsLieOnItsSurfaces) {
    Scene scene = make_sphere_room(3'000);
    for (Material& material : scene.materials) {
        material.emission = {0, 0, 0};
    }
    const Bvh bvh = build_scene_bvhs(scene).opaque;
    const std::vector<Vpl> vpls = make_traced_vpls(scene, bvh, 200);
    ASSERT_EQ(vpls.size(), 200u);
    for (const Vpl& vpl : vpls) {
        EXPECT_NEAR(length(vpl.normal), 1.0f, 1e-5f);
        const BvhHit hit = closest_hit(bvh, vpl.position, -vpl.normal, 0.0f, 1.0f);
        EXPECT_LT(hit.t, 1e-3f);
    }
}

}  // namespace
}  // namespace nearlight::test
