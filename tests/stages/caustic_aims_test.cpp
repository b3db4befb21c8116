// SPDX-License-Identifier: Apache-2.0
#include "host/stages/caustic_aims.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <optional>

#include "host/base/random.h"
#include "host/base/receivers.h"
#include "host/bvh/bvh.h"
#include "host/reference/test_rooms.h"
#include "host/scene/material_model.h"
#include "host/stages/receiver_paths.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;

class CausticAimsTest : public test::DeviceTest {};

constexpr uint kSomeWalks = 4096;

CausticLanding landing_at(Vec3 place, Vec3 target) {
    return {place, target, 1};
}

/// The cell that a receiver at x finds, as lib/caustic_aim.cl looks for it.
std::optional<CausticCell> cell_at(const CausticCells& cells, Vec3 x) {
    for (uint level = NEARLIGHT_CAUSTIC_LEVELS; level-- > 0;) {
        const float side = cells.table.side / static_cast<float>(1u << level);
        for (const CausticCell& cell : cells.entries) {
            if (cell.count > 0 && cell.level == level && cell.x == caustic_coordinate(x.x, side, 0.0f) &&
                cell.y == caustic_coordinate(x.y, side, 0.0f) &&
                cell.z == caustic_coordinate(x.z, side, 0.0f)) {
                return cell;
            }
        }
    }
    return std::nullopt;
}

TEST(CausticCellsTest, WithoutLandingsThereAreNone) {
    const CausticCells cells = sort_into_cells({}, 1.0f);
    EXPECT_EQ(cells.table.size, 0u);
    EXPECT_TRUE(cells.entries.empty());
    EXPECT_TRUE(cells.targets.empty());
}

/// A dense spot of 600 landings, and a few that are far from each other.
TEST(CausticCellsTest, AreSmallWhereLandingsAreDense) {
    Pcg32 random(5);
    std::vector<CausticLanding> landings;
    for (int i = 0; i < 600; ++i) {
        landings.push_back(landing_at({0.05f * random.uniform(), 0, 0.05f * random.uniform()}, {1, 2, 3}));
    }
    for (const float x : {2.0f, 5.0f, 8.0f}) {
        landings.push_back(landing_at({x, 0, 0}, {x, 1, 0}));
    }
    const CausticCells cells = sort_into_cells(landings, 10.0f);
    EXPECT_NEAR(cells.table.side, 8.0f / 8, 1e-3f);
    const std::optional<CausticCell> dense = cell_at(cells, {0.025f, 0, 0.025f});
    const std::optional<CausticCell> sparse = cell_at(cells, {5.1f, 0.1f, 0.1f});
    ASSERT_TRUE(dense && sparse);
    EXPECT_GE(dense->level, 6u);
    EXPECT_GE(dense->count, 8u);
    EXPECT_LE(dense->count, NEARLIGHT_MAX_CAUSTIC_TARGETS);
    EXPECT_EQ(cells.targets.at(dense->first), (Vec3{1, 2, 3}));
    EXPECT_EQ(sparse->level, 0u);
    EXPECT_EQ(sparse->count, 1u);
    EXPECT_EQ(cells.targets.at(sparse->first), (Vec3{5, 1, 0}));
    EXPECT_FALSE(cell_at(cells, {3.6f, 0, 3}));
}

/// Every landing is in the cells within half a side of it, however far from the origin.
TEST(CausticCellsTest, HoldTheLandingsAroundThem) {
    for (const float shift : {0.0f, -1e5f, 1e30f}) {
        Pcg32 random(7);
        std::vector<CausticLanding> landings;
        for (int i = 0; i < 100; ++i) {
            const Vec3 place{shift + random.uniform(), random.uniform(), random.uniform()};
            landings.push_back(landing_at(place, place));
        }
        const CausticCells cells = sort_into_cells(landings, 1.0f);
        for (const CausticLanding& landing : landings) {
            const std::optional<CausticCell> cell = cell_at(cells, landing.place);
            ASSERT_TRUE(cell) << shift;
            EXPECT_LE(cell->count, NEARLIGHT_MAX_CAUSTIC_TARGETS);
        }
    }
}

TEST_F(CausticAimsTest, WalksOverAMirrorLandOnTheFloor) {
    on_each_device([](Device& device) {
        const MirrorCorner corner = make_mirror_corner();
        const DeviceScene scene = upload_scene(device, corner.scene, build_scene_bvh(corner.scene));
        CausticWalks walks(device);
        const std::vector<CausticLanding> landings = walks.run(scene, 0, kSomeWalks, 1);
        EXPECT_GT(landings.size(), kSomeWalks / 50);
        for (const CausticLanding& landing : landings) {
            EXPECT_NEAR(landing.place.y, 0, 1e-4);
            EXPECT_NEAR(landing.target.x, corner.mirror_x, 1e-4);
        }
        std::vector<CausticLanding> halves = walks.run(scene, 0, kSomeWalks / 2, 1);
        const std::vector<CausticLanding> second = walks.run(scene, kSomeWalks / 2, kSomeWalks / 2, 1);
        halves.insert(halves.end(), second.begin(), second.end());
        ASSERT_EQ(halves.size(), landings.size());
        EXPECT_EQ(halves.back().place, landings.back().place);
    });
}

