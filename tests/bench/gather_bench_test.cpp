// SPDX-License-Identifier: Apache-2.0
#include "host/bench/gather_bench.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "host/base/receivers.h"
#include "host/bench/agreement.h"
#include "host/bench/embree_occlusion.h"
#include "host/bvh/segment_distance.h"
#include "host/reference/gather_workload.h"
#include "host/reference/reference_gather.h"
#include "host/reference/synthetic_scene.h"
#include "host/scene/material_model.h"
#include "tests/support/device_fixture.h"

namespace nearlight::core::test {
namespace {

/// Receivers that a camera sees in a room full of noisy spheres, and VPLs in the room.
struct Workload {
    Scene scene;
    Bvh bvh;
    std::vector<ReceiverPacket> receivers;
    std::vector<Vpl> vpls;
};

Workload make_workload(std::size_t triangles, int side, std::size_t vpls) {
    Workload work;
    work.scene = make_sphere_room(triangles);
    work.bvh = build_scene_bvh(work.scene);
    work.receivers = make_camera_receivers(work.scene, work.bvh, side, side);
    work.vpls = make_traced_vpls(work.scene, work.bvh, vpls);
    return work;
}

constexpr float kClampRadius = 0.05f;

class GatherBenchTest : public DeviceTest {
  protected:
    /// One gather of the work; `pairs` gets the result of each pair.
    static std::vector<IrradiancePacket> gather(Device& device, GatherKernel kernel, const Workload& work,
                                                std::vector<GatherPair>& pairs) {
        const DeviceTree tree = upload_tree(device, work.bvh, kernel);
        const Buffer<Vpl> vpls(device, work.vpls);
        const Buffer<ReceiverPacket> receivers(device, work.receivers);
        GatherSums<Vpl> sums(device, work.receivers.size());
        Gatherer gatherer(device, {kernel});
        pairs = gatherer.gather_recorded(
            {tree, vpls, vpls.count(), receivers, receivers.count(), kClampRadius}, sums);
        return sums.light.download();
    }
};

/// Number of receivers whose irradiance differs by more than rounding.
std::size_t count_different(const std::vector<IrradiancePacket>& a, const std::vector<IrradiancePacket>& b) {
    std::size_t count = 0;
    for (std::size_t p = 0; p < a.size(); ++p) {
        for (int i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
            count += std::abs(a[p].g[i] - b[p].g[i]) > 1e-4f * b[p].g[i] + 1e-9f ? 1 : 0;
        }
    }
    return count;
}

TEST_F(GatherBenchTest, IrradianceAgreesWithTheReferenceGather) {
    const Workload work = make_workload(10'000, 64, 100);
    const EmbreeScene embree(work.scene);
    std::vector<IrradiancePacket> expected(work.receivers.size());
    gather_reference(embree, work.vpls, kClampRadius, work.receivers, expected);
    on_each_device([&](Device& device) {
        for (const GatherKernel kernel : {GatherKernel::packets, GatherKernel::rays}) {
            std::vector<GatherPair> pairs;
            // Of 1e5 rays, one may pass an edge and change a receiver.
            EXPECT_LE(count_different(gather(device, kernel, work, pairs), expected), 5u);
        }
    });
}

TEST_F(GatherBenchTest, EveryTracerAgreesButForEdges) {
    const Scene scene = make_sphere_room(25'000);
    const GatherSegments segments = make_camera_segments(scene, build_scene_bvh(scene), 64, 96, 96);
    const Bvh bvh = build_scene_bvh(segments.geometry);
    on_each_device([&](Device& device) {
        const GatherBenchResult result = bench_gather(device, segments, bvh, {.repeats = 1});
        EXPECT_TRUE(result.agrees);
        EXPECT_EQ(result.tracers.size(), 10u);
        EXPECT_GT(result.after_culling, 100'000u);
        for (const TracerFigures& tracer : result.tracers) {
            EXPECT_GT(tracer.occluded, tracer.rays / 100) << tracer.name;
            EXPECT_NEAR(static_cast<double>(tracer.rays), static_cast<double>(result.after_culling), 2.0);
        }
        for (const Disagreement& item : result.disagreements) {
            EXPECT_TRUE(item.excused);
            EXPECT_LE(item.distance, item.is_culling ? 1e-5 : result.edge_tolerance) << item.tracer;
        }
    });
}

TEST_F(GatherBenchTest, CountsAndRatiosFitTogether) {
    const Scene scene = make_sphere_room(3'000);
    const GatherSegments segments = make_camera_segments(scene, build_scene_bvh(scene), 20, 40, 24);
    const Bvh bvh = build_scene_bvh(segments.geometry);
    on_each_device([&](Device& device) {
        const GatherBenchResult result =
            bench_gather(device, segments, bvh, {.repeats = 3, .kernel = GatherKernel::rays});
        EXPECT_EQ(result.triangles, scene.triangles.size());
        EXPECT_EQ(result.device, device.name());
        EXPECT_EQ(result.pairs, 40u * 24u * 20u);  // the room is closed: every pixel has a receiver
        EXPECT_GT(result.after_culling, result.pairs / 10);
        EXPECT_LT(result.after_culling, result.pairs);
        ASSERT_EQ(result.tracers.size(), 9u);
        EXPECT_EQ(result.tracers[result.ours].name, "nearlight rays");
        EXPECT_EQ(result.tracers[result.embree1].embree_width, 1);
        EXPECT_EQ(result.tracers[result.embree16].embree_width, 16);
        for (const TracerFigures& tracer : result.tracers) {
            EXPECT_GT(tracer.median.wall, 0.0);
            EXPECT_GT(tracer.median.processor, 0.0);
            EXPECT_TRUE(tracer.embree_width != 1 ||
                        tracer.median.wall >= result.tracers[result.embree1].median.wall);
        }
        EXPECT_GT(result.wall1.median, 0.0);
        EXPECT_GT(result.wall16.median, 0.0);
    });
}

/// Segments through a room, and the answer that Embree gives.
struct Answered {
    Answered() {
        const Scene scene = make_sphere_room(3'000);
        segments = make_camera_segments(scene, build_scene_bvh(scene), 40, 64, 64);
        bvh = build_scene_bvh(segments.geometry);
        truth.rays = segments.rays;
        truth.occluded =
            EmbreeOcclusion(segments.geometry).trace(segments, {1, false, false}, 2, true).occluded;
    }
    GatherSegments segments;
    Bvh bvh;
    TracerAnswer truth;
};

/// Finds a segment that passes no edge closely.
std::pair<std::size_t, std::uint64_t> clear_ray(const Answered& room) {
    for (std::size_t word = 0; word < room.segments.rays.size(); ++word) {
        const std::uint64_t lane = room.segments.rays[word] & -room.segments.rays[word];
        if (lane == 0) {
            continue;
        }
        const Vec3 from = room.segments.vpls[word % room.segments.vpls.size()].position;
        const Vec3 to = receiver_at(room.segments.receivers[word / room.segments.vpls.size()],
                                    static_cast<std::size_t>(std::countr_zero(lane)))
                            .position;
        if (distance_to_edges(room.bvh.triangles, from, to) > 1e-3) {
            return {word, lane};
        }
    }
    return {0, 0};
}

TEST(Agreement, RefusesARayThatIsWrongAwayFromEdges) {
    const Answered room;
    Agreement same(room.segments, room.bvh.triangles);
    const AgreementVerdict none = same.compare("same", room.truth, room.truth.occluded);
    EXPECT_EQ(none.differences, 0u);
    EXPECT_TRUE(none.is_good);
    const auto [word, lane] = clear_ray(room);
    ASSERT_NE(lane, 0u);
    TracerAnswer wrong = room.truth;
    wrong.occluded[word] ^= lane;
    Agreement agreement(room.segments, room.bvh.triangles);
    const AgreementVerdict verdict = agreement.compare("wrong", wrong, room.truth.occluded);
    EXPECT_EQ(verdict.differences, 1u);
    EXPECT_TRUE(verdict.is_rare);
    EXPECT_FALSE(verdict.is_good);
    ASSERT_EQ(agreement.items().size(), 1u);
    const Disagreement& item = agreement.items().front();
    EXPECT_EQ(room.segments.word(item.packet, item.vpl), word);
    EXPECT_EQ(std::uint64_t{1} << item.lane, lane);
    EXPECT_FALSE(item.is_culling);
    EXPECT_GT(item.distance, 1e-3);
    EXPECT_EQ(item.tracer_says, (wrong.occluded[word] & lane) != 0);
}

/// A segment of 5 m that meets a large triangle at the given distance before its end, and nothing else.
double margin_distance(float before_end) {
    const Vec3 corner{-10, -10, 5.0f - before_end};
    const BvhTriangle triangle{corner, {40, 0, 0}, {0, 40, 0}, {0, 0, 1600}};
    return distance_to_margins({&triangle, 1}, {0, 0, 0}, {0, 0, 5});
}

TEST(Agreement, ExcusesTrianglesWhereMarginsBegin) {
    EXPECT_LT(margin_distance(5e-6f), 2e-7);           // a millionth of 5 m
    EXPECT_NEAR(margin_distance(1e-4f), 19e-6, 1e-6);  // 20 − 1 millionths
    EXPECT_NEAR(margin_distance(4.0f), 0.2, 1e-5);
    EXPECT_TRUE(std::isinf(margin_distance(-1e-6f)));  // beyond the end
}

TEST(Agreement, RefusesMoreDifferencesThanItsShare) {
    const Answered room;
    Agreement agreement(room.segments, room.bvh.triangles);
    TracerAnswer wrong = room.truth;
    for (std::size_t word = 0; word < 300; ++word) {
        wrong.occluded[word] ^= wrong.rays[word];
    }
    const AgreementVerdict verdict = agreement.compare("wrong", wrong, room.truth.occluded);
    EXPECT_GT(verdict.differences, 300u);
    EXPECT_FALSE(verdict.is_rare);
    EXPECT_FALSE(verdict.is_good);
    EXPECT_EQ(agreement.items().size(), 100u);
}

TEST(Agreement, RefusesPairsLostOrMadeUp) {
    const Answered room;
    const auto [word, lane] = clear_ray(room);
    TracerAnswer lost = room.truth;
    lost.rays[word] &= ~lane;
    lost.occluded[word] &= ~lane;
    Agreement agreement(room.segments, room.bvh.triangles);
    EXPECT_TRUE(agreement.compare("roulette", lost, room.truth.occluded, true).is_good);
    EXPECT_TRUE(agreement.items().empty());
    EXPECT_FALSE(agreement.compare("lost", lost, room.truth.occluded).is_good);
    ASSERT_EQ(agreement.items().size(), 1u);
    EXPECT_TRUE(agreement.items().front().is_culling);
    GatherSegments fewer = room.segments;
    fewer.rays[word] &= ~lane;
    Agreement made_up(fewer, room.bvh.triangles);
    const AgreementVerdict verdict = made_up.compare("made up", room.truth, room.truth.occluded, true);
    EXPECT_EQ(verdict.differences, 1u);
    EXPECT_FALSE(verdict.is_good);
}

TracerFigures figures(const std::string& name, int width, double seconds, bool wrong) {
    TracerFigures tracer{.name = name, .embree_width = width, .median = {seconds, seconds}};
    tracer.is_wrong = wrong;
    return tracer;
}

TEST(FastestTracer, IsNoneThatIsWrongIfAnotherIsRight) {
    const std::vector<TracerFigures> tracers{
        figures("slow", 16, 3.0, false), figures("wrong", 16, 1.0, true), figures("right", 16, 2.0, false),
        figures("one", 1, 0.5, false),   figures("bad", 0, 2.0, true),    figures("worse", 0, 1.0, true)};
    EXPECT_EQ(tracers[fastest_tracer(tracers, 16)].name, "right");
    EXPECT_EQ(tracers[fastest_tracer(tracers, 1)].name, "one");
    EXPECT_EQ(tracers[fastest_tracer(tracers, 0)].name, "worse");
    EXPECT_EQ(fastest_tracer(tracers, 0, true), tracers.size());
}

TEST(GatherWorkload, VplsOfASceneWithoutLampsLieOnItsSurfaces) {
    Scene scene = make_sphere_room(3'000);
    for (Material& material : scene.materials) {
        material.emission = parameter_of(0.0f);
    }
    const Bvh bvh = build_scene_bvh(scene);
    const std::vector<Vpl> vpls = make_traced_vpls(scene, bvh, 200);
    ASSERT_EQ(vpls.size(), 200u);
    for (const Vpl& vpl : vpls) {
        EXPECT_NEAR(length(vpl.normal), 1.0f, 1e-5f);
        const BvhHit hit = closest_hit(bvh, vpl.position, -vpl.normal, 0.0f, 1.0f);
        EXPECT_LT(hit.t, 1e-3f);
    }
}

}  // namespace
}  // namespace nearlight::core::test
