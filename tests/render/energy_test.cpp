// SPDX-License-Identifier: Apache-2.0
// Light by region and depth: what the policy `partition` and the samplers that look at the camera put where, against
// instant radiosity.
#include "tests/render/energy.h"

#include <gtest/gtest.h>

#include "host/render/view.h"
#include "host/samplers/sampler.h"
#include "tests/support/device_fixture.h"
#include "tests/support/scene_on_device.h"
#include "tests/support/small_scenes.h"

namespace nearlight {
namespace {

using namespace small_scenes;
using test::deviation;
using test::Energies;

constexpr uint kDepths = 4;
constexpr uint kSeeds = 40;
constexpr uint kVpls = 60'000;
constexpr double kSigmas = 3.0;

/// A closed room with a block in it, under a point light.
Scene room_with_block() {
    Scene scene;
    const uint white = add_material(scene, lambertian({0.7f, 0.7f, 0.7f}));
    const uint red = add_material(scene, lambertian({0.6f, 0.2f, 0.1f}));
    add_quad(scene, {-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, white);
    add_quad(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, white);
    add_quad(scene, {-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, white);
    add_quad(scene, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, white);
    add_quad(scene, {-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, red);
    add_quad(scene, {1, -1, -1}, {0, 0, 2}, {0, 2, 0}, red);
    add_quad(scene, {-0.2f, -0.2f, 0.1f}, {0, 0, 0.5f}, {0.6f, 0, 0.1f}, white);  // the block's top
    add_quad(scene, {-0.2f, -1, 0.1f}, {0, 0.8f, 0}, {0.6f, 0, 0.1f}, white);     // its front
    add_point_light(scene, {0.3f, 0.7f, -0.2f}, {1, 1, 1});
    set_camera(scene, {0.1, 0.2, -0.9}, {0, -0.3, 1}, 100);
    scene.camera.width = scene.camera.height = 32;
    return scene;
}

/// Energies of a sampler's sets, whose powers are multiplied by `scale`.
Energies sampled_energies(Device& device, SamplerKind sampler, float scale, uint vpl_count = kVpls) {
    CameraPass camera_pass(device);
    SamplerStages stages(device);
    const test::SceneOnDevice on_device(device, room_with_block());
    const View view = choose_view(device, camera_pass, on_device.buffers, on_device.scene, {.range = 2.4f});
    Energies energies;
    for (uint seed = 0; seed < kSeeds; ++seed) {
        VplSet set = sample_vpls(stages, {.scene = on_device.buffers,
                                          .view = view.pilot,
                                          .sampler = sampler,
                                          .policy = Policy::partition,
                                          .vpl_count = vpl_count,
                                          .bounce_count = kDepths,
                                          .close_fraction = 0.5f,
                                          .close_range = view.close_range,
                                          .clamp_radius = view.clamp_radius,
                                          .seed = 1000 * static_cast<uint>(sampler) + seed});
        for (Vpl& vpl : set.vpls) {
            vpl.power *= scale;
        }
        test::add_energies(energies, set.vpls, view.close_range, kDepths);
    }
    return energies;
}

class Energy : public test::DeviceTest {};

TEST_F(Energy, PartitionPutsTheSameLightInEachRegionAndDepth) {
    on_each_device([](Device& device) {
        const Energies walks = sampled_energies(device, SamplerKind::instant_radiosity, 1.0f);
        const Energies partition = sampled_energies(device, SamplerKind::close_range, 1.0f);
        ASSERT_EQ(walks.size(), 2u * kDepths);
        for (const auto& [key, powers] : walks) {
            const auto& [inside, depth] = key;
            EXPECT_LT(deviation(powers, partition.at(key)), kSigmas)
                << (inside ? "inside" : "outside") << ", depth " << depth << ": "
                << test::spread_of(powers).mean << " W by walks, " << test::spread_of(partition.at(key)).mean
                << " W by partition";
            EXPECT_GT(test::spread_of(powers).mean, 0.01) << "nothing to compare";
        }
    });
}

void expect_the_light_of_walks(Device& device, SamplerKind sampler) {
    const Energies walks = sampled_energies(device, SamplerKind::instant_radiosity, 1.0f);
    const Energies found = sampled_energies(device, sampler, 1.0f, 2000);  // each costs many candidates
    for (const auto& [key, powers] : walks) {
        const test::Spread spread = test::spread_of(found.at(key));
        EXPECT_LT(deviation(powers, found.at(key)), kSigmas)
            << (key.first ? "inside" : "outside") << ", depth " << key.second << ": " << test::spread_of(powers).mean
            << " W by walks, " << spread.mean << " W by " << to_string(sampler);
        EXPECT_LT(spread.error, 0.03 * spread.mean) << "too noisy to tell";
    }
}

TEST_F(Energy, RejectionKeepsTheLightOfEachRegionAndDepth) {
    on_each_device([](Device& device) { expect_the_light_of_walks(device, SamplerKind::rejection); });
}

TEST_F(Energy, MetropolisKeepsTheLightOfEachRegionAndDepth) {
    on_each_device([](Device& device) { expect_the_light_of_walks(device, SamplerKind::metropolis); });
}

/// The check itself: powers that are 5 % too high must not pass, in any class.
TEST_F(Energy, AWrongNormalisationIsDetected) {
    on_each_device([](Device& device) {
        const Energies walks = sampled_energies(device, SamplerKind::instant_radiosity, 1.0f);
        const Energies wrong = sampled_energies(device, SamplerKind::close_range, 1.05f);
        for (const auto& [key, powers] : walks) {
            EXPECT_GT(deviation(powers, wrong.at(key)), kSigmas)
                << (key.first ? "inside" : "outside") << ", depth " << key.second;
        }
    });
}

}  // namespace
}  // namespace nearlight