/// No ray finds a point, and panes are no mirrors.
TEST_F(CausticAimsTest, PointsAndPanesHaveNone) {
    on_each_device([](Device& device) {
        Scene scene = make_mirror_corner().scene;
        scene.materials[2].emission = parameter_of(0.0f);
        add_point_light(scene, {0, 1, 0}, {1, 1, 1});
        const DeviceScene of_point = upload_scene(device, scene, build_scene_bvh(scene));
        EXPECT_TRUE(of_point.has_mirrors);
        EXPECT_EQ(find_caustic_aims(device, of_point, 1).table.size, 0u);
        Scene behind_pane = make_mirror_corner().scene;
        behind_pane.materials[1] = lambertian({0.5f, 0.5f, 0.5f});
        add_quad(behind_pane, {-3, 0.5f, -2}, {0, 0, 4}, {4, 0, 0},
                 add_material(behind_pane, mask_material(parameter_of(0.5f), 0)));
        const DeviceScene of_pane = upload_scene(device, behind_pane, build_scene_bvh(behind_pane));
        EXPECT_FALSE(of_pane.has_mirrors);
        EXPECT_TRUE(CausticWalks(device).run(of_pane, 0, kSomeWalks, 1).empty());
    });
}

/// Receivers on the floor of a corner.
std::vector<ReceiverPacket> receivers_on_the_floor() {
    std::vector<ReceiverPoint> points;
    for (int i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
        const auto u = static_cast<float>(i % 8);
        const auto v = static_cast<float>(i / 8);
        points.push_back({{-0.6f + 0.15f * u, 1e-4f, -0.5f + 0.14f * v}, {0, 1, 0}});
    }
    return test::pack_receivers(points);
}

/// What rays bring to the receivers on the floor over other surfaces, without what VPLs bring.
struct Received {
    std::vector<double> mean;
    double variance = 0;  // of all receivers together
};

Received received(Device& device, const Scene& scene, uint aimed_rays, uint rays, uint seeds) {
    DeviceScene on_device = upload_scene(device, scene, build_scene_bvh(scene));
    on_device.caustic_aims = find_caustic_aims(device, on_device, 3);
    EXPECT_GT(on_device.caustic_aims.table.size, 0u);
    const std::vector<ReceiverPacket> packets = receivers_on_the_floor();
    const Buffer<ReceiverPacket> receivers(device, packets);
    Buffer<IrradiancePacket> direct(device, packets.size());
    Buffer<IrradiancePacket> indirect(device, packets.size());
    ReceiverPaths paths(device);
    Received result{std::vector<double>(NEARLIGHT_PACKET_SIZE)};
    std::vector<double> squares(NEARLIGHT_PACKET_SIZE);
    for (uint seed = 0; seed < seeds; ++seed) {
        const ReceiverPathSettings settings{
            .rays = rays, .aimed_rays = aimed_rays, .max_edges = 6, .clamp_radius = 1e-6f, .seed = seed};
        paths.run({on_device, receivers, packets.size(), settings}, direct, indirect);
        const std::vector<IrradiancePacket> light = indirect.download();
        for (std::size_t i = 0; i < result.mean.size(); ++i) {
            const double green = irradiance_at(light, i).y;
            result.mean[i] += green / seeds;
            squares[i] += green * green / seeds;
        }
    }
    for (std::size_t i = 0; i < squares.size(); ++i) {
        result.variance += squares[i] - result.mean[i] * result.mean[i];
    }
    return result;
}

/// The irradiance of a point of the floor by the mirror image of the lamp.
double by_mirror_image(const MirrorCorner& corner, Vec3 x) {
    constexpr int kSteps = 20;
    const double side = 2.0 * corner.lamp_half_side / kSteps;
    double sum = 0;
    for (int i = 0; i < kSteps * kSteps; ++i) {
        const double along_x =
            2 * corner.mirror_x - corner.lamp.x - corner.lamp_half_side + (i % kSteps + 0.5) * side;
        const double along_z = corner.lamp.z - corner.lamp_half_side + (i / kSteps + 0.5) * side;
        const double height = double{corner.lamp.y} - double{x.y};
        const double squared =
            std::pow(along_x - double{x.x}, 2) + height * height + std::pow(along_z - double{x.z}, 2);
        sum += height * height / (squared * squared) * side * side;
    }
    return sum * corner.lamp_radiance;
}

