// SPDX-License-Identifier: Apache-2.0
#include "host/stages/shared_veiled.h"

#include <algorithm>
#include <cmath>

#include "host/scene/material_model.h"
#include "tests/support/brought_light.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight::core {
namespace {

using namespace small_scenes;
using test::brought;
using test::Brought;

class SharedVeiledTest : public test::DeviceTest {};

constexpr std::size_t kVeiledReceivers = std::size_t{NEARLIGHT_BUNDLE_PACKETS} * NEARLIGHT_PACKET_SIZE;

/// A floor at y = −1 under a lamp.
Scene lit_floor_below(const Material& floor) {
    Scene scene;
    add_quad(scene, {-3, -1, -3}, {0, 0, 6}, {6, 0, 0}, add_material(scene, floor));
    Material lamp = lambertian({0, 0, 0});
    lamp.emission = parameter_of(Vec3{30, 20, 10});
    add_quad(scene, {-1.5f, -0.4f, -0.3f}, {0.4f, 0, 0}, {0, 0, 0.5f}, add_two_sided(scene, lamp));
    return scene;
}

/// A tinted pane that covers x > 0 between the receivers and the floor.
void add_pane(Scene& scene, float y, const Material& glass) {
    Material tinted = glass;
    tinted.transmission = parameter_of(Vec3{0.9f, 0.7f, 0.5f});
    add_quad(scene, {0, y, -3}, {0, 0, 6}, {3, 0, 0}, add_material(scene, tinted));
}

/// Receivers at y = 1 that look down, on both sides of the pane's edge. Every fifth is absent.
std::vector<ReceiverPacket> receivers_above() {
    std::vector<ReceiverPoint> points;
    for (std::size_t i = 0; i < kVeiledReceivers; ++i) {
        const float x = -0.3f + 0.06f * static_cast<float>(i % 16);
        const float z = -0.4f + 0.06f * static_cast<float>(i / 16);
        points.push_back({{x, 1, z}, i % 5 == 4 ? Vec3{0, 0, 0} : Vec3{0, -1, 0}});
    }
    return test::pack_receivers(points);
}

constexpr ReceiverPathSettings kTwoVeiledRays{
    .rays = 2, .max_edges = 4, .clamp_radius = 0.5f, .shares_veiled = true};

ReceiverPathSettings with_veiled_rays(ReceiverPathSettings settings, uint rays) {
    settings.rays = rays;
    return settings;
}

/// `tolerance` is that of single receivers, as a part of the mean.
void expect_what_own_rays_bring_through_veils(Device& device, const Scene& scene,
                                              const ReceiverPathSettings& settings = kTwoVeiledRays,
                                              GatherKernel kernel = GatherKernel::automatic,
                                              double tolerance = 0.2) {
    const std::vector<ReceiverPacket> packets = receivers_above();
    const Brought own = brought(device, scene, packets, false, with_veiled_rays(settings, 256), 64, kernel);
    const Brought shared = brought(device, scene, packets, true, settings, 4096, kernel);
    ASSERT_GT(own.sum(), 0.1);
    EXPECT_NEAR(shared.sum(), own.sum(), 0.01 * own.sum());
    const double mean = own.sum() / kVeiledReceivers;
    for (std::size_t i = 0; i < own.mean.size(); ++i) {
        EXPECT_NEAR(shared.mean[i], own.mean[i], 0.1 * own.mean[i] + tolerance * mean) << i;
    }
}

Scene floor_below_a_pane() {
    Scene scene = lit_floor_below(lambertian({0.5f, 0.5f, 0.5f}));
    add_pane(scene, 0, thin_dielectric_material(1.5));
    return scene;
}

/// The floor counts through the pane, and no more beside it, where VPLs bring its light.
TEST_F(SharedVeiledTest, BringsWhatOwnRaysBring) {
    on_each_device([](Device& device) {
        for (const GatherKernel kernel : {GatherKernel::packets, GatherKernel::rays}) {
            SCOPED_TRACE(kernel == GatherKernel::rays ? "single rays" : "packets");
            expect_what_own_rays_bring_through_veils(device, floor_below_a_pane(), kTwoVeiledRays, kernel);
        }
    });
}

TEST_F(SharedVeiledTest, DoesNotDependOnTheDivisionOfABundle) {
    on_each_device([](Device& device) {
        test::expect_same_by_any_division(device, floor_below_a_pane(), receivers_above(), kTwoVeiledRays);
    });
}

/// Much of what rays bring from a lamp that is large to the floor is above the limit.
TEST_F(SharedVeiledTest, BringsWhatOwnRaysBringUpToALimit) {
    on_each_device([](Device& device) {
        Scene scene = floor_below_a_pane();
        Material lamp = lambertian({0, 0, 0});
        lamp.emission = parameter_of(Vec3{2, 3, 4});
        add_quad(scene, {-1.5f, -0.5f, 0.3f}, {4, 0, 0}, {0, 0, 2}, add_material(scene, lamp));
        const std::vector<ReceiverPacket> packets = receivers_above();
        const ReceiverPathSettings limited = test::with_limit(kTwoVeiledRays, 0.3f);
        EXPECT_GT(brought(device, scene, packets, true, limited, 64).variance(),
                  1.1 * brought(device, scene, packets, true, kTwoVeiledRays, 64).variance())
            << "the limit changes nothing";
        expect_what_own_rays_bring_through_veils(device, scene, limited);
    });
}

/// Receivers see the same place through one pane, through two or through none. With a sky besides, which
/// stays with the receivers here.
TEST_F(SharedVeiledTest, BringsWhatOwnRaysBringThroughSeveralVeils) {
    on_each_device([](Device& device) {
        Scene scene = floor_below_a_pane();
        add_quad(scene, {0.3f, 0.2f, -3}, {0, 0, 6}, {2, 0, 0},
                 add_material(scene, thin_dielectric_material(1.3)));
        const uint green = add_two_sided(scene, lambertian({0.1f, 0.3f, 0.1f}));
        add_quad(scene, {-3, 0.4f, 0}, {0, 0, 3}, {6, 0, 0},
                 add_material(scene, mask_material(parameter_of(0.5f), green)));
        scene.environment = patterned_map(6, 4);
        expect_what_own_rays_bring_through_veils(device, scene);
    });
}

/// Only the Lambertian part of a place behind veils is shared: what coats reflect stays with the receiver
/// that finds it, and is its noise.
TEST_F(SharedVeiledTest, BringsWhatOwnRaysBringOfCoats) {
    on_each_device([](Device& device) {
        Scene scene = floor_below_a_pane();
        scene.materials[0] = coated(scene, {0.3f, 0.3f, 0.3f}, {.eta = 1.9, .alpha = 0.25});
        add_quad(scene, {-3, -0.5f, 0.5f}, {0, 0, 2}, {6, 0, 0},
                 add_two_sided(scene, lambertian({0.2f, 0.8f, 0.2f})));
        expect_what_own_rays_bring_through_veils(device, scene, kTwoVeiledRays, GatherKernel::automatic, 0.8);
    });
}

/// A normal map turns the floor for each viewer, so its light stays with them as well.
TEST_F(SharedVeiledTest, BringsWhatOwnRaysBringOfMappedSurfaces) {
    on_each_device([](Device& device) {
        Scene scene = floor_below_a_pane();
        const uint plain = add_material(scene, scene.materials[0]);
        scene.materials[0] = normal_map_material(parameter_of(Vec3{0.6f, 0.5f, 0.9f}), plain);
        expect_what_own_rays_bring_through_veils(device, scene, kTwoVeiledRays, GatherKernel::automatic, 0.8);
    });
}

/// A pane overlaps a board in its plane. Rays that meet the pane there pass the board as well, and bundles do
/// not.
TEST_F(SharedVeiledTest, BringsWhatOwnRaysBringThroughPanesInThePlaneOfABoard) {
    on_each_device([](Device& device) {
        Scene scene = floor_below_a_pane();
        add_quad(scene, {0.2f, 0, -3}, {0, 0, 3.2f}, {1, 0, 0},
                 add_two_sided(scene, lambertian({0.5f, 0.5f, 0.5f})));
        expect_what_own_rays_bring_through_veils(device, scene);
    });
}

TEST_F(SharedVeiledTest, BringsWhatOwnRaysBringThroughClearGlass) {
    on_each_device([](Device& device) {
        Scene scene = lit_floor_below(lambertian({0.5f, 0.5f, 0.5f}));
        add_pane(scene, 0, dielectric_material(1.5));
        add_pane(scene, -0.1f, dielectric_material(1.5));
        scene.clear_glass = true;
        ReceiverPathSettings settings = kTwoVeiledRays;
        settings.max_edges = 5;
        expect_what_own_rays_bring_through_veils(device, scene, settings);
    });
}

/// Light straight from the lamp to the floor takes three edges to a receiver above the pane.
TEST_F(SharedVeiledTest, KeepsToTheLengthOfPaths) {
    on_each_device([](Device& device) {
        const Scene scene = floor_below_a_pane();
        ReceiverPathSettings settings = kTwoVeiledRays;
        settings.max_edges = 3;
        expect_what_own_rays_bring_through_veils(device, scene, settings);
        settings.max_edges = 2;
        const std::vector<ReceiverPacket> packets = receivers_above();
        const double shared = brought(device, scene, packets, true, settings, 64).sum();
        const double own = brought(device, scene, packets, false, settings, 64).sum();
        EXPECT_NEAR(shared, own, 0.02 * own);
    });
}

TEST_F(SharedVeiledTest, IsLessNoiseThanOwnRays) {
    on_each_device([](Device& device) {
        const Scene scene = floor_below_a_pane();
        const std::vector<ReceiverPacket> packets = receivers_above();
        const double own = brought(device, scene, packets, false, kTwoVeiledRays, 64).variance();
        EXPECT_LT(brought(device, scene, packets, true, kTwoVeiledRays, 64).variance(), 0.3 * own);
    });
}

}  // namespace
}  // namespace nearlight::core