TEST_F(CausticAimsTest, AimedRaysBringTheLightOfAMirrorImage) {
    on_each_device([](Device& device) {
        const MirrorCorner corner = make_mirror_corner();
        const Received plain = received(device, corner.scene, 0, 4, 256);
        const Received aimed = received(device, corner.scene, 1, 4, 8192);
        const std::vector<ReceiverPacket> packets = receivers_on_the_floor();
        double total = 0;
        double expected_total = 0;
        for (uint i = 0; i < NEARLIGHT_PACKET_SIZE; ++i) {
            const double expected = by_mirror_image(corner, receiver_at(packets[0], i).position);
            EXPECT_NEAR(aimed.mean[i], expected, 0.15 * expected) << i;
            total += aimed.mean[i];
            expected_total += expected;
        }
        EXPECT_NEAR(total, expected_total, 0.01 * expected_total);
        EXPECT_LT(aimed.variance, 0.1 * plain.variance);
    });
}

/// Few aimed rays tell the variance that many seeds show.
TEST_F(CausticAimsTest, AimedRaysTellWhatAimingGains) {
    on_each_device([](Device& device) {
        constexpr uint kCosineRays = 4;
        const Scene scene = make_mirror_corner().scene;
        DeviceScene on_device = upload_scene(device, scene, build_scene_bvh(scene));
        on_device.caustic_aims = find_caustic_aims(device, on_device, 3);
        const std::vector<ReceiverPacket> packets = receivers_on_the_floor();
        const Buffer<ReceiverPacket> receivers(device, packets);
        ReceiverPaths paths(device);
        CausticErrors sums{{0}, {0}};  // of all channels
        constexpr uint kErrorSeeds = 64;
        for (uint seed = 0; seed < kErrorSeeds; ++seed) {
            const CausticErrors errors =
                paths.caustic_errors({on_device,
                                      receivers,
                                      packets.size(),
                                      {.rays = kCosineRays, .aimed_rays = 1, .max_edges = 6, .seed = seed}});
            sums.unaimed[0] += std::reduce(errors.unaimed.begin(), errors.unaimed.end()) / kErrorSeeds;
            sums.aimed[0] += std::reduce(errors.aimed.begin(), errors.aimed.end()) / kErrorSeeds;
        }
        const double unaimed = received(device, scene, 0, kCosineRays, 8192).variance;
        EXPECT_NEAR(sums.unaimed[0], 3 * unaimed, 0.2 * 3 * unaimed);
        // The second moment takes no notice that each kind of rays has a mean of its own.
        const double aimed = received(device, scene, 1, kCosineRays, 2048).variance;
        EXPECT_GT(sums.aimed[0], 0.8 * 3 * aimed);
        EXPECT_LT(sums.aimed[0], 0.1 * sums.unaimed[0]);
    });
}

/// More aimed rays, and more of the others, change the noise alone.
TEST_F(CausticAimsTest, AnyNumberOfRaysBringsTheSame) {
    on_each_device([](Device& device) {
        const Scene scene = make_mirror_corner().scene;
        const auto sum_of = [&](uint aimed_rays, uint rays) {
            double sum = 0;
            for (const double mean : received(device, scene, aimed_rays, rays, 1024).mean) {
                sum += mean;
            }
            return sum;
        };
        const double one = sum_of(1, 8);
        EXPECT_NEAR(sum_of(4, 2), one, 0.02 * one);
        EXPECT_NEAR(sum_of(1, 64), one, 0.02 * one);
    });
}

/// A lamp above a sheet of glass of this roughness, which refracts most of its light to the floor, and
/// reflects some of it to a ceiling and on to the floor.
Scene corner_behind_glass(float alpha) {
    Scene scene = make_mirror_corner().scene;
    Material glass = dielectric_material(1.5);
    glass.roughness = parameter_of(alpha);
    add_quad(scene, {-3, 0.5f, -2}, {0, 0, 4}, {4, 0, 0}, add_material(scene, glass));
    add_quad(scene, {-3, 0.4f, -2}, {4, 0, 0}, {0, 0, 4}, add_material(scene, glass));
    return scene;
}

double total_of(const Received& received) {
    return std::reduce(received.mean.begin(), received.mean.end());
}

/// Light samples find hardly any of the light through slightly rough glass, and much of it through rough
/// glass.
TEST_F(CausticAimsTest, AimedRaysBringTheLightOfALampBehindGlass) {
    on_each_device([](Device& device) {
        for (const float alpha : {0.0f, 0.01f, 0.3f}) {
            SCOPED_TRACE("alpha " + std::to_string(alpha));
            const Scene scene = corner_behind_glass(alpha);
            const double expected = total_of(received(device, scene, 0, 64, 2048));
            const Received aimed = received(device, scene, 1, 4, 2048);
            EXPECT_NEAR(total_of(aimed), expected, 0.02 * expected);
            if (alpha < 0.1f) {
                EXPECT_LT(aimed.variance, 0.6 * received(device, scene, 0, 4, 1024).variance);
            }
        }
    });
}

}  // namespace
}  // namespace nearlight::core
